"""Blocks: the vocabulary of physical effects, one effect a class, one class a file.

A new block is a new module in this package; it is found by its class's ``name``.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from functools import cache

from hystbench.blocks.base import Block


@cache
def registry() -> dict[str, type[Block]]:
    """Return every block class by its name.

    Raises
    ------
    RuntimeError
        If two classes claim one name.
    """
    found: dict[str, type[Block]] = {}
    for module_info in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{module_info.name}")
        for item in vars(module).values():
            if (
                inspect.isclass(item)
                and issubclass(item, Block)
                and not inspect.isabstract(item)
                and item.__module__ == module.__name__
            ):
                if item.name in found:
                    raise RuntimeError(f"two blocks are named {item.name!r}")
                found[item.name] = item
    return dict(sorted(found.items()))

"""Blocks: the vocabulary of physical effects, one effect a class, one class a file.

A new block is a new module in this package; it is found by its class's ``name``.
"""

from functools import cache

from hystbench.blocks.base import Block
from hystbench.registered import classes_in


@cache
def registry() -> dict[str, type[Block]]:
    """Return every block class by its name.

    Raises
    ------
    RuntimeError
        If two classes claim one name.
    """
    return classes_in(__name__, __path__, Block)

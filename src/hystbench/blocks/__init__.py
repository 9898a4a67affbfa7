"""Blocks: the vocabulary of physical effects, one effect a class, one class a file.

A new block is a new module in this package; it is found by its class's ``name``. An
installed package adds one by an entry point of the group ``hystbench.blocks``.
"""

from functools import cache

from hystbench.blocks.base import Block
from hystbench.registered import classes_in, with_installed


@cache
def own() -> dict[str, type[Block]]:
    """Return every block class of hystbench itself by its name.

    Raises
    ------
    RuntimeError
        If two classes claim one name.
    """
    return classes_in(__name__, __path__, Block)


@cache
def registry() -> dict[str, type[Block]]:
    """Return every block class by its name.

    Raises
    ------
    InputError
        If an installed package offers what is no block, or a name that is taken.
    """
    return dict(sorted(with_installed(own(), "hystbench.blocks", Block).items()))


def blocks(name: str) -> dict[str, type[Block]]:
    """Return block classes by name, of installed packages only if this one needs them.

    To ask what is installed takes longer than to read a model file.
    """
    return own() if name in own() else registry()


def block_class(name: str) -> type[Block]:
    """Return the block class of a name that is known."""
    return blocks(name)[name]

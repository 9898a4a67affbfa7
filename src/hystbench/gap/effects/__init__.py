"""The effects that can be named, by name; a module holds those that act alike.

A new effect is a class in a module of this package, found by its ``name``. An
installed package adds one by an entry point of the group ``hystbench.effects``.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from hystbench.gap.effects.effect import Effect
from hystbench.registered import classes_in, with_installed


def own() -> dict[str, type[Effect]]:
    """Give every effect class of hystbench itself, by name."""
    return classes_in(__name__, __path__, Effect)


@cache
def effects() -> dict[str, Effect]:
    """Give one of each effect, by name.

    Raises
    ------
    InputError
        If an installed package offers what is no effect, or a name that is taken.
    """
    found = with_installed(own(), "hystbench.effects", Effect)
    return {name: found[name]() for name in sorted(found)}


def among(names: Iterable[str] | None) -> dict[str, Effect]:
    """Give one of each of some effects, by name; of all where none are told."""
    kept = set(effects() if names is None else names)
    return {name: item for name, item in effects().items() if name in kept}

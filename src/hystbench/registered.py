"""What is registered under a name: by its file inside, by an entry point outside."""

import importlib
import inspect
import pkgutil
from collections.abc import Iterable, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hystbench.errors import InputError, in_line

SOURCES = (".py", ".so", ".yaml")
"""Endings of the files on which what a package computes depends."""


def classes_in(package: str, path: Iterable[str], kind: type) -> dict[str, Any]:
    """Find the classes of a kind in a package, by their ``name``.

    Parameters
    ----------
    package : str
        Full name of the package.
    path : iterable of str
        Its ``__path__``.
    kind : type
        The classes are its subclasses; those that are abstract or without a name are
        left out.

    Raises
    ------
    RuntimeError
        If two classes claim one name.
    """
    found: dict[str, Any] = {}
    for module_info in pkgutil.iter_modules(path):
        module = importlib.import_module(f"{package}.{module_info.name}")
        for item in vars(module).values():
            if _is_one(item, kind) and item.__module__ == module.__name__:
                if item.name in found:
                    raise RuntimeError(f"{package}: two are named {item.name!r}")
                found[item.name] = item
    return dict(sorted(found.items()))


def with_installed(inside: Mapping[str, Any], group: str, kind: type) -> dict[str, Any]:
    """Add to what hystbench has what installed packages offer.

    Parameters
    ----------
    inside : mapping
        Classes of hystbench itself, by name.
    group : str
        Group of the entry points; each is named as its class is.
    kind : type
        Each class is a subclass of it.

    Raises
    ------
    InputError
        If an entry point cannot be imported or is none of the kind, or if its name
        is taken.
    """
    from importlib.metadata import entry_points  # late: most jobs need none of it

    found = dict(inside)
    for point in entry_points(group=group):
        place = f"entry point {point.name!r} of {group} ({point.value})"
        try:
            item = point.load()
        except Exception as error:  # whatever somebody's module raises
            raise InputError(
                f"{place}: cannot be imported: {in_line(error)}"
            ) from error
        if not _is_one(item, kind):
            raise InputError(
                f"{place}: expected a class derived from {kind.__name__} with a name "
                "and all its methods"
            )
        if item.name != point.name:
            raise InputError(f"{place}: its class is named {item.name!r}; expected one")
        if point.name in found and found[point.name] is not item:
            raise InputError(f"{place}: the name is taken; expected another")
        found[point.name] = item
    return found


def files_of_installed(*groups: str) -> list[Path]:
    """List the files of the packages that have entry points in some groups.

    All of a package, as what an entry point names may import the rest of it. Nothing is
    imported.
    """
    from importlib.metadata import entry_points  # late, as above

    installed = entry_points()
    tops = {
        point.module.partition(".")[0]
        for group in groups
        for point in installed.select(group=group)
    }
    files: list[Path] = []
    for spec in filter(None, map(find_spec, tops)):  # a lost one is told when loaded
        for folder in spec.submodule_search_locations or ():
            files += (x for x in Path(folder).rglob("*") if x.suffix in SOURCES)
        if spec.submodule_search_locations is None and spec.origin is not None:
            files.append(Path(spec.origin))
    return sorted(files)


def _is_one(item: object, kind: type) -> bool:
    """Tell whether something is a class of a kind that can be used as it is."""
    return (
        inspect.isclass(item)
        and issubclass(item, kind)
        and not inspect.isabstract(item)
        and hasattr(item, "name")
    )

"""Rivals, which are solvers in Python: each file beside this one adds its own.

An installed package adds one by an entry point of the group ``hystbench.solvers``.
"""

from functools import cache

from hystbench.entrants.rivals.base import PythonSolver
from hystbench.registered import classes_in, with_installed

RIVALS: dict[str, type[PythonSolver]] = classes_in(__name__, __path__, PythonSolver)
"""Every rival of hystbench itself, by its name."""


@cache
def registry() -> dict[str, type[PythonSolver]]:
    """Give every rival by its name.

    Raises
    ------
    InputError
        If an installed package offers what is no rival, or a name that is taken.
    """
    return with_installed(RIVALS, "hystbench.solvers", PythonSolver)


def rivals(name: str) -> dict[str, type[PythonSolver]]:
    """Give rivals by name, those of installed packages only if this one needs them."""
    return RIVALS if name in RIVALS else registry()

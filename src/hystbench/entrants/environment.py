"""The Python environment that a solver's job runs in, and what that lacks."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from importlib.machinery import PathFinder
from pathlib import Path


def begun_by(environment: str | None) -> str:
    """Give the command that begins a solver's job.

    Parameters
    ----------
    environment : str or None
        Folder of a virtual environment; None for the one that this runs in.
    """
    return str(Path(environment, "bin", "hystbench")) if environment else "hystbench"


def missing(needs: Sequence[str], environment: str | None) -> list[str]:
    """Give the packages that a solver needs and its environment lacks.

    Nothing is imported: of another environment the folder is looked at, and hystbench
    must be in it too, as the job is its own.

    Parameters
    ----------
    needs : sequence of str
        Names as they are imported.
    environment : str or None
        As of :func:`begun_by`.
    """
    if environment is None:
        return [name for name in needs if not importlib.util.find_spec(name)]
    places = [str(path) for path in Path(environment).glob("lib/python*/site-packages")]
    lacking = [name for name in needs if not PathFinder.find_spec(name, places)]
    if not lacking and not Path(begun_by(environment)).is_file():
        return ["hystbench"]
    return lacking


def not_entered(needs: Sequence[str], environment: str | None) -> str | None:
    """Say in one line why a solver cannot enter; None if it can."""
    lacking = missing(needs, environment)
    if not lacking:
        return None
    where = f" in {environment}" if environment else ""
    return f"not entered: needs {' and '.join(lacking)}{where} (see docs/blind.md)"

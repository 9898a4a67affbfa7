"""Block ``external``: a simulator that a user brings as a Python function."""

import importlib
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.kept_outputs import source_digest
from hystbench.blocks.parameter import text
from hystbench.blocks.simulator import STARTED, CallError, Simulator
from hystbench.errors import InputError, in_line, nearest
from hystbench.record import FloatArray

FORM = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*:[^\W\d]\w*(\.[^\W\d]\w*)*")
"""``package.module:function``."""


class External(Simulator, name="external"):
    """A Python function ``y = function(u, dt)`` as a block.

    ``u`` is a copy of the samples that enter, shape (n,), ``dt`` the sampling interval
    in seconds; ``y`` must have as many samples, all finite. The function must give the
    same output every time. It is imported when the block first simulates, from the
    folder that the program was started in or from what is installed. A model file that
    names a function is a program: run only those that you trust.

    References
    ----------
    By definition.
    """

    function: str = text("package.module:function of u and dt, which gives y")

    def check(self) -> None:
        """Refuse what cannot be the name of a function."""
        if not FORM.fullmatch(self.function):
            raise InputError(
                f"function: expected package.module:function, got {self.function!r}"
            )

    @property
    def label(self) -> str:
        """The function's name."""
        return self.function

    def run(self, z: FloatArray, dt: float) -> Any:
        """Import the function, and call it once."""
        function = imported(self.function)
        try:
            return function(np.array(z), dt)
        except (Exception, SystemExit) as error:
            # Whatever a user's program raises is to be told in one line.
            raise CallError(f"raised {in_line(error)}") from error

    def source(self) -> str:
        """Digest of the modules that the function is made of."""
        return source_digest(self.function)


@cache
def imported(name: str) -> Callable[[FloatArray, float], Any]:
    """Import a function by its name, ``package.module:function``.

    The folder that the program was started in is looked at last.

    Raises
    ------
    InputError
        If there is no such module or function, or importing it fails.
    """
    module_name, _, path = name.partition(":")
    here = str(Path.cwd())
    if here not in sys.path:
        sys.path.append(here)
    try:
        found: Any = importlib.import_module(module_name)
    except (Exception, SystemExit) as error:
        raise InputError(
            f"{name}: cannot import {module_name!r} ({in_line(error)}); expected a "
            f"module that is installed, is found by PYTHONPATH, or lies in {here}, "
            f"{STARTED}"
        ) from error
    for part in path.split("."):
        known = [
            item
            for item in dir(found)
            if not item.startswith("_") and callable(getattr(found, item))
        ]
        if not hasattr(found, part):
            raise InputError(
                f"{name}: {module_name!r} has no function {path!r}; "
                f"{nearest(part, known)}"
            )
        found = getattr(found, part)
    if not callable(found):
        raise InputError(
            f"{name}: expected a function, got {type(found).__name__} {path!r}"
        )
    function: Callable[[FloatArray, float], Any] = found
    return function

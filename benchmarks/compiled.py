"""The C reference, built with the flags of setup.py and with more permissions."""

from __future__ import annotations

import ast
import ctypes
import os
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from benchmarks.reference import Adapted
from hystbench.envelope import Envelope
from hystbench.record import FloatArray

HERE = Path(__file__).parent
SETUP = HERE.parent / "setup.py"

#: Builds of the reference by name: what each may do beyond the flags of setup.py.
#: The kernels fix the order of their sums by hand; plain loops need leave to reorder.
BUILDS = {
    "C, same flags": (),
    "C, may reorder sums": ("-fassociative-math", "-freciprocal-math"),
    "C, -ffast-math": ("-ffast-math",),
}


def flags() -> list[str]:
    """Read the flags that setup.py builds the kernels with."""
    for node in ast.parse(SETUP.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "FLAGS":
            words = [
                item.value for item in ast.walk(node) if isinstance(item, ast.Constant)
            ]
            return [word for word in words if word != "-fvisibility=hidden"]
    raise SystemExit(f"{SETUP}: no FLAGS")


@cache
def build(name: str, taps: int) -> ctypes.CDLL:
    """Compile the reference for a number of taps.

    Linked without the extra flags: -ffast-math at the link would change denormals for
    the whole process.
    """
    compiler = os.environ.get("CC", "gcc").split()
    with tempfile.TemporaryDirectory() as folder:
        middle, library = Path(folder, "reference.o"), Path(folder, "reference.so")
        options = [*flags(), *BUILDS[name], f"-DTAPS={taps}"]
        source = str(HERE / "reference.c")
        subprocess.run(
            [*compiler, *options, "-c", source, "-o", str(middle)], check=True
        )
        link = [*compiler, "-shared", str(middle), "-lm", "-o", str(library)]
        subprocess.run(link, check=True)
        return ctypes.CDLL(str(library))


def _call(function: ctypes._CFuncPtr, *arguments: FloatArray | float | int) -> None:
    """Call a C function: int as index_t, float as double, arrays as pointers."""
    kinds = {int: ctypes.c_ssize_t, float: ctypes.c_double}
    plain = [
        ctypes.c_void_p(value.ctypes.data)
        if isinstance(value, np.ndarray)
        else kinds[type(value)](value)
        for value in arguments
    ]
    function.restype = None
    function(*plain)


class CReference:
    """The loops of one build, taking what :mod:`benchmarks.reference` takes."""

    def __init__(self, name: str, order: int) -> None:
        self._library = build(name, order + 1)
        self._order = order

    def lms(
        self, x: FloatArray, d: FloatArray, mu: float, ahead: bool = False
    ) -> Adapted:
        """LMS; ``ahead`` looks the next output ahead by one step."""
        line, w, y = self._line(x, 0), np.zeros(self._order + 1), np.empty(len(x))
        name = "reference_lms_ahead" if ahead else "reference_lms"
        _call(self._library[name], len(x), line, d, 2 * mu, w, y)
        return Adapted(y, w[::-1])

    def play_lms(
        self,
        x: FloatArray,
        d: FloatArray,
        mu: float,
        thresholds: FloatArray,
        envelope: Envelope | None = None,
        ahead: bool = False,
    ) -> Adapted:
        """Backlash, or GPO with an envelope; ``ahead`` as for LMS."""
        line, r = self._line(x, 1), thresholds[::-1].copy()
        w, y = np.zeros(self._order + 1), np.empty(len(x))
        spaces = np.empty_like(line), np.empty_like(line)
        filtered = *spaces, d, r, 2 * mu, w, y, int(ahead)
        if envelope is None:
            _call(self._library.reference_backlash, len(x), line, *filtered)
        else:
            a = np.array(list(envelope.to_dict().values()))
            _call(self._library.reference_gpo, len(x), line, a, *filtered)
        return Adapted(y, w[::-1])

    def volterra(
        self, x: FloatArray, d: FloatArray, mu1: float, mu2: float, fused: bool = False
    ) -> Adapted:
        """Full second-order Volterra filter; ``fused`` in one pass."""
        taps = self._order + 1
        first, second, y = np.zeros(taps), np.zeros((taps, taps)), np.empty(len(x))
        name = "reference_volterra_fused" if fused else "reference_volterra"
        steps = 2 * mu1, 2 * mu2
        line = self._line(x, 0)
        _call(self._library[name], len(x), line, d, *steps, first, second, y)
        return Adapted(y, np.concatenate((first[::-1], second[::-1, ::-1].ravel())))

    def prandtl_ishlinskii(
        self, left: FloatArray, right: FloatArray, r: FloatArray, weights: FloatArray
    ) -> FloatArray:
        """Eqs. 4 and 9 from rest."""
        y = np.empty(len(left))
        model = self._library.reference_prandtl_ishlinskii
        _call(model, len(left), left, right, r, weights, y)
        return y

    def rate_dependent(
        self, v: FloatArray, spacing: FloatArray, ratio: FloatArray
    ) -> FloatArray:
        """Plays whose thresholds and weights follow the rate, from rest."""
        y = np.empty(len(v))
        _call(self._library.reference_rate_dependent, len(v), v, spacing, ratio, y)
        return y

    def _line(self, x: FloatArray, more: int) -> FloatArray:
        return np.concatenate((np.zeros(self._order + more), x))

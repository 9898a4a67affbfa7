"""The hiding plant's own compiled loops, a library apart from :mod:`hystbench.kernels`.

They share no loop with it: what hides an effect and what finds it must not have one
mistake in common.
"""

from pathlib import Path
from typing import Any

import numpy as np

from hystbench.libraries import SIZE, Loops
from hystbench.record import FloatArray

LIBRARY = Path(__file__).with_name("_plant.so")

_SIGNATURES: dict[str, tuple[Any, str]] = {
    "hc_diffusion": (SIZE, "iiiffaa"),
    "hc_lag": (None, "iffaa"),
    "hc_oscillator": (None, "iffffaa"),
    "hc_slew": (None, "ifaa"),
    "hc_joint": (None, "ifaa"),
    "hc_stick_slip": (None, "ifffaa"),
    "hc_generalized_plays": (None, "iiaaaaaaa"),
    "hc_everett": (SIZE, "iiifaaaa"),
    "hc_jiles_atherton": (None, "ifffffaaa"),
    "hc_duhem": (None, "iffffaa"),
    "hc_mass": (None, "ifffffaaaaaa"),
    "hc_impedance": (None, "ifaaa"),
    "hc_tanks": (None, "iifaaaa"),
}


call = Loops(LIBRARY, _SIGNATURES, "the plant's compiled loops")


def run(
    name: str, *arguments: FloatArray | float | int, over: FloatArray
) -> FloatArray:
    """Call a loop that takes a signal last but one and writes its response last."""
    signal = np.ascontiguousarray(over, dtype=np.float64)
    out = np.empty_like(signal)
    call(name, len(signal), *arguments, signal, out)
    return out

"""Compiled loops: hysteresis, LMS filters and linear dynamics.

The C files beside this one make one shared library without Python's headers;
:mod:`ctypes` loads it and lets other threads run during a call. Arrays go in as
they are: C order, float64. The callers in :mod:`hystbench.operators` and
:mod:`hystbench.filters` see to shapes; what is here only passes pointers.
"""

from pathlib import Path
from typing import Any

import numpy as np

from hystbench.libraries import SIZE, Loops
from hystbench.libraries import Fixed as Fixed
from hystbench.libraries import address as address
from hystbench.record import FloatArray

WIDTH = 8
"""Lanes of a vector: the kernels want operators and weights padded to it."""

LIBRARY = Path(__file__).with_name("_kernels.so")

_SIGNATURES: dict[str, tuple[Any, str]] = {
    "hb_largest": (None, "iaa"),
    "hb_envelope": (None, "iffffaa"),
    "hb_follow_direction": (None, "iaaa"),
    "hb_play": (None, "iiaaaaa"),
    "hb_prandtl_ishlinskii": (SIZE, "iiaaaaaa"),
    "hb_enveloped_plays": (SIZE, "iiaaaaa"),
    "hb_rate_dependent": (SIZE, "iiaaaaaaaa"),
    "hb_growing_play": (None, "iiaaaaa"),
    "hb_growing_prandtl_ishlinskii": (SIZE, "iiaaaaaa"),
    "hb_lms_rows": (SIZE, "iiaiaafaaa"),
    "hb_lms_play": (None, "iiiaaiaaafaaaaia"),
    "hb_play_rows": (None, "iiaaiaaa"),
    "hb_lms_volterra": (SIZE, "iiiaaffffaaaaa"),
    "hb_state_space": (None, "iiiaaafaaa"),
    "hb_modes": (SIZE, "iiaaafaaa"),
    "hb_records": (SIZE, "iiia"),
    "hb_states": (SIZE, "iiaa"),
    "hb_weighed": (None, "iiiaaa"),
    "hb_decimated": (None, "iiiaaa"),
    "hb_curve_modes": (SIZE, "iiiiaaafaa"),
    "hb_curve_space": (SIZE, "iiiiaaafaa"),
    "hb_slew_limit": (None, "iffaa"),
    "hb_slew_with_lag": (None, "iifffaa"),
    "hb_acting_field": (None, "ifffaa"),
    "hb_hardening": (SIZE, "ifffffaa"),
    "hb_forces": (None, "ifiaaaaa"),
    "hb_settle": (None, "ffiaaa"),
    "hb_structure": (None, "iiaiiiffiaaiaaiaiaa"),
    "hb_store": (None, "iiffffffaaaa"),
    "hb_store_near": (None, "iiffffffaaaaiaaaaaaaa"),
    "hb_preisach": (None, "iifaaaaa"),
    "hb_jiles_atherton": (None, "iffffffaaa"),
    "hb_invert_plays": (SIZE, "iiifaaaffaaa"),
}


call = Loops(LIBRARY, _SIGNATURES, "the compiled kernels")
KERNELS = call.functions
"""Every kernel by its name."""


def largest(values: FloatArray) -> float:
    """Give the largest magnitude; NaN where a number is not finite, 0 for none."""
    found = np.empty(1)
    call("hb_largest", values.size, values, found)
    return float(found[0])


def padded(count: int) -> int:
    """Round a count of operators or weights up to whole vectors."""
    return -(-max(count, 1) // WIDTH) * WIDTH


def aligned(values: FloatArray) -> FloatArray:
    """Copy to where no vector lies across two lines of the processor's cache."""
    space = np.empty(values.size + WIDTH)
    start = -address(space) % 64 // 8
    out = space[start : start + values.size].reshape(values.shape)
    out[...] = values
    return out


def pad(values: FloatArray, filling: float = 0.0) -> FloatArray:
    """Copy a vector, filled up to whole vectors at its end."""
    count = len(values)
    out = np.empty(padded(count))
    out[:count] = values
    out[count:] = filling
    return out


def pad_front(values: FloatArray, filling: float = 0.0) -> FloatArray:
    """Copy a vector, filled up to whole vectors at its start."""
    start = padded(len(values)) - len(values)
    out = np.empty(start + len(values))
    out[:start] = filling
    out[start:] = values
    return out

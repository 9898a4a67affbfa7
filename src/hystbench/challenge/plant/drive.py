"""The drive: delay, amplifier and coil, eddy currents. Signals are currents in A."""

from __future__ import annotations

import numpy as np

from hystbench.challenge import kernels
from hystbench.challenge.plant.kind import Form, Kind, Parameters, Range, Run
from hystbench.record import FloatArray

#: Layers of the cross-section in which the diffusion is solved.
CELLS = 40

_FASTEST = 5e-5  # one and a half steps of the fine grid at its slowest


def delay(time: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Take the command when it was issued: the excitation is known at any time."""
    return time - p["delay_s"]


def lag(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Coil of inductance and resistance: ``tau dv/dt = z - v``."""
    return kernels.run("hc_lag", run.dt, p["time_constant_s"], over=z)


def slab(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Mean field in a slab, ``tau dh/dt = d2h/dx2`` with the field given outside."""
    return kernels.run("hc_diffusion", CELLS, 0, run.dt, p["time_constant_s"], over=z)


def rod(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Mean field in a round rod, the same in cylinder coordinates."""
    return kernels.run("hc_diffusion", CELLS, 1, run.dt, p["time_constant_s"], over=z)


def clip(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Limit the current at the amplifier's supply."""
    return np.clip(z, -p["limit"], p["limit"])


def slew(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Limit the rate of the current."""
    return kernels.run("hc_slew", p["rate"] * run.dt, over=z)


def dead_zone(z: FloatArray, run: Run, p: Parameters) -> FloatArray:
    """Give no current near zero: crossover of a push-pull stage."""
    return z - np.clip(z, -p["half_width"], p["half_width"])


def _lag_form(ranges: Range) -> dict[str, Form]:
    return {"first-order": Form(lag, {"time_constant_s": ranges}, "time_constant_s")}


_EDDY = Range(6e-4, 6e-3, "s", least=2e-4, most=0.05)

KINDS = (
    Kind(
        "input-delay",
        "drive",
        "command",
        ("delay", "frequency"),
        {
            "pure": Form(
                delay, {"delay_s": Range(1e-4, 2e-3, "s", most=0.01)}, "delay_s"
            )
        },
    ),
    Kind(
        "drive-lag",
        "drive",
        "drive",
        ("frequency", "delay"),
        _lag_form(Range(2e-4, 3e-3, "s", least=_FASTEST, most=0.03)),
    ),
    Kind(
        "eddy-diffusion",
        "drive",
        "drive",
        ("frequency", "delay"),
        {
            "slab": Form(
                slab,
                {"time_constant_s": _EDDY},
                "time_constant_s",
                told=lambda p: {**p, "geometry": "slab"},
            ),
            "rod": Form(
                rod,
                {"time_constant_s": _EDDY},
                "time_constant_s",
                told=lambda p: {**p, "geometry": "rod"},
            ),
        },
    ),
    Kind(
        "drive-saturation",
        "drive",
        "drive",
        ("amplitude",),
        {
            "clip": Form(
                clip,
                {"limit": Range(0.3, 0.5, "A", shifts=False, least=0.15, most=0.54)},
                "limit",
                power=-3.0,
            )
        },
    ),
    Kind(
        "slew-limit",
        "drive",
        "drive",
        ("rate", "frequency"),
        {
            "rate": Form(
                slew,
                {"rate": Range(25.0, 90.0, "A/s", shifts=False, least=5.0, most=400.0)},
                "rate",
                power=-1.5,
            )
        },
    ),
    Kind(
        "dead-zone",
        "drive",
        "drive",
        ("amplitude",),
        {
            "crossover": Form(
                dead_zone,
                {"half_width": Range(0.006, 0.04, "A", most=0.12)},
                "half_width",
            )
        },
    ),
)

"""What the text of the paper says of the displacement, as constraints on a twin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.published import load_text
from hystbench.record import FloatArray
from hystbench.waveforms.chirp import Chirp

SLACK_S = 0.02
"""How far from the printed times the chirp may turn: little over a period at 65 Hz."""
LEAST_RISE = 0.1
"""What the paper calls a remarkable increase is read as a tenth of the displacement."""
DURATION_S = 2.03  # 1 to 100 Hz at the rate of the two printed moments
SAMPLING_HZ = 10_000.0


class Turns(NamedTuple):
    """Where the chirp's displacement is least and greatest around the mode."""

    least_s: float
    greatest_s: float
    rise: float  # greatest over least, minus one


def turns(model: Model) -> Turns:
    """Find the turns of the chirp's displacement near the mode.

    The linear blocks are driven by the chirp and by its quadrature: the magnitude of
    the two responses is the displacement's envelope, without the hysteresis, whose
    gain does not depend on the rate.
    """
    time = np.arange(round(DURATION_S * SAMPLING_HZ)) / SAMPLING_HZ
    text = load_text()
    sweep = {
        "from_hz": text.chirp_from_hz,
        "to_hz": text.chirp_to_hz,
        "amplitude": 1.0,
        "duration_s": DURATION_S,
        "sampling_frequency_hz": SAMPLING_HZ,
    }
    slope = (text.chirp_to_hz - text.chirp_from_hz) / DURATION_S
    phase = 2 * np.pi * (text.chirp_from_hz * time + slope * time**2 / 2)
    pair = []
    for part in (Chirp.samples(**sweep), np.cos(phase)):
        for block in model.chain:
            if isinstance(block, LinearBlock):
                part = block.simulate(part, part, 1 / SAMPLING_HZ)
        pair.append(part)
    size = np.hypot(*pair)
    after = np.flatnonzero((time > text.chirp_minimum.time_s) & (time < 1.65))
    greatest = after[np.argmax(size[after])]
    before = np.flatnonzero((time > 1.0) & (time < time[greatest]))
    least = before[np.argmin(size[before])]
    return Turns(
        _vertex(time, size, least),
        _vertex(time, size, greatest),
        float(size[greatest] / size[least] - 1),
    )


def violations(model: Model) -> dict[str, float]:
    """Tell how far each constraint is exceeded; zero or less where it is met."""
    text, found = load_text(), turns(model)
    return {
        "chirp least (s)": abs(found.least_s - text.chirp_minimum.time_s) - SLACK_S,
        "chirp greatest (s)": abs(found.greatest_s - text.chirp_resonance.time_s)
        - SLACK_S,
        "rise at the mode": LEAST_RISE - found.rise,
    }


def check_stroke(name: str, y: FloatArray) -> None:
    """Refuse a displacement beyond the actuator's stroke.

    Raises
    ------
    InputError
        Naming the signal and how far it went.
    """
    stroke = load_text().stroke_um
    most = float(np.abs(y).max())
    if not most <= stroke:
        raise InputError(
            f"calibration: {name}: displacement of {most:.4g} um; "
            f"expected within the stroke of {stroke:g} um"
        )


def _vertex(time: FloatArray, size: FloatArray, place: int) -> float:
    """Refine a turn by the parabola through it and its neighbours."""
    if not 0 < place < len(size) - 1:
        return float(time[place])
    low, mid, high = size[place - 1 : place + 2]
    bend = low - 2 * mid + high
    shift = 0.5 * (low - high) / bend if bend else 0.0
    return float(time[place] + np.clip(shift, -1, 1) * (time[1] - time[0]))

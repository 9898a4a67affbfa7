"""Figure 10: sum of sines of 10, 30 and 50 Hz, the record and the GPO filter."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures.outputs import outputs_and_curves

# Two periods of the sum.
_SECONDS = 0.2


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw the outputs over time and the hysteresis curves."""
    return outputs_and_curves(records, runs, _SECONDS)

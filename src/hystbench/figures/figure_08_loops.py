"""Figure 8: loops of the sines, the record and the GPO filter, and its error."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures.loops_and_errors import loops_and_errors

_COLUMNS = 5


def draw(*, records: Sequence[Path], runs: Sequence[Path]) -> Figure:
    """Draw a loop a record, with one run on each, and the run's error below it."""
    return loops_and_errors(records, runs, _COLUMNS)

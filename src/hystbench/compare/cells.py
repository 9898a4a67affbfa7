"""Ours beside every printed number: one row a signal, model and metric."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median
from typing import Literal

from hystbench.compare.evidence import ClaimEvidence, Run
from hystbench.published import METRICS, Metric
from hystbench.published.consistency import Standing, standings

NOT_RUN = "not run"

#: Columns of cells.csv; a run that diverged has no ours.
CELL_COLUMNS = (
    *("table", "signal", "model", "metric", "half", "published", "ours"),
    *("spread_low", "spread_high", "draws_low", "draws_high", "log10_ratio"),
    *("published_consistent", "status"),
)

Half = Literal["calibrated", "held-out"]
"""Whether the twin and the step sizes were fitted to a signal's published errors."""


@dataclass(frozen=True, kw_only=True)
class ComparedCell:
    """A printed error and ours."""

    table: int
    """Table of the paper."""
    signal: str
    model: str
    metric: Metric
    """Which error."""
    half: Half
    """Whether the twin was fitted to the published errors of the signal."""
    published: str
    """As printed."""
    ours: float | None
    """None where it was not run or diverged. Of a signal that was drawn many times the
    median over the draws."""
    spread_low: float | None = None
    spread_high: float | None = None
    """Smallest and largest of ours over equally good twins, infinite where a run
    diverged; None where there are no two of them."""
    draws_low: float | None = None
    draws_high: float | None = None
    """Smallest and largest of ours over the draws of the signal, infinite where a run
    diverged; None where it has none."""
    published_consistent: Standing
    """Whether the printed pair of MSE and RE can be true beside the others of its
    signal; undecided where one of several pairs must be wrong."""
    status: str
    """``finite``, ``not run``, or the sentence that tells where it diverged."""

    @property
    def ran(self) -> bool:
        """Whether there is a run, finite or diverged."""
        return self.status != NOT_RUN

    @property
    def log10_ratio(self) -> float | None:
        """log10(ours / published); None without a finite run."""
        if self.ours is None:
            return None
        ratio = self.ours / float(self.published)
        return math.log10(ratio) if ratio > 0 else -math.inf

    @property
    def distance(self) -> float:
        """|log10(ours / published)|, infinite where the run diverged."""
        ratio = self.log10_ratio
        return math.inf if ratio is None else abs(ratio)


def _status(run: Run | None, ours: float | None) -> str:
    if run is None:
        return NOT_RUN
    if ours is None and run.diverged is None:
        return "diverged in half of the draws or more"
    return run.status


def compare_cells(
    evidence: ClaimEvidence, held_out: Iterable[str] = ()
) -> tuple[ComparedCell, ...]:
    """Set ours beside each of the 124 printed numbers, run or not.

    Parameters
    ----------
    evidence : ClaimEvidence
    held_out : iterable of str
        Signals whose published errors the twin was not fitted to.
    """
    unseen = set(held_out)
    consistent = standings(evidence.published)
    runs = evidence.twin_runs
    cells = []
    for pair in evidence.published:
        run = runs.get((pair.signal, pair.model))
        drawn = evidence.drawn.get(pair.signal)
        for metric in METRICS:
            errors = drawn.errors.get((pair.model, metric), ()) if drawn else ()
            ours = None
            if run is not None and run.diverged is None:
                middle = median(errors or [run.error(metric)])
                ours = middle if math.isfinite(middle) else None
            low, high = evidence.spreads.get(
                (pair.signal, pair.model, metric), (None, None)
            )
            cells.append(
                ComparedCell(
                    table=pair.table,
                    signal=pair.signal,
                    model=pair.model,
                    metric=metric,
                    half="held-out" if pair.signal in unseen else "calibrated",
                    published=pair.printed(metric).text,
                    ours=ours,
                    spread_low=low,
                    spread_high=high,
                    draws_low=min(errors, default=None),
                    draws_high=max(errors, default=None),
                    published_consistent=consistent[pair.signal, pair.model],
                    status=_status(run, ours),
                )
            )
    return tuple(cells)

"""Ours beside every printed number, and what is known of those that are off."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

from hystbench.compare.runs import ClaimEvidence, Run
from hystbench.metrics import rms
from hystbench.published import FILTERS, METRICS, Metric
from hystbench.published.consistency import Standing, check, standings
from hystbench.templates import paragraphs

NOT_RUN = "not run"
#: Ours over the paper's, or theirs over ours: up to it a cell is near.
NEAR_FACTOR = 2.0

#: Columns of cells.csv; a run that diverged has no ours.
CELL_COLUMNS = (
    *("table", "signal", "model", "metric", "half", "published", "ours"),
    *("spread_low", "spread_high", "draws_low", "draws_high", "log10_ratio"),
    *("published_consistent", "status"),
)

#: Columns of off.csv.
OFF_COLUMNS = (
    *("table=cell.table", "signal=cell.signal", "model=cell.model", "half=cell.half"),
    *("published=cell.published", "ours=cell.ours", "ratio"),
    *("published_consistent=cell.published_consistent", "known"),
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
    """The number as printed."""
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
    cells = []
    for pair in evidence.published:
        run = evidence.runs.get((pair.signal, pair.model))
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


def rms_error_percent(evidence: ClaimEvidence) -> dict[str, float]:
    """Hold the twin's RMS displacement against the one that the tables imply.

    Returns
    -------
    dict of str to float
        By signal of which there is a record: 100 (ours / implied - 1); of a signal
        that was drawn many times, the median over the draws. The implied
        one is the middle of what the consistent rows share; where one of several
        rows must be wrong, the mean of the middles.
    """
    errors = {}
    for signal, checked in check(evidence.published).items():
        record = evidence.records.get(signal)
        if record is None:
            continue
        ours = rms(record.y)
        if signal in evidence.drawn:
            ours = median(evidence.drawn[signal].rms)
        errors[signal] = 100 * (ours / checked.implied_rms - 1)
    return errors


@dataclass(frozen=True)
class OffCell:
    """A cell off by more than a factor of 2 in MSE, and one sentence on it."""

    cell: ComparedCell
    known: str

    @property
    def ratio(self) -> float | None:
        """Ours over the published; None where the run diverged."""
        ours = self.cell.ours
        return None if ours is None else ours / float(self.cell.published)


def off_cells(
    cells: Sequence[ComparedCell], evidence: ClaimEvidence
) -> tuple[OffCell, ...]:
    """Find the cells of MSE that are off; a diverged run is off.

    RE is the same error over the same record, so that MSE alone is looked at. Each
    sentence is computed from the results: it says what goes with the distance, not what
    causes it.
    """
    mse = [cell for cell in cells if cell.metric == "mse" and cell.ran]
    off = [cell for cell in mse if cell.distance > math.log10(NEAR_FACTOR)]
    percent = rms_error_percent(evidence)

    def same_way(cell: ComparedCell, others: Sequence[ComparedCell]) -> str:
        """Count those of a row or a column that are off to the same side."""
        ratios = [
            (cell.log10_ratio or 0) * (other.log10_ratio or 0) for other in others
        ]
        return f"{sum(ratio > 0 for ratio in ratios)} of {len(others)}"

    def known(cell: ComparedCell) -> str:
        row = [c for c in mse if c.signal == cell.signal and c.model in FILTERS]
        column = [c for c in mse if c.model == cell.model]
        (text,) = paragraphs(
            __package__,
            "known.txt.j2",
            cell=cell,
            is_filter=cell.model in FILTERS,
            row=same_way(cell, row),
            column=same_way(cell, column),
            percent=percent.get(cell.signal),
            run=evidence.runs[cell.signal, cell.model],
        )
        return text

    return tuple(OffCell(cell, known(cell)) for cell in off)

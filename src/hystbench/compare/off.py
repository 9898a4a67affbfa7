"""Cells that are off by more than a factor of 2, and what is known of each.

Each sentence is computed from the results. It says what goes with the distance, not
what causes it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hystbench.compare.cells import ComparedCell
from hystbench.compare.evidence import ClaimEvidence, Run
from hystbench.compare.summary import NEAR_FACTOR, rms_error_percent
from hystbench.published import FILTERS

#: Columns of off.csv.
OFF_COLUMNS = (
    *("table=cell.table", "signal=cell.signal", "model=cell.model", "half=cell.half"),
    *("published=cell.published", "ours=cell.ours", "ratio"),
    *("published_consistent=cell.published_consistent", "known"),
)


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

    RE is the same error over the same record, so that MSE alone is looked at.
    """
    mse = [cell for cell in cells if cell.metric == "mse" and cell.ran]
    off = [cell for cell in mse if cell.distance > math.log10(NEAR_FACTOR)]
    percent = rms_error_percent(evidence)

    def known(cell: ComparedCell) -> str:
        if cell.ours is None:
            return f"Ours {cell.status}."
        parts = (
            _size(cell),
            _company(cell, mse),
            _consistency(cell),
            _record(percent.get(cell.signal)),
            _start_up(evidence.runs[cell.signal, cell.model]),
            _spread(cell),
        )
        return f"{'; '.join(filter(None, parts))}."

    return tuple(OffCell(cell, known(cell)) for cell in off)


def _size(cell: ComparedCell) -> str:
    if not cell.ours:
        return "Ours is zero"
    high = cell.ours > float(cell.published)
    factor = 10**cell.distance
    return f"Ours is too {'high' if high else 'low'} by a factor of {factor:.2g}"


def _company(cell: ComparedCell, cells: Sequence[ComparedCell]) -> str:
    """Tell whether the row or the column is off the same way."""

    def same_way(other: ComparedCell) -> bool:
        mine, theirs = cell.log10_ratio, other.log10_ratio
        return mine is not None and theirs is not None and mine * theirs > 0

    if cell.model not in FILTERS:
        return ""
    row = [c for c in cells if c.signal == cell.signal and c.model in FILTERS]
    column = [c for c in cells if c.model == cell.model]
    return (
        f"{sum(map(same_way, row))} of {len(row)} filters on this signal and this "
        f"filter on {sum(map(same_way, column))} of {len(column)} signals lie on "
        "that side"
    )


def _consistency(cell: ComparedCell) -> str:
    return {
        "yes": "",
        "no": "the published pair of MSE and RE cannot be true beside the others of "
        "its signal",
        "undecided": "the published pair of MSE and RE may be wrong",
    }[cell.published_consistent]


def _record(percent: float | None) -> str:
    if percent is None:
        return ""
    off = f"{percent:+.1f}"
    return f"the RMS displacement is off by {off} %" if float(off) else ""


def _start_up(run: Run) -> str:
    share = run.start_up_share
    if share is None or run.error_kind == "free-run simulation":
        return ""
    return (
        f"the first {100 * run.transient_fraction:.0f} % of the record hold "
        f"{100 * share:.0f} % of our squared error"
    )


def _spread(cell: ComparedCell) -> str:
    low, high = cell.spread_low, cell.spread_high
    if low is None or high is None:
        return ""
    reached = low <= float(cell.published) <= high
    return (
        f"over equally good twins ours goes from {low:.2g} to "
        + ("divergence" if math.isinf(high) else f"{high:.2g}")
        + f", which {'holds' if reached else 'does not hold'} the published value"
    )

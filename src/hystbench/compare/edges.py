"""Measured edges of the step sizes, beside Eq. 19's bound."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from hystbench.compare.rows import names_of
from hystbench.files import write_csv


@dataclass(frozen=True)
class Edge:
    """How far the step size of a filter can go on a signal.

    Volterra's two step sizes go together; the first-order one is told.

    Parameters
    ----------
    signal, model : str
    mu : float
        The configured step size.
    largest_correction : float
        2 mu max|H|^2 of it, the share of an error that one update corrects.
    at_trace : float
        Step size at Eq. 19's bound, 1 / tr[R].
    at_power : float
        Step size at which one update corrects twice the error, 1 / max|H|^2.
    edge : float or None
        Least step size of the sweep at which the error is as large as the
        displacement or the filter diverges; None where the sweep found none.
    speed_trend : float or None
        Rank correlation with the step size, up to half of the edge, of the time after
        which the error is small; None where the time does not change.
    """

    signal: str
    model: str
    mu: float
    largest_correction: float
    at_trace: float
    at_power: float
    edge: float | None
    speed_trend: float | None

    @property
    def inside(self) -> bool:
        """Whether a step size inside Eq. 19's bound is beyond the edge."""
        return self.edge is not None and self.edge < self.at_trace

    @property
    def edge_over_trace(self) -> float | None:
        """The edge as a part of Eq. 19's bound."""
        return None if self.edge is None else self.edge / self.at_trace

    @property
    def edge_over_power(self) -> float | None:
        """The edge as a part of that at which twice the error is corrected."""
        return None if self.edge is None else self.edge / self.at_power


COLUMNS = (*names_of(Edge), "edge_over_trace", "edge_over_power")


def write_margins(edges: Sequence[Edge], held_out: Collection[str], path: Path) -> None:
    """Write 2 mu max|H|^2 as configured, a row a signal and a column a filter."""
    models = list(dict.fromkeys(each.model for each in edges))
    found = {(e.signal, e.model): f"{e.largest_correction:.3f}" for e in edges}
    rows = [
        [
            signal,
            "held-out" if signal in held_out else "calibrated",
            *(found.get((signal, model), "") for model in models),
        ]
        for signal in dict.fromkeys(each.signal for each in edges)
    ]
    write_csv(path, ("signal", "half", *models), rows)

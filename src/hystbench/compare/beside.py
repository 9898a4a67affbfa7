"""What was run beside the evidence: other twins, draws, step sizes and constants.

Each row of a file is one of the classes here, a column a field.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hystbench.compare.rows import names_of, read_items
from hystbench.files import write_csv
from hystbench.published import METRICS, Metric


@dataclass(frozen=True)
class TwinError:
    """Errors of a model on a signal of a twin; infinite where it diverged."""

    twin: str
    family: str
    signal: str
    model: str
    mse: float
    re: float
    status: str


@dataclass(frozen=True)
class TwinClaim:
    """Whether a claim holds on a twin; experiment 0 is the configured one."""

    twin: str
    family: str
    experiment: int
    claim: str
    holds: str
    """One of ``yes``, ``no`` and ``not testable``."""


@dataclass(frozen=True)
class Draw:
    """Errors of a model on one draw of the random sum; infinite where it diverged."""

    signal: str
    sines: int
    draw: int
    """Number of its sines, and which draw; 0 is the configured one."""
    model: str
    mse: float
    re: float
    rms: float
    """RMS displacement of the record (um)."""


ErrorKey = tuple[str, str, Metric]
"""Signal, model and metric."""


def by_error(rows: Iterable[TwinError | Draw]) -> dict[ErrorKey, tuple[float, ...]]:
    """Collect what rows say of each error."""
    found: dict[ErrorKey, tuple[float, ...]] = {}
    for row in rows:
        for metric in METRICS:
            key = (row.signal, row.model, metric)
            found[key] = (*found.get(key, ()), getattr(row, metric))
    return found


def read_spreads(path: str | Path) -> dict[ErrorKey, tuple[float, float]]:
    """Read the range of each error over the twins of the first twin's family.

    Returns
    -------
    dict
        Smallest and largest by signal, model and metric, infinite where a run
        diverged. Empty where the family has one twin: it has no spread.
    """
    rows = read_items(path, TwinError)
    alike = [row for row in rows if row.family == rows[0].family]
    if len({row.twin for row in alike}) < 2:
        return {}
    return {key: (min(found), max(found)) for key, found in by_error(alike).items()}


@dataclass(frozen=True)
class Holding:
    """In how many experiments on the twins of a family a claim holds."""

    family: str
    """Name of the block that makes the hysteresis."""
    held: int
    judged: int
    """Experiments in which it holds, and in which it could be judged."""

    @property
    def throughout(self) -> bool:
        """Whether it holds in each of them."""
        return self.held == self.judged

    def __str__(self) -> str:
        return f"{self.family} {self.held} of {self.judged}"


def read_holdings(path: str | Path) -> dict[str, tuple[Holding, ...]]:
    """Read in how many experiments on twins of each family each claim holds."""
    counts: dict[str, dict[str, list[bool]]] = {}
    for row in read_items(path, TwinClaim):
        if row.holds != "not testable":
            families = counts.setdefault(row.claim, {})
            families.setdefault(row.family, []).append(row.holds == "yes")
    return {
        claim: tuple(
            Holding(family, sum(found), len(found))
            for family, found in families.items()
        )
        for claim, families in counts.items()
    }


@dataclass(frozen=True)
class Drawn:
    """What the draws of one signal say, by model and metric."""

    errors: Mapping[tuple[str, Metric], tuple[float, ...]]
    """Errors over the draws, by model and metric."""
    rms: tuple[float, ...]
    """RMS displacements (um) over the draws."""


def read_draws(path: str | Path) -> dict[str, Drawn]:
    """Read the draws of the configured number of sines, the file's first, by signal."""
    draws = read_items(path, Draw)
    found: dict[str, Drawn] = {}
    for signal in dict.fromkeys(each.signal for each in draws):
        own = [each for each in draws if each.signal == signal]
        own = [each for each in own if each.sines == own[0].sines]
        errors = {
            (model, metric): values
            for (_, model, metric), values in by_error(own).items()
        }
        rms = {each.draw: each.rms for each in own}
        found[signal] = Drawn(errors, tuple(rms.values()))
    return found


@dataclass(frozen=True)
class Edge:
    """How far the step size of a filter can go on a signal.

    Volterra's two step sizes go together; the first-order one is told.
    """

    signal: str
    model: str
    mu: float
    """The configured step size."""
    largest_correction: float
    """2 mu max|H|^2 of it, the share of an error that one update corrects."""
    at_trace: float
    """Step size at Eq. 19's bound, 1 / tr[R]."""
    at_power: float
    """Step size at which one update corrects twice the error, 1 / max|H|^2."""
    edge: float | None
    """Least step size of the sweep at which the error is as large as the displacement
    or the filter diverges; None where the sweep found none."""
    speed_trend: float | None
    """Rank correlation with the step size, up to half of the edge, of the time after
    which the error is small; None where the time does not change."""

    @property
    def fails_below_bound(self) -> bool:
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


EDGE_COLUMNS = (*names_of(Edge), "edge_over_trace", "edge_over_power")


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


@dataclass(frozen=True)
class Ranking:
    """The ranking on a twin with one constant.

    Parameters
    ----------
    twin, family : str
    zero_error_mA : float
        Constant on the recorded input (mA).
    constant_tap : float
        Size of the constant tap beside the RMS of the others; zero for none.
    configured : {"yes", ""}
        Whether both are as in config.yaml.
    gpo_first, signals : int
        Signals on which the GPO filter has the least MSE, and all.
    first_elsewhere : str
        The others, each with the filter that has.
    pairs_calibrated, pairs_held_out : str
        Pairs of filters under one signal in the paper's order, and all: ``40 of 48``.
    diverged : int
        Runs that diverged.
    mean_mse_gpo_um2, ... : float
        Geometric mean of a filter's MSE over the signals; infinite where one diverged.
    """

    twin: str
    family: str
    zero_error_mA: float  # noqa: N815 - the unit
    constant_tap: float
    configured: str
    gpo_first: int
    signals: int
    first_elsewhere: str
    pairs_calibrated: str
    pairs_held_out: str
    diverged: int
    mean_mse_gpo_um2: float
    mean_mse_backlash_um2: float
    mean_mse_volterra_um2: float
    mean_mse_delayed_um2: float

"""What a comparison stands on: the runs' own files."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from hystbench.compare.beside import (
    Drawn,
    Edge,
    Holding,
    Ranking,
    read_draws,
    read_holdings,
    read_spreads,
)
from hystbench.compare.rows import read_items
from hystbench.files import read_json
from hystbench.order_errors import OrderError
from hystbench.published import (
    MODELS,
    Metric,
    Pair,
    Text,
    in_order,
    load_errors,
    load_text,
    signals,
)
from hystbench.record import Record, load_record

Cell = tuple[str, str]
"""Signal and model."""


@dataclass(frozen=True, kw_only=True)
class Run:
    """Result of one model on one record, as ``results/filters`` holds it."""

    signal: str
    model: str
    origin: str
    """What ran on what; ``origin`` is ``twin`` or ``measured``."""
    error_kind: str
    """``one-step a priori`` or ``free-run simulation``."""
    order: int | None = None
    weight_count: int | None = None
    """Order N and number of weights; None where the model has none."""
    step_size: Mapping[str, float] = field(default_factory=dict)
    bound: Mapping[str, float] = field(default_factory=dict)
    """Step sizes and their bounds by Eq. 19, by the same names."""
    diverged: str | None = None
    """The sentence that tells where it diverged; None for a finite run."""
    mse: float | None = None
    re: float | None = None
    mse_after_transient: float | None = None
    re_after_transient: float | None = None
    """Errors over the record, and after its transient; None where diverged."""
    unit: str
    """Unit of the MSE."""
    largest_eigenvalue: float | None = None
    spread: float | None = None
    """Largest eigenvalue of the input correlation matrix R, and the spread of its
    nonzero eigenvalues."""
    convergence_s: float | None = None
    """Time after which the smoothed squared error stays near its end."""
    transient_fraction: float = 0.0
    """Part of the record that the errors after the transient leave out."""

    @property
    def start_up_share(self) -> float | None:
        """Share of the record's summed squared error that its transient holds.

        None where the run diverged or has no error.
        """
        if not self.mse or self.mse_after_transient is None:
            return None
        later = (1 - self.transient_fraction) * self.mse_after_transient
        return 1 - later / self.mse

    @property
    def status(self) -> str:
        """The word ``finite``, or the sentence on the divergence."""
        return self.diverged or "finite"

    def error(self, metric: str) -> float:
        """Give the MSE or the RE; infinity where the run diverged."""
        value = self.mse if metric == "mse" else self.re
        return math.inf if value is None else value


@dataclass(frozen=True)
class ClaimEvidence:
    """All that the claims are judged by, of the twin; what was not run is missing.

    ``spreads`` and ``holdings`` are what other twins say, and ``constants`` what the
    ranking is with other constants; no claim is judged by them. Errors of a signal in
    ``drawn`` are the medians over its draws. ``order_sweep_other`` is the order
    sweep with one step size for all orders. ``identification`` is what Algorithm 1
    found on the slow loop, as its file has it.
    """

    published: tuple[Pair, ...] = field(default_factory=load_errors)
    text: Text = field(default_factory=load_text)
    runs: Mapping[Cell, Run] = field(default_factory=dict)
    records: Mapping[str, Record] = field(default_factory=dict)
    order_sweep: tuple[OrderError, ...] = ()
    order_sweep_other: tuple[OrderError, ...] = ()
    identification: Mapping[str, Any] | None = None
    envelope_errors: Mapping[Cell, float] = field(default_factory=dict)
    spreads: Mapping[tuple[str, str, Metric], tuple[float, float]] = field(
        default_factory=dict
    )
    holdings: Mapping[str, tuple[Holding, ...]] = field(default_factory=dict)
    drawn: Mapping[str, Drawn] = field(default_factory=dict)
    edges: tuple[Edge, ...] = ()
    constants: tuple[Ranking, ...] = ()

    @property
    def added_models(self) -> tuple[str, ...]:
        """Models among the runs that the paper does not have."""
        return tuple(in_order({model for _, model in self.runs} - {*MODELS}))

    @property
    def added_signals(self) -> tuple[str, ...]:
        """Signals among the runs that the paper's tables do not have."""
        known = signals(self.published)
        told = dict.fromkeys(signal for signal, _ in self.runs)
        return tuple(signal for signal in told if signal not in known)

    @property
    def added(self) -> tuple[Run, ...]:
        """Runs of models or signals that the paper's tables do not have."""
        models, names = {*self.added_models}, {*self.added_signals}
        runs = self.runs.values()
        return tuple(r for r in runs if r.model in models or r.signal in names)

    @property
    def of_the_paper(self) -> ClaimEvidence:
        """What there is of the paper's own models: its claims are of no others."""
        points = (self.order_sweep, self.order_sweep_other)
        own, other = (tuple(p for p in each if p.model in MODELS) for each in points)
        return replace(
            self,
            runs={cell: run for cell, run in self.runs.items() if cell[1] in MODELS},
            order_sweep=own,
            order_sweep_other=other,
            edges=tuple(edge for edge in self.edges if edge.model in MODELS),
        )

    def on_signals(self, signals: Iterable[str]) -> ClaimEvidence:
        """Keep what is said on some signals, the published errors among it."""
        kept = set(signals)

        def of(found: Mapping[Any, Any]) -> dict[Any, Any]:
            """Keep what stands under a signal, or a signal and something else."""
            alone = {key: key if isinstance(key, str) else key[0] for key in found}
            return {key: found[key] for key, signal in alone.items() if signal in kept}

        return replace(
            self,
            published=tuple(p for p in self.published if p.signal in kept),
            runs=of(self.runs),
            records=of(self.records),
            envelope_errors=of(self.envelope_errors),
            drawn=of(self.drawn),
        )


_KEPT = (
    *("signal", "model", "origin", "error_kind", "convergence_s"),
    *("mse", "re", "mse_after_transient", "re_after_transient"),
)


def read_run(path: str | Path) -> Run:
    """Read the file of one run."""
    content = read_json(path)
    diverged = content["diverged"]
    of_filter: dict[str, Any] = {}
    if content["error_kind"] == "one-step a priori":
        of_filter = {key: content[key] for key in ("order", "step_size", "bound")}
        of_filter["weight_count"] = len(content["weights"])
        of_filter["largest_eigenvalue"] = content["eigenvalues"]["largest"]
        of_filter["spread"] = content["eigenvalues"]["spread_nonzero"]
    length = content["samples"] * content["dt_s"]
    return Run(
        **{key: content[key] for key in _KEPT},
        diverged=diverged["sentence"] if diverged else None,
        unit=content["units"]["mse"],
        transient_fraction=content["transient_s"] / length,
        **of_filter,
    )


@dataclass(frozen=True)
class EnvelopeError:
    """MSE of the GPO filter on a signal, infinite where it diverged."""

    signal: str
    envelopes: str
    """Either ``identified`` or ``published``."""
    mse: float


def read_envelope_errors(path: str | Path) -> dict[Cell, float]:
    """Read the GPO filter's MSE by signal and envelopes (identified, published)."""
    rows = read_items(path, EnvelopeError)
    return {(row.signal, row.envelopes): row.mse for row in rows}


FILES: dict[str, tuple[str, Callable[[str | Path], Any]]] = {
    "order_sweep": ("order_sweep", partial(read_items, kind=OrderError)),
    "order_sweep_other": ("order_sweep_other", partial(read_items, kind=OrderError)),
    "identified": ("identification", read_json),
    "envelopes": ("envelope_errors", read_envelope_errors),
    "twin_errors": ("spreads", read_spreads),
    "twin_claims": ("holdings", read_holdings),
    "draws": ("drawn", read_draws),
    "edges": ("edges", partial(read_items, kind=Edge)),
    "constants": ("constants", partial(read_items, kind=Ranking)),
}
"""What evidence is read from beside runs and records: its field, and the reader."""


def read_evidence(
    runs: Iterable[str | Path],
    records: Iterable[str | Path] = (),
    **files: str | Path | None,
) -> ClaimEvidence:
    """Read the files of a comparison.

    Parameters
    ----------
    runs, records : iterable of path
    **files : path or None
        By the names in ``FILES``; one left out, or None, was not run.
    """
    found = {(run.signal, run.model): run for run in map(read_run, runs)}
    read = {
        FILES[name][0]: FILES[name][1](path)
        for name, path in files.items()
        if path is not None
    }
    named = {record.name: record for record in map(load_record, records)}
    return ClaimEvidence(runs=found, records=named, **read)

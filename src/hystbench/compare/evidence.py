"""What a comparison stands on: the runs' own files, read and checked."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.errors import InputError, nearest
from hystbench.files import read_json
from hystbench.published import Pair, Text, load, load_text
from hystbench.record import FloatArray, Record, load_record

Cell = tuple[str, str]
"""Signal and model."""


@dataclass(frozen=True)
class Run:
    """Result of one model on one record, as ``results/filters`` holds it.

    Parameters
    ----------
    signal, model, origin : str
        What ran on what; ``origin`` is ``twin`` or ``measured``.
    error_kind : str
        ``one-step a priori`` or ``free-run simulation``.
    order, weight_count : int or None
        Order N and number of weights; None where the model has none.
    step_size, bound : dict of str to float
        Step sizes and their bounds by Eq. 19, by the same names.
    diverged : str or None
        The sentence that tells where it diverged; None for a finite run.
    mse, re, mse_after_transient, re_after_transient : float or None
        Errors over the record, and after its transient; None where diverged.
    unit : str
        Unit of the MSE.
    largest_eigenvalue, spread : float or None
        Of the input correlation matrix R; the spread is over nonzero eigenvalues.
    convergence_s : float or None
        Time after which the smoothed squared error stays near its end.
    """

    signal: str
    model: str
    origin: str
    error_kind: str
    order: int | None
    weight_count: int | None
    step_size: dict[str, float]
    bound: dict[str, float]
    diverged: str | None
    mse: float | None
    re: float | None
    mse_after_transient: float | None
    re_after_transient: float | None
    unit: str
    largest_eigenvalue: float | None
    spread: float | None
    convergence_s: float | None

    @property
    def status(self) -> str:
        """The word ``finite``, or the sentence on the divergence."""
        return self.diverged or "finite"

    def error(self, metric: str) -> float:
        """Give the MSE or the RE; infinity where the run diverged."""
        value = self.mse if metric == "mse" else self.re
        return math.inf if value is None else value


@dataclass(frozen=True)
class OrderPoint:
    """Error of one filter at one order (Figure 7); infinity where it diverged."""

    model: str
    order: int
    mse: float


@dataclass(frozen=True)
class Identification:
    """Result of Algorithm 1 on the slow loop."""

    envelope: dict[str, float]
    thresholds: FloatArray
    weights: FloatArray
    sums: FloatArray
    epsilon: float
    reached: bool
    relative_error: float
    published_relative_error: float


@dataclass(frozen=True)
class Evidence:
    """All that the claims are judged by; what was not run is missing here."""

    published: tuple[Pair, ...] = field(default_factory=load)
    text: Text = field(default_factory=load_text)
    runs: Mapping[Cell, Run] = field(default_factory=dict)
    records: Mapping[str, Record] = field(default_factory=dict)
    order_sweep: tuple[OrderPoint, ...] = ()
    identification: Identification | None = None
    envelope_errors: Mapping[Cell, float] = field(default_factory=dict)


def _need(content: Mapping[str, Any], key: str, path: str | Path) -> Any:
    """Take a key of a file or say which is missing."""
    if key not in content:
        raise InputError(f"{path}: no key {key!r}; {nearest(key, content)}")
    return content[key]


def _content(path: str | Path) -> dict[str, Any]:
    try:
        content = read_json(path)
    except (OSError, json.JSONDecodeError) as error:
        raise InputError(f"{path}: not a readable JSON file ({error})") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected a JSON object")
    return content


def read_run(path: str | Path) -> Run:
    """Read the file of one run.

    Raises
    ------
    InputError
        If a key is missing, or the status and the errors disagree.
    """
    content = _content(path)

    def need(key: str) -> Any:
        return _need(content, key, path)

    status, diverged = need("status"), need("diverged")
    if status not in ("finite", "diverged"):
        raise InputError(f"{path}: status {status!r}; {nearest(status, _STATUSES)}")
    if (status == "diverged") != (diverged is not None):
        raise InputError(f"{path}: status {status!r} and 'diverged' disagree")
    if status == "finite" and need("mse") is None:
        raise InputError(f"{path}: a finite run needs an MSE")
    adaptive = need("error_kind") == "one-step a priori"
    eigenvalues = need("eigenvalues") if adaptive else {}
    return Run(
        signal=need("signal"),
        model=need("model"),
        origin=need("origin"),
        error_kind=need("error_kind"),
        order=need("order") if adaptive else None,
        weight_count=len(need("weights")) if adaptive else None,
        step_size=need("step_size") if adaptive else {},
        bound=need("bound") if adaptive else {},
        diverged=_need(diverged, "sentence", path) if diverged else None,
        **{key: need(key) for key in _ERRORS},
        unit=_need(need("units"), "mse", path),
        largest_eigenvalue=eigenvalues.get("largest"),
        spread=eigenvalues.get("spread_nonzero"),
        convergence_s=need("convergence_s"),
    )


_STATUSES = ("finite", "diverged")
_PARAMETERS = tuple(f"a{j}" for j in range(8))
_ERRORS = ("mse", "re", "mse_after_transient", "re_after_transient")


def _rows(path: str | Path, columns: tuple[str, ...]) -> list[dict[str, str]]:
    """Read a CSV file that has these columns."""
    try:
        with Path(path).open(encoding="utf-8", newline="") as stream:
            reader = csv.DictReader(stream)
            rows = list(reader)
    except OSError as error:
        raise InputError(f"{path}: not readable ({error})") from error
    for column in columns:
        if column not in (reader.fieldnames or ()):
            known = nearest(column, reader.fieldnames or ())
            raise InputError(f"{path}: no column {column!r}; {known}")
    return rows


def _finite_or_inf(text: str, path: str | Path, row: int) -> float:
    """Read an error; an empty one means that the run diverged."""
    try:
        return float(text) if text else math.inf
    except ValueError as error:
        raise InputError(f"{path}: row {row}: {text!r} is not a number") from error


def read_order_sweep(path: str | Path) -> tuple[OrderPoint, ...]:
    """Read the errors by order of each filter: model, order, mse, status."""
    return tuple(
        OrderPoint(row["model"], int(row["order"]), _finite_or_inf(row["mse"], path, n))
        for n, row in enumerate(_rows(path, ("model", "order", "mse", "status")), 1)
    )


def read_envelope_errors(path: str | Path) -> dict[Cell, float]:
    """Read the GPO filter's MSE by signal and envelopes (identified, published)."""
    columns = ("signal", "envelopes", "mse", "re", "status")
    return {
        (row["signal"], row["envelopes"]): _finite_or_inf(row["mse"], path, n)
        for n, row in enumerate(_rows(path, columns), 1)
    }


def read_identification(path: str | Path) -> Identification:
    """Read the result of Algorithm 1."""
    content = _content(path)

    def array(key: str) -> FloatArray:
        return np.asarray(_need(content, key, path), dtype=float)

    envelope = _need(content, "envelope", path)
    return Identification(
        envelope={key: float(_need(envelope, key, path)) for key in _PARAMETERS},
        thresholds=array("thresholds"),
        weights=array("weights"),
        sums=array("J"),
        epsilon=_need(content, "epsilon", path),
        reached=_need(content, "reached", path),
        relative_error=_need(content, "relative_error", path),
        published_relative_error=_need(content, "published_relative_error", path),
    )


def read_evidence(
    runs: Iterable[str | Path],
    records: Iterable[str | Path] = (),
    order_sweep: str | Path | None = None,
    identified: str | Path | None = None,
    envelopes: str | Path | None = None,
) -> Evidence:
    """Read the files of a comparison; a path left out was not run.

    Raises
    ------
    InputError
        If a file is not what it should be, or two runs are of one signal and model.
    """
    found: dict[Cell, Run] = {}
    for path in runs:
        run = read_run(path)
        if (run.signal, run.model) in found:
            raise InputError(f"{path}: a second run of {run.model} on {run.signal}")
        found[run.signal, run.model] = run
    return Evidence(
        runs=found,
        records={r.name: r for r in map(load_record, records)},
        order_sweep=() if order_sweep is None else read_order_sweep(order_sweep),
        identification=None if identified is None else read_identification(identified),
        envelope_errors={} if envelopes is None else read_envelope_errors(envelopes),
    )

"""Run: one model on one record, its errors and its learning curve, as files."""

from pathlib import Path
from typing import Any, Literal

import numpy as np

from hystbench.files import atomic_path, write_json
from hystbench.metrics import (
    mean_square_error,
    relative_error,
    smoothed_squared_error,
)
from hystbench.record import FloatArray, Record

ErrorKind = Literal["one-step a priori", "free-run simulation"]

ERRORS = ("mse", "re", "mse_after_transient", "re_after_transient", "convergence_s")
"""What a run that did not diverge has."""
CURVE_POINTS = 200
"""Points of a stored learning curve: more than a figure can show."""


def run_result(
    record: Record,
    model: str,
    error: FloatArray,
    error_kind: ErrorKind,
    *,
    transient_fraction: float,
    smoothing_fraction: float,
    diverged: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Compute what is kept of a run of any model.

    Parameters
    ----------
    record : Record
        The record; its output is the reference d(k).
    model : str
        Name of the model.
    error : ndarray, shape (n,)
        ``d(k) - y(k)``, up to the divergence where there is one.
    error_kind : {"one-step a priori", "free-run simulation"}
        What the error means; never compared without saying so.
    transient_fraction : float
        Part of the record that the errors after the transient leave out.
    smoothing_fraction : float
        Part of the record over which e^2 is averaged for the learning curve.
    diverged : dict, optional
        ``sample`` and ``sentence`` of a divergence. The run then has no errors.

    Returns
    -------
    dict
        Ready for JSON. Errors in the square of the output's unit: ``mse`` (mean of
        e^2), ``re`` (sqrt(sum e^2 / sum d^2)), the same after the transient, the
        smoothed e^2 over time, and ``convergence_s``, after which the smoothed e^2
        stays below twice its median over the record's last quarter.
    """
    start = round(transient_fraction * len(record))
    window = max(1, round(smoothing_fraction * len(record)))
    errors: dict[str, float | None] = dict.fromkeys(ERRORS)
    # A filter may diverge before one window is full, or at once.
    window = min(window, len(error))
    smoothed = smoothed_squared_error(error, window) if window else error
    if diverged is None:
        # A sample that was not measured has no error.
        counted = record.counted
        late = counted & (np.arange(len(record)) >= start)
        errors = {
            "mse": mean_square_error(error[counted]),
            "re": relative_error(error[counted], record.y[counted]),
            "mse_after_transient": mean_square_error(error[late]),
            "re_after_transient": relative_error(error[late], record.y[late]),
            "convergence_s": _convergence(smoothed, record.dt),
        }
    kept = np.unique(
        np.linspace(0, max(len(smoothed) - 1, 0), CURVE_POINTS).astype(int)
    )[: len(smoothed)]
    return {
        "signal": record.name,
        "model": model,
        "origin": record.origin,
        "use": record.use,
        "error_kind": error_kind,
        "samples": len(record),
        "dt_s": record.dt,
        "status": "finite" if diverged is None else "diverged",
        "diverged": diverged,
        **errors,
        "transient_s": start * record.dt,
        "units": {"mse": f"{record.output.unit}^2"},
        "smoothed_squared_error": {
            "window_s": window * record.dt,
            "time_s": (kept * record.dt).tolist(),
            "value": smoothed[kept].tolist(),
        },
    }


def save_run(
    path: str | Path,
    arrays: str | Path,
    result: dict[str, Any],
    output: FloatArray,
    error: FloatArray,
) -> None:
    """Write a run: the result as JSON, output and error as a NumPy archive."""
    with atomic_path(arrays) as temporary, temporary.open("wb") as stream:
        np.savez(stream, output=output, error=error)
    write_json(path, result)


def _convergence(smoothed: FloatArray, dt: float) -> float:
    final = np.median(smoothed[-max(1, len(smoothed) // 4) :])
    above = np.flatnonzero(smoothed > 2 * final)
    return float((above[-1] + 1) * dt) if len(above) else 0.0

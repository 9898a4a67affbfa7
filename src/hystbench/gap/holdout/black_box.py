"""What the black box reaches on hold-out records, beside the named effects."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hystbench.gap.holdout.runs_away import bounded, reach
from hystbench.gap.holdout.shrink import Shrink, plain, records_mapping, shrink
from hystbench.gap.judging.black_box import BlackBox
from hystbench.gap.records.nuisance import Nuisance
from hystbench.gap.records.residual import rms
from hystbench.record import FloatArray, Record


def black_box_mapping(
    box: BlackBox,
    records: Sequence[Record],
    simulated: Sequence[FloatArray],
    named: Shrink,
    nuisance: Nuisance | None = None,
) -> dict[str, Any]:
    """Give what gap.json holds under ``black_box``.

    Parameters
    ----------
    box : BlackBox
    records : sequence of Record
        The hold-out records.
    simulated : sequence of ndarray, shape (n,) each
        Output of the base, which the black box corrects.
    named : Shrink
        What the named effects reach on the same records.
    nuisance : callable, optional
        The same as for ``named``.

    Returns
    -------
    dict
        ``explained_on_folds``, and on hold-out records ``after`` (RMS), ``explained``,
        both with an interval, and ``records``; each of these has ``named`` (RMS after
        the named effects) and ``outside`` (in what the record lies outside the training
        range). ``outside`` has RMS over those that lie outside, None where none does.
        ``after`` and ``named`` are None where a model runs away.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        corrected = [
            output + box.predict(record, output)
            for record, output in zip(records, simulated, strict=True)
        ]
    usual = reach(simulated, named.noise_floor)
    kept, _ = bounded("the black box", records, corrected, usual)
    reached = shrink(
        records, simulated, kept, named.noise_floor, named.floor_method, nuisance
    )
    rows = records_mapping(reached)
    for row, record, other in zip(rows, records, named.records, strict=True):
        row["named"] = other.after
        row["outside"] = list(box.outside(record))
    content: dict[str, Any] = {
        "explained_on_folds": box.explained_on_folds,
        "after": reached.after,
        "explained": plain(reached.explained),
        "records": rows,
        "outside": _together([row for row in rows if row["outside"]]),
    }
    for key in ("after_interval", "interval"):
        ends = getattr(reached, key)
        if ends is not None:
            content[key] = list(ends)
    return content


def _together(rows: Sequence[dict[str, Any]]) -> dict[str, float | None] | None:
    """RMS over records alike, of the base, the black box and the named effects."""
    if not rows:
        return None
    found: dict[str, float | None] = {}
    for key in ("before", "after", "named"):
        sizes = [row[key] for row in rows]
        found[key] = None if None in sizes else rms(np.array(sizes))
    return found

"""Measures of the errors of Tables 1-4, taken alike of ours and of the paper's."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from statistics import median
from typing import Any

import pandas as pd

from hystbench.compare.claims.claim import NotTestable, Numbers, number
from hystbench.compare.claims.statistics import rank_correlation
from hystbench.compare.runs import Cell, ClaimEvidence
from hystbench.published import FILTERS, MODELS, Metric, sines
from hystbench.published import signals as signals_of

TABLES = {"sines": (1,), "chirp": (2,), "sums": (3,), "all": (1, 2, 3)}
"""Tables of the paper that hold a sort of signals."""


def errors_on(
    signals: Sequence[str],
    models: Iterable[str],
    evidence: ClaimEvidence,
    of: str,
    metric: Metric = "mse",
) -> pd.DataFrame:
    """Give errors, a row a signal and a column a model; infinite of a diverged run.

    They are of the twin, or the published ones.

    Raises
    ------
    NotTestable
        If there is no signal, or any of the runs is missing; the message counts and
        names them.
    """
    models = list(models)
    if not signals:
        raise NotTestable("none of the signals that it is about is asked for")
    found: dict[Cell, float]
    if of == "published":
        found = {
            (pair.signal, pair.model): pair.printed(metric).value
            for pair in evidence.published
        }
    else:
        found = {cell: run.error(metric) for cell, run in evidence.runs.items()}
        for signal, drawn in evidence.drawn.items():
            for (model, each), errors in drawn.errors.items():
                if each == metric and (signal, model) in found:
                    found[signal, model] = median(errors)
    asked = [(signal, model) for signal in signals for model in models]
    if missing := [f"{model} on {s}" for s, model in asked if (s, model) not in found]:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise NotTestable(f"not run: {missing[0]}{more}")
    values = [[found[signal, model] for model in models] for signal in signals]
    return pd.DataFrame(values, index=list(signals), columns=models)


def low_sines(evidence: ClaimEvidence, up_to_hz: float) -> list[str]:
    """List the sines of Table 1 up to a frequency."""
    return [s for s, hz in sines(evidence.published).items() if hz <= up_to_hz]


def least(
    evidence: ClaimEvidence,
    signals: str,
    winner: str,
    models: Sequence[str] = FILTERS,
    of: str = "twin",
) -> Numbers:
    """Count how often a model has not the smallest MSE on a sort of signals."""
    asked = signals_of(evidence.published, *TABLES[signals])
    return _least(errors_on(asked, dict.fromkeys((winner, *models)), evidence, of))


def _least(errors: pd.DataFrame) -> dict[str, Any]:
    """Hold the first column against the others."""
    winner, *names = errors
    own, rivals = errors[winner], errors[names]
    beaten = [
        f"{rival} {number(there[rival])} against {winner} {number(there[winner])} "
        f"on {signal}"
        for signal, there in errors.to_dict("index").items()
        for rival in names
        if there[rival] <= there[winner]
    ]
    if beaten:
        told = (
            f"{winner} is beaten in {len(beaten)} of {rivals.size} comparisons of MSE: "
            f"{beaten[0]}"
        )
        return {"beaten": len(beaten), "told": told}
    margins = rivals.min(axis=1) / own
    told = (
        f"{winner} has the smallest MSE on {len(own)} of {len(own)} signals; the "
        f"closest rival has {number(margins.min())} times its MSE, on "
        f"{margins.idxmin()}"
    )
    return {"beaten": 0, "told": told}


def least_anywhere(evidence: ClaimEvidence, of: str = "twin") -> Numbers:
    """Compare the GPO filter with all models, where each of them has errors."""
    with_rdgpi = signals_of(evidence.published, 4)
    others = signals_of(evidence.published, 1, 2, 3)
    without = [signal for signal in others if signal not in with_rdgpi]
    first = _least(errors_on(with_rdgpi, MODELS, evidence, of))
    second = _least(errors_on(without, FILTERS, evidence, of))
    for each in (first, second):
        if each["beaten"]:
            return each
    return {"beaten": 0, "told": f"{first['told']}; {second['told']}"}


def along_sines(
    evidence: ClaimEvidence,
    model: str,
    metric: Metric = "mse",
    of: str = "twin",
    *,
    ahead: bool = False,
) -> Numbers:
    """Follow an error from each sine to the next, or the next best filter's over it."""
    frequencies = sines(evidence.published)
    models = FILTERS if ahead else [model]
    errors = errors_on(list(frequencies), models, evidence, of, metric)
    own, hz = errors[model], list(frequencies.values())
    values = errors.drop(columns=model).min(axis=1) / own if ahead else own
    points = list(zip(hz, values, strict=True))
    steps = list(pairwise(points))
    ends = points[0], points[-1]
    not_rising = [step for step in steps if step[1][1] <= step[0][1]]
    (low, first), (high, last) = ends
    (start, before), (end, after) = not_rising[0] if not_rising else ends
    return {
        "steps": len(steps),
        "not_rising": len(not_rising),
        "not_falling": sum(step[1][1] >= step[0][1] for step in steps),
        "low": low,
        "first": first,
        "high": high,
        "last": last,
        "start": start,
        "before": before,
        "end": end,
        "after": after,
        "trend": rank_correlation(hz, list(values)),
    }


def largest_at_low_sines(
    evidence: ClaimEvidence, model: str, up_to_hz: float, of: str = "twin"
) -> Numbers:
    """Compare the filters at the lowest sines."""
    errors = errors_on(low_sines(evidence, up_to_hz), FILTERS, evidence, of)
    worse = [
        f"{other} {number(there[other])} on {signal}"
        for signal, there in errors.to_dict("index").items()
        for other in FILTERS
        if other != model and there[other] >= there[model]
    ]
    return {
        "worse": len(worse),
        "first": worse[0] if worse else "",
        "own": ", ".join(
            f"{number(error)} on {s}" for s, error in errors[model].items()
        ),
    }


def chirp_and_sines(
    evidence: ClaimEvidence, model: str, up_to_hz: float, of: str = "twin"
) -> Numbers:
    """Hold the chirp against the sines of its band."""
    chirp, low = signals_of(evidence.published, 2), low_sines(evidence, up_to_hz)
    on_chirp, on_sines = (
        errors_on(each, [model], evidence, of, "re")[model] for each in (chirp, low)
    )
    return {
        "chirp": on_chirp.iat[0],
        "sine": on_sines.max(),
        "hardest": on_sines.idxmax(),
    }

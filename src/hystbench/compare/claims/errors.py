"""Measures of the errors of Tables 1-4, taken alike of ours and of the paper's."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from hystbench.compare.cells import twin_runs
from hystbench.compare.claims.claim import NotTestable, Numbers, need_runs, number
from hystbench.compare.claims.statistics import rank_correlation
from hystbench.compare.evidence import ClaimEvidence
from hystbench.published import (
    FILTERS,
    METRICS,
    MODELS,
    Metric,
    Pair,
    signals,
    sine_frequency,
)

TABLES = {"sines": (1,), "chirp": (2,), "sums": (3,), "all": (1, 2, 3)}
"""Tables of the paper that hold a sort of signals."""


@dataclass(frozen=True)
class Errors:
    """Errors by signal and model, ours or the paper's, behind one look-up.

    A diverged run has infinite errors.
    """

    values: Mapping[tuple[str, str, Metric], float]
    published: tuple[Pair, ...]

    def of(self, signal: str, model: str, metric: Metric = "mse") -> float:
        """Give one error."""
        return self.values[signal, model, metric]

    def need(self, signals: Iterable[str], models: Iterable[str]) -> None:
        """Stop the test of a claim where a run is missing.

        Raises
        ------
        NotTestable
            If there is no signal to test it on, or any of the runs is missing; the
            message counts and names them.
        """
        listed = list(models)
        cells = [(signal, model) for signal in signals for model in listed]
        if not cells:
            raise NotTestable("none of the signals that it is about is asked for")
        need_runs(cells, {(signal, model) for signal, model, _ in self.values})

    def signals(self, *tables: int) -> tuple[str, ...]:
        """List the signals of tables of the paper."""
        return signals(self.published, *tables)

    @property
    def sines(self) -> dict[str, float]:
        """Frequencies of the sines of Table 1 in Hz, rising."""
        found = {
            pair.signal: frequency
            for pair in self.published
            if (frequency := sine_frequency(pair.signal)) is not None
        }
        return dict(sorted(found.items(), key=lambda sine: sine[1]))


def read_errors(evidence: ClaimEvidence, of: str) -> Errors:
    """Look up the errors of the twin, or the published ones."""
    values: dict[tuple[str, str, Metric], float] = {}
    if of == "published":
        for pair in evidence.published:
            for metric in METRICS:
                values[pair.signal, pair.model, metric] = pair.printed(metric).value
        return Errors(values, evidence.published)
    for (signal, model), run in twin_runs(evidence.runs).items():
        for metric in METRICS:
            values[signal, model, metric] = run.error(metric)
    for signal, drawn in evidence.drawn.items():
        for model, metric in drawn.errors:
            if (signal, model, metric) in values:
                values[signal, model, metric] = drawn.median(model, metric)
    return Errors(values, evidence.published)


def least(
    evidence: ClaimEvidence,
    signals: str,
    winner: str,
    models: Sequence[str] = FILTERS,
    of: str = "twin",
) -> Numbers:
    """Count how often a model has not the smallest MSE on a sort of signals."""
    errors = read_errors(evidence, of)
    return _least(errors, errors.signals(*TABLES[signals]), winner, models)


def _least(
    errors: Errors, signals: Sequence[str], winner: str, models: Iterable[str]
) -> Numbers:
    rivals = [model for model in models if model != winner]
    errors.need(signals, (winner, *rivals))
    beaten = [
        f"{rival} {number(errors.of(s, rival))} against {winner} "
        f"{number(errors.of(s, winner))} on {s}"
        for s in signals
        for rival in rivals
        if errors.of(s, rival) <= errors.of(s, winner)
    ]
    if beaten:
        told = (
            f"{winner} is beaten in {len(beaten)} of {len(signals) * len(rivals)} "
            f"comparisons of MSE: {beaten[0]}"
        )
        return {"beaten": len(beaten), "told": told}
    margins = {
        s: min(errors.of(s, rival) for rival in rivals) / errors.of(s, winner)
        for s in signals
    }
    closest = min(margins, key=lambda s: margins[s])
    told = (
        f"{winner} has the smallest MSE on {len(signals)} of {len(signals)} signals; "
        f"the closest rival has {number(margins[closest])} times its MSE, on {closest}"
    )
    return {"beaten": 0, "told": told}


def least_anywhere(evidence: ClaimEvidence, of: str = "twin") -> Numbers:
    """Compare the GPO filter with all models, where each of them has errors."""
    errors = read_errors(evidence, of)
    with_rdgpi = errors.signals(4)
    without = [s for s in errors.signals(1, 2, 3) if s not in with_rdgpi]
    first = _least(errors, with_rdgpi, "gpo", MODELS)
    second = _least(errors, without, "gpo", FILTERS)
    if first["beaten"]:
        return first
    if second["beaten"]:
        return second
    return {"beaten": 0, "told": f"{first['told']}; {second['told']}"}


def advantage(evidence: ClaimEvidence, of: str = "twin") -> Numbers:
    """Follow the next best filter's MSE over the GPO's along the sines."""
    errors = read_errors(evidence, of)
    sines = list(errors.sines)
    errors.need(sines, FILTERS)
    ratios = [
        min(errors.of(s, model) for model in FILTERS if model != "gpo")
        / errors.of(s, "gpo")
        for s in sines
    ]
    return {
        "first": ratios[0],
        "last": ratios[-1],
        "low": errors.sines[sines[0]],
        "high": errors.sines[sines[-1]],
        "trend": rank_correlation(list(errors.sines.values()), ratios),
    }


def along_sines(
    evidence: ClaimEvidence, model: str, metric: Metric, of: str = "twin"
) -> Numbers:
    """Follow an error from each sine to the next."""
    errors = read_errors(evidence, of)
    errors.need(errors.sines, [model])
    points = [(hz, errors.of(s, model, metric)) for s, hz in errors.sines.items()]
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
    }


def largest_at_low_sines(
    evidence: ClaimEvidence, model: str, up_to_hz: float, of: str = "twin"
) -> Numbers:
    """Compare the filters at the lowest sines."""
    errors = read_errors(evidence, of)
    low = [s for s, hz in errors.sines.items() if hz <= up_to_hz]
    errors.need(low, FILTERS)
    worse = [
        f"{other} {number(errors.of(s, other))} on {s}"
        for s in low
        for other in FILTERS
        if other != model and errors.of(s, other) >= errors.of(s, model)
    ]
    return {
        "worse": len(worse),
        "first": worse[0] if worse else "",
        "own": ", ".join(f"{number(errors.of(s, model))} on {s}" for s in low),
    }


def chirp_and_sines(
    evidence: ClaimEvidence, model: str, up_to_hz: float, of: str = "twin"
) -> Numbers:
    """Hold the chirp against the sines of its band."""
    errors = read_errors(evidence, of)
    sines = [s for s, hz in errors.sines.items() if hz <= up_to_hz]
    chirps = errors.signals(2)
    errors.need(chirps, [model])
    errors.need(sines, [model])
    hardest = max(sines, key=lambda s: errors.of(s, model, "re"))
    return {
        "chirp": errors.of(chirps[0], model, "re"),
        "sine": errors.of(hardest, model, "re"),
        "hardest": hardest,
    }

"""A claim of the paper, how it is tested, and what came out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

from hystbench.compare.cells import twin_runs
from hystbench.compare.evidence import Cell, Evidence, Run
from hystbench.compare.twins import Holding, holding_text
from hystbench.published import FILTERS, Metric, Pair, sine_frequency

Verdict = Literal[
    "reproduced", "not reproduced", "not testable", "refuted by the paper"
]
BornOut = Literal["yes", "no", "not in tables"]
Kind = Literal["result", "theory", "condition", "notation"]
"""What was found, derived, set up for the experiment, or is a matter of writing."""
Basis = Literal["", "held-out", "fitted", "constrained", "built-in"]
"""What the twin knew of a claim before it was judged.

- ``held-out``: nothing, no fit has read what the claim is judged by;
- ``fitted``: cells or RMS displacements that it is judged by are in the calibration;
- ``constrained``: a bound of the calibration asks for it;
- ``built-in``: it follows from how twin and signals are made;
- empty for theory, notation and what cannot be tested.
"""


@dataclass(frozen=True)
class Finding:
    """Whether a claim holds, and the numbers that say so in one sentence."""

    holds: bool
    evidence: str


class NotTestable(Exception):  # noqa: N818 - it is no error but a verdict
    """A claim lacks what it needs; the message says what."""


@dataclass(frozen=True)
class Claim:
    """One checkable sentence of the paper.

    Parameters
    ----------
    id : str
        Short name.
    claim : str
        The sentence, quoted or in short.
    where : str
        Section, equation, table or figure.
    kind : {"result", "theory", "condition"}
        What sort of sentence it is.
    reading : str
        How the sentence was made checkable, where its words alone do not say.
    basis : str
        What the twin knew of it; see ``Basis``.
    ours : callable
        Judges it by our own evidence.
    theirs : callable or None
        Judges it by the paper's printed numbers; None where it prints none.
    """

    id: str
    claim: str
    where: str
    kind: Kind
    reading: str
    basis: Basis
    ours: Callable[[Evidence], Finding]
    theirs: Callable[[Evidence], Finding] | None = None


@dataclass(frozen=True)
class Judgement:
    """A claim with its verdict; a row of ``claims.csv``."""

    claim: Claim
    verdict: Verdict
    evidence: str
    published_bears_out: BornOut
    published_evidence: str
    holdings: tuple[Holding, ...] = ()
    #: Verdict on the held-out signals alone, of a claim that is fitted in part.
    held_out_verdict: str = ""

    @property
    def holds_on(self) -> str:
        """On how many twins of which family the claim holds; see ``Holding``."""
        return holding_text(self.holdings)


def judge(claim: Claim, evidence: Evidence) -> Judgement:
    """Judge one claim by our evidence and by the paper's own numbers."""
    verdict: Verdict
    try:
        found = claim.ours(evidence)
    except NotTestable as reason:
        verdict, sentence = "not testable", str(reason)
    else:
        verdict = "reproduced" if found.holds else "not reproduced"
        sentence = found.evidence
    holdings = evidence.holdings.get(claim.id, ())
    if claim.theirs is None:
        return Judgement(claim, verdict, sentence, "not in tables", "", holdings)
    printed = claim.theirs(evidence)
    born_out: BornOut = "yes" if printed.holds else "no"
    if not printed.holds:
        verdict = "refuted by the paper"
    return Judgement(claim, verdict, sentence, born_out, printed.evidence, holdings)


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

    @property
    def sines(self) -> list[str]:
        """Sines of Table 1 by rising frequency."""
        found = {
            pair.signal: frequency
            for pair in self.published
            if (frequency := sine_frequency(pair.signal)) is not None
        }
        return sorted(found, key=lambda signal: found[signal])

    def table(self, number: int) -> list[str]:
        """List the signals of a table of the paper."""
        return list(
            dict.fromkeys(p.signal for p in self.published if p.table == number)
        )


def need_runs(cells: Iterable[Cell], there: Iterable[Cell]) -> None:
    """Raise :class:`NotTestable` where runs are missing."""
    known = set(there)
    missing = [f"{model} on {s}" for s, model in cells if (s, model) not in known]
    if missing:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise NotTestable(f"not run: {missing[0]}{more}")


def our_errors(evidence: Evidence) -> Errors:
    """Look up our errors on the twin."""
    values: dict[tuple[str, str, Metric], float] = {}
    for (signal, model), run in twin_runs(evidence.runs).items():
        values[signal, model, "mse"] = run.error("mse")
        values[signal, model, "re"] = run.error("re")
    for signal, drawn in evidence.drawn.items():
        for model, metric in drawn.errors:
            if (signal, model, metric) in values:
                values[signal, model, metric] = drawn.median(model, metric)
    return Errors(values, evidence.published)


def published_errors(evidence: Evidence) -> Errors:
    """Look up the paper's errors."""
    values: dict[tuple[str, str, Metric], float] = {}
    for pair in evidence.published:
        values[pair.signal, pair.model, "mse"] = pair.mse.value
        values[pair.signal, pair.model, "re"] = pair.re.value
    return Errors(values, evidence.published)


def lms_runs(evidence: Evidence, models: Iterable[str] = FILTERS) -> list[Run]:
    """List the twin's runs of the adaptive filters.

    Raises
    ------
    NotTestable
        If there is none.
    """
    wanted = tuple(models)
    runs = [run for run in twin_runs(evidence.runs).values() if run.model in wanted]
    if not runs:
        raise NotTestable(f"not run: {' and '.join(wanted)}")
    return runs


def errors_claim(
    id: str,  # noqa: A002 - the field's name
    claim: str,
    where: str,
    reading: str = "",
    basis: Basis = "fitted",
) -> Callable[[Callable[[Errors], Finding]], Claim]:
    """Make a claim on errors, tested alike on ours and on the paper's."""

    def make(test: Callable[[Errors], Finding]) -> Claim:
        return Claim(
            id=id,
            claim=claim,
            where=where,
            kind="result",
            reading=reading,
            basis=basis,
            ours=lambda evidence: test(our_errors(evidence)),
            theirs=lambda evidence: test(published_errors(evidence)),
        )

    return make


def claim_on(
    id: str,  # noqa: A002 - the field's name
    claim: str,
    where: str,
    kind: Kind,
    reading: str = "",
    theirs: Callable[[Evidence], Finding] | None = None,
    *,
    basis: Basis = "",
) -> Callable[[Callable[[Evidence], Finding]], Claim]:
    """Make a claim on other evidence than the errors."""

    def make(test: Callable[[Evidence], Finding]) -> Claim:
        return Claim(id, claim, where, kind, reading, basis, test, theirs)

    return make


def untestable(
    id: str,  # noqa: A002 - the field's name
    claim: str,
    where: str,
    kind: Kind,
    reason: str,
) -> Claim:
    """Make a claim that no run of a twin can judge, with the reason."""

    def test(_: Evidence) -> Finding:
        raise NotTestable(reason)

    return Claim(id, claim, where, kind, "", "", test)


def number(value: float) -> str:
    """Write an error for a sentence."""
    return "diverged" if math.isinf(value) else f"{value:.4g}"

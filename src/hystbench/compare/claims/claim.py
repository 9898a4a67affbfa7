"""A claim of the paper, the test that it is put to, and what came out."""

import math
import operator
import re
import string
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from hystbench.compare.beside import Holding, holding_text
from hystbench.compare.evidence import Cell, ClaimEvidence, Run
from hystbench.published import FILTERS

Verdict = Literal[
    "reproduced", "not reproduced", "not testable", "refuted by the paper"
]
BornOut = Literal["yes", "no", "not in tables"]
ClaimKind = Literal["result", "theory", "condition", "notation"]
"""What was found, derived, set up for the experiment, or is a matter of writing."""
Basis = Literal["", "held-out", "fitted", "constrained", "built-in"]
"""What the twin knew of a claim before it was judged.

- ``held-out``: nothing, no fit has read what the claim is judged by;
- ``fitted``: cells or RMS displacements that it is judged by are in the calibration;
- ``constrained``: a bound of the calibration asks for it;
- ``built-in``: it follows from how twin and signals are made;
- empty for theory, notation and what cannot be tested.
"""

Numbers = Mapping[str, Any]
"""What a measure finds: numbers, and parts of the sentence, by name."""
Measure = Callable[..., Numbers]
"""Finds numbers in evidence; takes the arguments of a row of the table as well."""


PREDICATES: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    "==": operator.eq,
    ">=": operator.ge,
    ">": operator.gt,
}
_CONDITION = re.compile(r"(?:(\S+) \* )?(\w+) (<=|<|==|>=|>) (?:(\S+) \* )?(\S+)")


@dataclass(frozen=True)
class Tested:
    """Whether a claim holds, and the numbers that say so in one sentence."""

    holds: bool
    evidence: str


class NotTestable(Exception):  # noqa: N818 - it is no error but a verdict
    """A claim lacks what it needs; the message says what."""


@dataclass(frozen=True)
class Condition:
    """A comparison of a measured number with a limit: ``2 * better >= both``.

    Raises
    ------
    ValueError
        If the text is no such comparison.
    """

    text: str
    """``name predicate limit``. The predicate is one of ``PREDICATES``; the limit is a
    number or the name of another measured number. A factor may stand before each
    name."""

    def __post_init__(self) -> None:
        """Refuse what cannot be read."""
        self._parts()

    def _parts(self) -> tuple[str | Any, ...]:
        found = _CONDITION.fullmatch(self.text)
        if found is None:
            raise ValueError(f"{self.text!r}: expected 'name <= limit' or alike")
        return found.groups()

    def holds(self, numbers: Numbers) -> bool:
        """Tell whether the numbers fulfil it; NaN fulfils none."""
        times, name, predicate, limit_times, limit = self._parts()
        left = _scaled(times, numbers[name])
        known = numbers[limit] if limit in numbers else float(limit)
        return bool(PREDICATES[predicate](left, _scaled(limit_times, known)))


def _scaled(factor: str | None, value: Any) -> Any:
    return value if factor is None else float(factor) * value


class Sentence(string.Formatter):
    """Write numbers into a sentence.

    An infinite error reads ``diverged``. A format that ends in ``%``, such as
    ``.2g%``, writes a fraction in per cent.
    """

    def format_field(self, value: Any, format_spec: str) -> str:
        """Write one number."""
        if isinstance(value, float) and math.isinf(value):
            return "diverged"
        if format_spec.endswith("%"):
            return f"{100 * value:{format_spec[:-1]}} %"
        return format(value, format_spec)


def number(value: float) -> str:
    """Write an error for a sentence."""
    return Sentence().format_field(float(value), ".4g")


@dataclass(frozen=True)
class Test:
    """How a claim is judged: a measure, conditions on its numbers, and a sentence."""

    measure: Measure | None
    """None where nothing can judge it: the sentence says why."""
    arguments: Mapping[str, Any] = field(default_factory=dict)
    """What the measure takes beside the evidence."""
    holds: tuple[Condition, ...] = ()
    """The claim holds where all of them do."""
    says: str = ""
    """Sentence with the numbers in braces."""
    otherwise: str = ""
    """The sentence where the claim does not hold; empty for the same."""

    def __call__(self, evidence: ClaimEvidence) -> Tested:
        """Judge the claim by evidence.

        Raises
        ------
        NotTestable
            If the evidence lacks what the measure needs.
        """
        if self.measure is None:
            raise NotTestable(self.says)
        numbers = self.measure(evidence, **self.arguments)
        holds = all(condition.holds(numbers) for condition in self.holds)
        text = self.says if holds or not self.otherwise else self.otherwise
        return Tested(holds, Sentence().vformat(text, (), numbers))


@dataclass(frozen=True)
class Claim:
    """One checkable sentence of the paper; a row of ``claims.yaml``."""

    id: str
    """Short name."""
    claim: str
    """The sentence, quoted or in short."""
    where: str
    """Section, equation, table or figure."""
    kind: ClaimKind
    """What sort of sentence it is."""
    reading: str
    """How the sentence was made checkable, where its words alone do not say."""
    basis: str
    """What the twin knew of it; see ``Basis``."""
    ours: Callable[[ClaimEvidence], Tested]
    """Judges it by our own evidence."""
    theirs: Callable[[ClaimEvidence], Tested] | None = None
    """Judges it by the paper's printed numbers; None where it prints none."""


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


def judge(claim: Claim, evidence: ClaimEvidence) -> Judgement:
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


def holds(claim: Claim, evidence: ClaimEvidence) -> bool | None:
    """Tell whether a claim holds; None where it cannot be tested."""
    try:
        return claim.ours(evidence).holds
    except NotTestable:
        return None


def about_signals(claim: Claim, restricted: ClaimEvidence) -> bool:
    """Tell whether a claim can be judged on some signals, and only with them."""
    without = replace(restricted, runs={}, records={}, envelope_errors={}, drawn={})
    return holds(claim, without) is None and holds(claim, restricted) is not None


def need_runs(cells: Iterable[Cell], there: Iterable[Cell]) -> None:
    """Raise :class:`NotTestable` where runs are missing."""
    known = set(there)
    missing = [f"{model} on {s}" for s, model in cells if (s, model) not in known]
    if missing:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise NotTestable(f"not run: {missing[0]}{more}")


def lms_runs(evidence: ClaimEvidence, models: Iterable[str] = FILTERS) -> list[Run]:
    """List the twin's runs of the adaptive filters.

    Raises
    ------
    NotTestable
        If there is none.
    """
    wanted = tuple(models)
    runs = [run for run in evidence.twin_runs.values() if run.model in wanted]
    if not runs:
        raise NotTestable(f"not run: {' and '.join(wanted)}")
    return runs

"""A claim of the paper, the test that it is put to, and what came out."""

import math
import operator
import re
import string
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from hystbench.compare.beside import Holding
from hystbench.compare.runs import ClaimEvidence

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
Condition = Callable[[Numbers], bool]
"""Tells whether numbers fulfil it; NaN fulfils none."""

PREDICATES: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    "==": operator.eq,
    ">=": operator.ge,
    ">": operator.gt,
}
_CONDITION = re.compile(r"(?:(\S+) \* )?(\w+) (<=|<|==|>=|>) (?:(\S+) \* )?(\S+)")


class NotTestable(Exception):  # noqa: N818 - it is no error but a verdict
    """A claim lacks what it needs; the message says what."""


def condition(text: str) -> Condition:
    """Read a comparison of a measured number with a limit: ``2 * better >= both``.

    Parameters
    ----------
    text : str
        ``name predicate limit``. The predicate is one of ``PREDICATES``; the limit is
        a number or the name of another measured number. A factor may stand before
        each name.

    Raises
    ------
    ValueError
        If the text is no such comparison.
    """
    found = _CONDITION.fullmatch(text)
    if found is None:
        raise ValueError(f"{text!r}: expected 'name <= limit' or alike")
    times, name, predicate, limit_times, limit = found.groups("1")

    def holds(numbers: Numbers) -> bool:
        known = numbers[limit] if limit in numbers else float(limit)
        left, right = float(times) * numbers[name], float(limit_times) * known
        return bool(PREDICATES[predicate](left, right))

    return holds


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

    def __call__(self, evidence: ClaimEvidence) -> tuple[bool | None, str]:
        """Judge the claim by evidence.

        Returns
        -------
        holds : bool or None
            None where the evidence lacks what the measure needs.
        sentence : str
            The numbers that say so, or what is lacking.
        """
        if self.measure is None:
            return None, self.says
        try:
            numbers = self.measure(evidence, **self.arguments)
        except NotTestable as reason:
            return None, str(reason)
        holds = all(fulfilled(numbers) for fulfilled in self.holds)
        text = self.says if holds or not self.otherwise else self.otherwise
        return holds, Sentence().vformat(text, (), numbers)


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
    ours: Test
    """Judges it by our own evidence."""
    theirs: Test | None = None
    """Judges it by the paper's printed numbers; None where it prints none."""
    reading: str = ""
    """How the sentence was made checkable, where its words alone do not say."""
    basis: str = ""
    """What the twin knew of it; see ``Basis``."""
    shortly: str = ""
    """The sentence in a few words, of a result that held-out signals may bear out."""

    def holds(self, evidence: ClaimEvidence) -> bool | None:
        """Tell whether it holds by evidence; None where it cannot be tested."""
        return self.ours(evidence)[0]


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
        """Say on how many twins of which family it holds; empty without any."""
        said = ", ".join(map(str, self.holdings))
        return f"{said}; no other family was run" if len(self.holdings) == 1 else said


VERDICTS: dict[bool | None, Verdict] = {
    True: "reproduced",
    False: "not reproduced",
    None: "not testable",
}
"""Verdict where the paper's own numbers do not refute a claim."""


def judge_claim(claim: Claim, evidence: ClaimEvidence) -> Judgement:
    """Judge one claim by our evidence and by the paper's own numbers."""
    holds, sentence = claim.ours(evidence)
    verdict, holdings = VERDICTS[holds], evidence.holdings.get(claim.id, ())
    if claim.theirs is None:
        return Judgement(claim, verdict, sentence, "not in tables", "", holdings)
    holds, printed = claim.theirs(evidence)
    if holds:
        return Judgement(claim, verdict, sentence, "yes", printed, holdings)
    return Judgement(claim, "refuted by the paper", sentence, "no", printed, holdings)

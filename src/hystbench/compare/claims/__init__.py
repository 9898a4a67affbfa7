"""The ledger: every checkable sentence of the paper, judged."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from hystbench.compare.claims import (
    device,
    equations,
    errors,
    filters,
    identification,
    operators,
    response,
    signals,
)
from hystbench.compare.claims.claim import Claim, Judgement, judge
from hystbench.compare.claims.halves import about_signals, on_signals
from hystbench.compare.evidence import Evidence
from hystbench.files import write_csv

_MODULES = (
    operators,
    equations,
    identification,
    filters,
    signals,
    response,
    errors,
    device,
)

CLAIMS: tuple[Claim, ...] = tuple(
    item
    for module in _MODULES
    for item in vars(module).values()
    if isinstance(item, Claim)
)

COLUMNS = (
    "id",
    "claim",
    "where",
    "kind",
    "basis",
    "reading",
    "verdict",
    "on_held_out",
    "holds_on",
    "evidence",
    "published_bears_out",
    "published_evidence",
)


def judge_all(
    evidence: Evidence, held_out: Iterable[str] = ()
) -> tuple[Judgement, ...]:
    """Judge every claim of the ledger.

    Parameters
    ----------
    evidence : Evidence
    held_out : iterable of str
        Signals that no fit has read. A claim that is judged by them and by others is
        also judged on them alone.
    """
    alone = on_signals(evidence, held_out)
    return tuple(_judge(claim, evidence, alone) for claim in CLAIMS)


def _judge(claim: Claim, evidence: Evidence, alone: Evidence) -> Judgement:
    judged = judge(claim, evidence)
    if claim.basis != "fitted" or not about_signals(claim, alone):
        return judged
    verdict = judge(claim, alone).verdict
    if verdict == "refuted by the paper" != judged.verdict:
        return judged  # not even the paper's own errors show it on so few signals
    return replace(judged, held_out_verdict=verdict)


def write_claims(judgements: Iterable[Judgement], path: str | Path) -> None:
    """Write the ledger as CSV; see ``COLUMNS``."""
    rows = (
        (
            *(j.claim.id, j.claim.claim, j.claim.where, j.claim.kind, j.claim.basis),
            *(j.claim.reading, j.verdict, j.held_out_verdict, j.holds_on, j.evidence),
            *(j.published_bears_out, j.published_evidence),
        )
        for j in judgements
    )
    write_csv(path, COLUMNS, rows)

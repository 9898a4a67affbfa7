"""The ledger: every checkable sentence of the paper, judged."""

from __future__ import annotations

from collections.abc import Iterable
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
    "reading",
    "verdict",
    "holds_on",
    "evidence",
    "published_bears_out",
    "published_evidence",
)


def judge_all(evidence: Evidence) -> tuple[Judgement, ...]:
    """Judge every claim of the ledger."""
    return tuple(judge(claim, evidence) for claim in CLAIMS)


def write_claims(judgements: Iterable[Judgement], path: str | Path) -> None:
    """Write the ledger as CSV; see ``COLUMNS``."""
    rows = (
        (
            *(j.claim.id, j.claim.claim, j.claim.where, j.claim.kind, j.claim.reading),
            *(j.verdict, j.holds_on, j.evidence),
            *(j.published_bears_out, j.published_evidence),
        )
        for j in judgements
    )
    write_csv(path, COLUMNS, rows)

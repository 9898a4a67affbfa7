"""The ledger: every checkable sentence of the paper, judged."""

from __future__ import annotations

import csv
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
from hystbench.files import atomic_path

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
    with (
        atomic_path(path) as temporary,
        temporary.open("w", encoding="utf-8", newline="") as stream,
    ):
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        for j in judgements:
            c = j.claim
            writer.writerow(
                (
                    *(c.id, c.claim, c.where, c.kind, c.reading),
                    *(j.verdict, j.holds_on, j.evidence),
                    *(j.published_bears_out, j.published_evidence),
                )
            )

"""The errors on each twin, and in which experiments each claim of the paper holds."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from hystbench.compare.claims import CLAIMS
from hystbench.compare.claims.claim import Claim
from hystbench.compare.claims.halves import holds
from hystbench.compare.evidence import ClaimEvidence
from hystbench.compare.twins import CLAIM_COLUMNS, ERROR_COLUMNS
from hystbench.files import write_csv
from hystbench.twins.experiments import CONFIGURED
from hystbench.twins.parts import Outcome

WORDS = {True: "yes", False: "no", None: "not testable"}


def results_on_runs(evidence: ClaimEvidence) -> tuple[Claim, ...]:
    """List the claims that are results and that runs, and only runs, can judge."""
    nothing = ClaimEvidence()
    return tuple(
        claim
        for claim in CLAIMS
        if claim.kind == "result"
        and holds(claim, nothing) is None
        and holds(claim, evidence) is not None
    )


def write_twins(outcomes: Iterable[Outcome], errors: Path, claims: Path) -> None:
    """Write the errors on each twin as configured, and the claims in each experiment.

    Parameters
    ----------
    outcomes : iterable of Outcome
        The first is the first twin as configured: it tells which claims are judged.
    errors, claims : Path
        Files to write.
    """
    error_rows: list[list[Any]] = []
    claim_rows: list[list[Any]] = []
    judged: tuple[Claim, ...] = ()
    for each in outcomes:
        about = [each.twin.name, each.twin.family]
        judged = judged or results_on_runs(each.evidence)
        if each.experiment is CONFIGURED:
            for run in each.evidence.runs.values():
                cell = [run.signal, run.model, run.mse, run.re, run.status]
                error_rows.append([*about, *cell])
        for claim in judged:
            word = WORDS[holds(claim, each.evidence)]
            claim_rows.append([*about, each.experiment.seed, claim.id, word])
    write_csv(errors, ERROR_COLUMNS, error_rows)
    write_csv(claims, CLAIM_COLUMNS, claim_rows)

"""The errors on each twin, and in which experiments each claim of the paper holds."""

from collections.abc import Iterable
from pathlib import Path

from hystbench.compare.beside import TwinClaim, TwinError
from hystbench.compare.claims import CLAIMS
from hystbench.compare.claims.claim import Claim
from hystbench.compare.evidence import ClaimEvidence
from hystbench.compare.rows import names_of, or_empty, write_fields
from hystbench.twins.experiments import CONFIGURED
from hystbench.twins.parts import TwinOutcome

WORDS = {True: "yes", False: "no", None: "not testable"}


def results_on_runs(evidence: ClaimEvidence) -> tuple[Claim, ...]:
    """List the claims that are results and that runs, and only runs, can judge."""
    nothing = ClaimEvidence()
    return tuple(
        claim
        for claim in CLAIMS
        if claim.kind == "result"
        and claim.holds(nothing) is None
        and claim.holds(evidence) is not None
    )


def write_twins(outcomes: Iterable[TwinOutcome], errors: Path, claims: Path) -> None:
    """Write the errors on each twin as configured, and the claims in each experiment.

    Parameters
    ----------
    outcomes : iterable of TwinOutcome
        The first is the first twin as configured: it tells which claims are judged.
    errors, claims : Path
        Files to write.
    """
    found: list[TwinError] = []
    held: list[TwinClaim] = []
    judged: tuple[Claim, ...] = ()
    for each in outcomes:
        twin, seed = (each.twin.name, each.twin.family), each.experiment.seed
        judged = judged or results_on_runs(each.evidence)
        if each.experiment is CONFIGURED:
            found += [
                TwinError(
                    *(*twin, run.signal, run.model),
                    *(run.error("mse"), run.error("re"), run.status),
                )
                for run in each.evidence.runs.values()
            ]
        held += [
            TwinClaim(*twin, seed, claim.id, WORDS[claim.holds(each.evidence)])
            for claim in judged
        ]
    write_fields(errors, names_of(TwinError), found, or_empty)
    write_fields(claims, names_of(TwinClaim), held)

"""``hystbench job twins``: errors and claims on several twins."""

from collections.abc import Iterable
from pathlib import Path

from hystbench.compare.beside import TwinClaim, TwinError
from hystbench.compare.claims import CLAIMS
from hystbench.compare.claims.claim import Claim
from hystbench.compare.rows import names_of, or_empty, write_fields
from hystbench.compare.runs import ClaimEvidence
from hystbench.options import In, Json, Out, Settings, command
from hystbench.twins.parts import CONFIGURED, TwinOutcome, join
from hystbench.twins.runs import read_twins

WORDS = {True: "yes", False: "no", None: "not testable"}


@command
def twins(
    twins: tuple[In, ...],
    *,
    fits: Json,
    runs: tuple[Json, ...] = (),
    settings: Settings,
    errors: Out,
    claims: Out,
) -> None:
    """Put what was run on TWINS together: errors, and where claims hold.

    What was run is what twin-fits and twin-runs wrote.
    """
    outcomes = (
        outcome
        for place, twin in enumerate(read_twins(twins))
        for outcome in join(twin, place, settings, [fits, *runs])
    )
    write_twins(outcomes, errors, claims)


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

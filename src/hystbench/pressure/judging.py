"""In which part of an ensemble each claim of the paper holds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from hystbench.compare.claims import CLAIMS
from hystbench.compare.claims.claim import BornOut, Claim
from hystbench.compare.claims.halves import about_signals, holds, on_signals
from hystbench.compare.evidence import Evidence
from hystbench.pressure.runs import Ensemble, Steps


@dataclass(frozen=True)
class Count:
    """In how many members of an ensemble a claim holds.

    Parameters
    ----------
    claim : Claim
    twin, family : str
        Twin on which it was judged.
    held_out_only : bool
        Whether it was judged on the held-out signals alone.
    held, members : int
        A member that cannot be judged, such as one without a peak, does not hold.
    held_finite, finite : int
        The same of the members in which no filter diverged.
    """

    claim: Claim
    twin: str
    family: str
    held_out_only: bool
    held: int
    members: int
    held_finite: int
    finite: int


def pressed_claims(evidence: Evidence) -> tuple[Claim, ...]:
    """List the claims that are results and that runs, and only runs, can judge."""
    nothing = Evidence()
    return tuple(
        claim
        for claim in CLAIMS
        if claim.kind == "result"
        and holds(claim, nothing) is None
        and holds(claim, evidence) is not None
    )


def born_out(claim: Claim) -> BornOut:
    """Tell whether the paper's own numbers bear a claim out."""
    if claim.theirs is None:
        return "not in tables"
    return "yes" if claim.theirs(Evidence()).holds else "no"


def count(
    ensemble: Ensemble,
    claims: Iterable[Claim],
    choices: Sequence[Steps],
    held_out: Iterable[str],
) -> list[Count]:
    """Count for each claim the choices of step sizes with which it holds.

    Parameters
    ----------
    ensemble : Ensemble
        All runs on one twin with one seed.
    claims : iterable of Claim
    choices : sequence of dict
        Factor on the step sizes of each filter.
    held_out : iterable of str
        Signals of the second count. A claim that is about none of them, or that no
        signal of the tables judges, has none.
    """
    members = [ensemble.evidence(steps) for steps in choices]
    unseen = set(held_out)
    restricted = [on_signals(member, unseen) for member in members]
    found = []
    for claim in claims:
        found.append(_count(ensemble, claim, members, False))
        if unseen and about_signals(claim, restricted[0]):
            found.append(_count(ensemble, claim, restricted, True))
    return found


def _count(
    ensemble: Ensemble, claim: Claim, members: Sequence[Evidence], held_out_only: bool
) -> Count:
    # what no step size changes is judged once
    fixed = replace(members[0], order_sweep=(), envelope_errors={})
    fixed = replace(
        fixed, runs={c: r for c, r in fixed.runs.items() if r.model == "rdgpi"}
    )
    once = holds(claim, fixed)
    if once is None:
        held = [holds(claim, member) is True for member in members]
    else:
        held = [once] * len(members)
    finite = [
        not any(run.diverged for run in member.runs.values()) for member in members
    ]
    return Count(
        claim=claim,
        twin=ensemble.twin.name,
        family=ensemble.twin.family,
        held_out_only=held_out_only,
        held=sum(held),
        members=len(members),
        held_finite=sum(h and f for h, f in zip(held, finite, strict=True)),
        finite=sum(finite),
    )


@dataclass(frozen=True)
class Pressed:
    """A claim and the fractions of the ensemble in which it holds.

    Parameters
    ----------
    claim : Claim
    members : int
        Members on twins of the first family.
    on_gpi_twin, on_held_out, on_other_families : float or None
        Fractions on twins of the first family, on these with the held-out signals
        alone, and on twins of other families; None where there is nothing to judge.
    by_family : dict of str to float
        Fraction on each other family.
    finite : int
        Members on twins of the first family in which no filter diverged.
    on_gpi_twin_finite, on_other_families_finite : float or None
        Fraction of these, and of such members on twins of other families.
    """

    claim: Claim
    members: int
    on_gpi_twin: float | None
    on_held_out: float | None
    on_other_families: float | None
    by_family: dict[str, float]
    finite: int
    on_gpi_twin_finite: float | None
    on_other_families_finite: float | None


def press(counts: Sequence[Count], claims: Iterable[Claim]) -> list[Pressed]:
    """Sum the counts of all twins and seeds up by claim; the first names the family."""
    first = counts[0].family if counts else ""
    others = dict.fromkeys(c.family for c in counts if c.family != first)
    pressed = []
    for claim in claims:
        mine = [c for c in counts if c.claim.id == claim.id]
        whole = [c for c in mine if not c.held_out_only]
        same = [c for c in whole if c.family == first]
        apart = {
            family: _fraction([c for c in whole if c.family == family])
            for family in others
        }
        pressed.append(
            Pressed(
                claim=claim,
                members=sum(c.members for c in same),
                on_gpi_twin=_fraction(same),
                on_held_out=_fraction(
                    [c for c in mine if c.held_out_only and c.family == first]
                ),
                on_other_families=_fraction([c for c in whole if c.family != first]),
                by_family={f: part for f, part in apart.items() if part is not None},
                finite=sum(c.finite for c in same),
                on_gpi_twin_finite=_fraction_finite(same),
                on_other_families_finite=_fraction_finite(
                    [c for c in whole if c.family != first]
                ),
            )
        )
    return pressed


def _fraction(counts: Sequence[Count]) -> float | None:
    return _part(sum(c.held for c in counts), sum(c.members for c in counts))


def _fraction_finite(counts: Sequence[Count]) -> float | None:
    return _part(sum(c.held_finite for c in counts), sum(c.finite for c in counts))


def _part(held: int, members: int) -> float | None:
    return held / members if members else None

"""Which cases a contest holds: sets of strata, each with seeds of its own."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hystbench.challenge.contest import table
from hystbench.challenge.plant.effects import IN_ACTUATOR, IN_MACHINE, MACHINES
from hystbench.challenge.spec import (
    CASE_KINDS,
    FAMILIES,
    LEFT_OUT_GROUP,
    CaseSpec,
    draw_spec,
    effects_of,
    group_of,
)
from hystbench.errors import InputError, refuse_unknown

#: The development set, the small one of the pipeline's test and the cases of all other
#: tests.
DEVELOPMENT_SEEDS = range(210_000)
#: Published and transfer sets of earlier scores, whose misses were looked at.
RETIRED_SEEDS = range(1_000_000, 145_000_000)


@dataclass(frozen=True)
class Stratum:
    """Cases that are alike but for what the seed draws."""

    kind: str
    family: str
    ratio_db: float
    cases: int


@dataclass(frozen=True)
class Entry:
    """A case of a contest."""

    name: str
    """Tells nothing of what is hidden: a hash, in whose order the cases stand."""
    spec: CaseSpec


_SETS: dict[str, Any] = table("sets")
SETS = tuple(_SETS)
TRANSFER = tuple(name for name, about in _SETS.items() if about.get("of_group"))
"""Sets of what is left out of all others."""
#: By which cases are left out: effects, families of plants, kinds of cases.
WORDS = tuple(dict.fromkeys([*CASE_KINDS, *FAMILIES, *IN_ACTUATOR, *IN_MACHINE]))


def plan(
    name: str,
    scale: float = 1.0,
    without: Sequence[str] = (),
    only: Sequence[str] = (),
    group: int = LEFT_OUT_GROUP,
) -> tuple[Entry, ...]:
    """List the cases of a set.

    Singles, and effects outside the vocabulary, are balanced over the effects: each is
    hidden as often as any other, or once more. Several effects are drawn.

    Parameters
    ----------
    name : str
        One of :data:`SETS`. Those of :data:`TRANSFER` have forms, a family and unlisted
        effects that no other set holds; that of actuators has ranges shifted by 3 and
        other records too.
    scale : float
        Factor on the number of cases of each stratum; at least one is left.
    without, only : sequence of str
        Effects, families and kinds of cases: those that are left out, and those of
        which a case holds at least one. The cases that stay keep their seeds.
    group : int
        The group that all other sets leave out.

    Returns
    -------
    tuple of Entry
        In the order of their names.

    Raises
    ------
    InputError
        If there is no such set or kind, nothing is left, or the scale asks for more
        seeds than there are.
    """
    for key, asked in (("without", without), ("only", only)):
        for word in asked:
            refuse_unknown(word, WORDS, f"blind: {key}: {word!r}")
    entries = []
    for number, stratum in enumerate(strata(name, group)):
        seeds = _SETS[name]["seeds"]
        first = _SETS[name]["first_seed"] + number * seeds
        cases = max(1, round(stratum.cases * scale))
        if cases > seeds:
            raise InputError(
                f"blind: scale: {scale:g} asks for {cases} cases of one sort; "
                f"expected at most {seeds / stratum.cases:g}"
            )
        for k in range(cases):
            spec = _spec(name, stratum, first + k, number + k, group)
            words = {spec.kind, spec.family, *spec.effects}
            if words.isdisjoint(without) and not (only and words.isdisjoint(only)):
                told = hashlib.sha256(f"{name} {spec.seed}".encode()).hexdigest()
                entries.append(Entry(f"case-{told[:10]}", spec))
    if not entries:
        raise InputError(
            f"blind: without, only: no case of the set {name!r} is left; expected "
            "kinds that leave some"
        )
    return tuple(sorted(entries, key=lambda entry: entry.name))


def strata(name: str, group: int = LEFT_OUT_GROUP) -> tuple[Stratum, ...]:
    """Give the strata of a set, without what it has no effects for.

    The family that is left out stands in the sets of :data:`TRANSFER` alone, where
    ``left-out`` is its name.
    """
    refuse_unknown(name, SETS, f"blind: set: no set {name!r}")
    of_group = name in TRANSFER
    actuator, machine = group_of(group).families
    names = {"left-out": machine if name.startswith("mechanisms") else actuator}
    found = (
        Stratum(row["kind"], names.get(family, family), row["ratio_db"], n)
        for row in _SETS[name]["strata"]
        for family, n in row["cases"].items()
        if family not in (actuator, machine)
    )
    return tuple(
        item
        for item in found
        if item.kind == "none" or effects_of(item.kind, item.family, group, of_group)
    )


def numbers(cases: int, size: int) -> list[str]:
    """Name the jobs into which so many cases are cut."""
    return [f"{start // size:04d}" for start in range(0, cases, size)]


def chunks(entries: tuple[Entry, ...], size: int) -> dict[str, tuple[Entry, ...]]:
    """Cut a set into jobs of so many cases, by number."""
    return {
        name: entries[number * size : (number + 1) * size]
        for number, name in enumerate(numbers(len(entries), size))
    }


def _spec(name: str, stratum: Stratum, seed: int, place: int, group: int) -> CaseSpec:
    of_group = name in TRANSFER
    about: dict[str, Any] = {"group": group, "of_group": of_group}
    if of_group and stratum.family not in MACHINES:
        about |= {"spread": 3.0, "campaign": "other"}
    kind, family, ratio_db = stratum.kind, stratum.family, stratum.ratio_db
    if kind in ("single", "unlisted"):
        known = effects_of(kind, family, group, of_group)
        # a stride that shares no factor with the count: few cases are mixed too
        effect = known[_STRIDE * place % len(known)]
        return CaseSpec(seed, kind, (effect,), family, ratio_db, **about)
    return draw_spec(seed, kind, family, ratio_db, **about)


#: A prime above the number of effects.
_STRIDE = 31

"""What a case is to be: its effects, its family, its noise; drawn from a seed.

Groups of families, forms and kinds of physics are left out in turn; they stand in
``left_out.yaml``. One of them is in no set but those of the score of what was left out,
so that no solver is improved on it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from hystbench.challenge.campaigns import CAMPAIGNS
from hystbench.challenge.plant.effects import (
    APART,
    APART_IN_MACHINE,
    IN_ACTUATOR,
    IN_MACHINE,
    MACHINES,
)
from hystbench.challenge.plant.hysteresis import DRAWS
from hystbench.challenge.plant.kind import EffectKind
from hystbench.errors import InputError, refuse_unknown
from hystbench.yaml_files import load_yaml

CaseKind = Literal["single", "pair", "triple", "none", "unlisted"]
CASE_KINDS: tuple[str, ...] = get_args(CaseKind)
#: How many effects a case of a kind hides.
COUNTS = {"single": 1, "pair": 2, "triple": 3, "none": 0, "unlisted": 1}
ACTUATORS = tuple(DRAWS)
FAMILIES = (*ACTUATORS, *MACHINES)
#: Known to the plant of plays alone: beside another family the base's loop is wrong
#: in any case.
GPI_ONLY = ("hysteresis-shape",)
#: What can be hidden in each family, by name.
EFFECTS_OF: dict[str, dict[str, EffectKind]] = {
    family: {
        name: kind
        for name, kind in IN_ACTUATOR.items()
        if name not in GPI_ONLY or family == "gpi"
    }
    for family in ACTUATORS
} | {
    family: {name: kind for name, kind in IN_MACHINE.items() if family in kind.families}
    for family in MACHINES
}
#: Effects that the vocabulary has no word for.
NAMELESS = {
    name
    for known in EFFECTS_OF.values()
    for name, kind in known.items()
    if not kind.listed
}
#: Of a case, in dB.
RATIO_LIMITS = (-20.0, 60.0)
#: Streams of random numbers: a case draws what is named here from a stream of its own.
PLANT, EFFECTS, COMMANDS, NOISE, BASE = 1, 2, 3, 4, 5


@dataclass(frozen=True)
class LeftOutGroup:
    """What is left out together."""

    families: tuple[str, ...]
    """One of actuators, then one of machines."""
    unlisted: tuple[str, ...]
    """Effects that the vocabulary has no word for."""
    forms: tuple[str, ...]
    """``effect: form`` of effects that it has a word for."""

    def allowed(self, effect: EffectKind, of_group: bool) -> tuple[str, ...]:
        """Give the forms of an effect that a set draws from.

        Parameters
        ----------
        effect : EffectKind
        of_group : bool
            Whether the set is of the group: then its own forms, if there are any.
        """
        own = [form for form in effect.forms if f"{effect.name}: {form}" in self.forms]
        if of_group and own:
            return tuple(own)
        return tuple(form for form in effect.forms if form not in own)


_TABLE: Mapping[str, Any] = load_yaml(Path(__file__).with_name("left_out.yaml"))
GROUPS = {
    number: LeftOutGroup(**{key: tuple(names) for key, names in about.items()})
    for number, about in _TABLE["groups"].items()
}
LEFT_OUT_GROUP: int = _TABLE["left_out"]
"""The group that is left out now."""


def group_of(number: int) -> LeftOutGroup:
    """Give a group.

    Raises
    ------
    InputError
        If there is none of this number.
    """
    if number not in GROUPS:
        raise InputError(f"group: {number}; expected 1 to {len(GROUPS)}")
    return GROUPS[number]


@dataclass(frozen=True)
class CaseSpec:
    """A case to be made; the same spec gives the same bytes.

    Raises
    ------
    InputError
        If a name or number is none that can be.
    """

    seed: int
    """Draws plant, forms, parameters, excitation and noise."""
    kind: str
    effects: tuple[str, ...]
    """Names, in no order."""
    family: str
    """One of :data:`FAMILIES`: the hysteresis of an actuator, or a machine."""
    ratio_db: float
    """20 log10 of rms(output with the effect minus without) over the noise's rms on the
    fit records; of several effects, for the one that shows least. With nothing hidden
    it is not used. Of a machine's effect it is what no linear machine explains that is
    held against the noise."""
    spread: float = 1.0
    """Multiplies the ranges of time constants, frequencies and sizes."""
    campaign: str = "standard"
    """Which laboratory took the records."""
    group: int = LEFT_OUT_GROUP
    """The group of forms that is left out, as ``left_out.yaml`` has it."""
    of_group: bool = False
    """Whether an effect takes the group's own forms instead, where it has any."""

    def __post_init__(self) -> None:
        """Refuse what cannot be made."""
        words = {"kind": CASE_KINDS, "family": FAMILIES, "campaign": CAMPAIGNS}
        for key, known_words in words.items():
            word = getattr(self, key)
            refuse_unknown(word, known_words, f"{key}: {word!r}")
        if self.family in MACHINES and self.campaign != "standard":
            raise InputError(
                f"campaign: {self.campaign!r} of the family {self.family!r}; expected "
                "'standard', as machines have one set of records"
            )
        for name in self.effects:
            if name in GPI_ONLY and self.family in ACTUATORS and self.family != "gpi":
                raise InputError(
                    f"effect: {name!r} beside the family {self.family!r}; expected "
                    "the family 'gpi', as the base's loop is wrong beside any other"
                )
        group_of(self.group)
        known = effects_of(self.kind, self.family)
        for name in self.effects:
            refuse_unknown(
                name, known, f"effect: {name!r} unknown in the family {self.family!r}"
            )
        if len(self.effects) != COUNTS[self.kind]:
            raise InputError(
                f"effect: {len(self.effects)} given, expected {COUNTS[self.kind]} for "
                f"the kind {self.kind!r}"
            )
        if not _may_meet(self.effects, self.family):
            raise InputError(
                f"effect: {' and '.join(self.effects)} cannot be hidden together; "
                "expected effects that differ and can be told apart"
            )
        low, high = RATIO_LIMITS
        if not low <= self.ratio_db <= high:
            raise InputError(
                f"ratio_db: {self.ratio_db:g}; expected {low:g} to {high:g}"
            )
        if not 0.1 <= self.spread <= 10.0:
            raise InputError(f"spread: {self.spread:g}; expected 0.1 to 10")
        if self.seed < 0:
            raise InputError(f"seed: {self.seed}; expected 0 or more")

    def forms(self, effect: EffectKind) -> tuple[str, ...]:
        """Give the forms of an effect that may be drawn."""
        return group_of(self.group).allowed(effect, self.of_group)

    def random(self, stream: int) -> np.random.Generator:
        """Source of random numbers for one purpose; purposes do not disturb others."""
        return np.random.default_rng([self.seed, stream])


def effects_of(
    kind: str, family: str, group: int | None = None, of_group: bool = False
) -> list[str]:
    """Give the names of what a case of a kind may hide in a family.

    Parameters
    ----------
    kind, family : str
    group : int, optional
        Group whose sorts outside the vocabulary are left out; by default none are.
    of_group : bool
        Whether it is those alone instead.
    """
    listed = kind != "unlisted"
    known = EFFECTS_OF[family].items()
    names = [name for name, about in known if about.listed == listed]
    if kind == "unlisted" and group is not None:
        left_out = group_of(group).unlisted
        names = [name for name in names if (name in left_out) == of_group]
    return names


def _may_meet(names: tuple[str, ...], family: str) -> bool:
    """Tell whether effects may be hidden together in a family."""
    pairs = APART_IN_MACHINE if family in MACHINES else APART
    chosen = set(names)
    return len(chosen) == len(names) and not any(pair <= chosen for pair in pairs)


def kind_of(effects: tuple[str, ...]) -> str:
    """Tell the kind of case from the effects' names."""
    if any(name in NAMELESS for name in effects):
        return "unlisted"
    if len(effects) > COUNTS["triple"]:
        raise InputError(f"effect: {len(effects)} given, expected at most 3")
    return ("none", "single", "pair", "triple")[len(effects)]


def draw_spec(
    seed: int,
    kind: str,
    family: str,
    ratio_db: float,
    *,
    spread: float = 1.0,
    campaign: str = "standard",
    group: int = LEFT_OUT_GROUP,
    of_group: bool = False,
) -> CaseSpec:
    """Draw which effects a case hides, each as likely as any other.

    Parameters
    ----------
    seed, kind, family, ratio_db, spread, campaign, group, of_group
        As in :class:`CaseSpec`. The group's sorts outside the vocabulary are left out
        too, or drawn alone.

    Raises
    ------
    InputError
        As :class:`CaseSpec`.
    """
    refuse_unknown(kind, CASE_KINDS, f"kind: {kind!r}")
    refuse_unknown(family, FAMILIES, f"family: {family!r}")
    names = effects_of(kind, family, group, of_group)
    if len(names) < COUNTS[kind]:
        raise InputError(
            f"kind: {kind!r} of the family {family!r}; expected a kind of at most "
            f"{len(names)} effects"
        )
    random = np.random.default_rng([seed, 0])
    while True:
        chosen = random.choice(len(names), size=COUNTS[kind], replace=False)
        effects = tuple(names[int(place)] for place in chosen)
        if _may_meet(effects, family):
            break
    about = (spread, campaign, group, of_group)
    return CaseSpec(seed, kind, effects, family, ratio_db, *about)

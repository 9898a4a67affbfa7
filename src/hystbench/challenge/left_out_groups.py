"""What is left out in turn: a group of families, forms and kinds of physics.

The groups stand in ``kept.yaml``. One of them is in no set but those of the score of
what was left out, so that no solver is improved on it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hystbench.challenge.plant.kind import EffectKind
from hystbench.errors import InputError
from hystbench.yaml_files import load_yaml


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


_TABLE: Mapping[str, Any] = load_yaml(Path(__file__).with_name("kept.yaml"))
GROUPS = {
    number: LeftOutGroup(**{key: tuple(names) for key, names in about.items()})
    for number, about in _TABLE["groups"].items()
}
LEFT_OUT_GROUP: int = _TABLE["kept"]
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

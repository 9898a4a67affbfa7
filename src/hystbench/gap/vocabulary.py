"""Which effects a search may name, what they are called in words, and their causes.

A name in gap.json, in a model file and behind ``--without`` is that of a block. Where
that is the name of one cause among several, sentences call it by what it does.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from hystbench.device_kinds import BEHAVIOURS, DeviceKind, behaviour_of
from hystbench.errors import InputError, nearest
from hystbench.gap.progress import Say
from hystbench.quantities import Quantities
from hystbench.sentences import either, listed

if TYPE_CHECKING:
    from hystbench.gap.effects.effect import Effect


@dataclass(frozen=True)
class Vocabulary:
    """What a user accepts and rejects before a search.

    Raises
    ------
    InputError
        If a name is no effect, stands there twice, or in both.
    """

    without: tuple[str, ...] = ()
    """Effects that the search must not name."""
    put_in: tuple[str, ...] = ()
    """Effects that are in the model from the start. They are fitted, and found by
    nobody: what they close of the gap is told apart from what is found."""
    kind: DeviceKind | None = None
    """Kind of the device; what it cannot have is not named, unless it is put in."""

    def __post_init__(self) -> None:
        """Refuse names that mean nothing."""
        for option, names in (("--without", self.without), ("--with", self.put_in)):
            for name in names:
                if name not in _effects():
                    raise InputError(
                        f"{option}: no effect {name!r}; {nearest(name, _effects())}"
                    )
                if names.count(name) > 1:
                    raise InputError(f"{option}: {name!r} twice; expected it once")
        for name in self.without:
            if name in self.put_in:
                raise InputError(
                    f"--with and --without: {name!r} in both; expected it in one"
                )

    @classmethod
    def of(cls, without: Iterable[str] = (), put_in: Iterable[str] = ()) -> Vocabulary:
        """Take names in any sequence."""
        return cls(tuple(without), tuple(put_in))

    def in_device(self, kind: DeviceKind | None) -> Vocabulary:
        """Leave out what a kind of device cannot have."""
        return replace(self, kind=kind)

    @property
    def impossible(self) -> tuple[str, ...]:
        """Effects that the kind of device leaves out, which nobody named."""
        if self.kind is None:
            return ()
        return tuple(
            name
            for name, effect in _effects().items()
            if name not in {*self.without, *self.put_in}
            and not effect.possible_in(self.kind)
        )

    @property
    def offered(self) -> tuple[str, ...]:
        """Effects that the search may name, in their order."""
        barred = {*self.without, *self.put_in, *self.impossible}
        return tuple(name for name in _effects() if name not in barred)

    def words(self) -> list[str]:
        """Say what the user asked for and the device leaves out, a sentence each."""
        said = []

        def all_of(names: tuple[str, ...], one: str, many: str) -> str:
            return f"{listed(names)}: {one if len(names) == 1 else many}"

        untried = "it was not tried", "they were not tried"
        if self.put_in:
            named = all_of(self.put_in, "it is not a finding", "they are not findings")
            said.append(f"you put in {named}")
        if self.without:
            said.append(f"you left out {all_of(self.without, *untried)}")
        from hystbench.gap.effects.effect import StoreEffect  # late: as below

        # Nobody looks for a level in what is no store.
        impossible = tuple(
            x for x in self.impossible if not isinstance(_effects()[x], StoreEffect)
        )
        if impossible:
            said.append(
                f"the device is {self.kind}, as dataset.yaml says, and cannot have "
                f"{all_of(impossible, *untried)}"
            )
        return said

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``asked``."""
        return {
            "without": list(self.without),
            "with": list(self.put_in),
            "impossible": list(self.impossible),
            "sentence": "; ".join(self.words()),
        }


def _effects() -> Mapping[str, Effect]:
    from hystbench.gap.effects import effects  # late: it imports them all

    return effects()


EVERYTHING = Vocabulary()
"""All effects may be named, and none is put in."""


_NAMED_BY_A_CAUSE = re.compile(rf"(?<![\w-])({'|'.join(BEHAVIOURS)})(?![\w-])")
#: Keys of gap.json that hold sentences.
_SENTENCES = ("reason", "sentence", "why")
#: Parts of gap.json that hold names of the user's.
_OF_THE_USER = (
    *("dataset", "model", "command", "simulator", "warnings", "records"),
    *("record_values", "runs_away", "black_box", "base_parameters"),
)


def in_words(text: str) -> str:
    """Call effects by what they do, in a sentence or where one name stands."""
    return _NAMED_BY_A_CAUSE.sub(lambda found: behaviour_of(found[1]), text)


def called_in(effect: str, kind: DeviceKind | None) -> str:
    """Call an effect by what it does, and by its causes where a kind tells them apart.

    A ceramic has no eddy currents: in a piezoelectric device it is a "diffusion-like
    lag (relaxation of polarization, or the charge amplifier)".
    """
    causes = _effects()[effect].causes_in(kind)
    if not causes or len(causes) == len(_effects()[effect].causes_in(None)):
        return behaviour_of(effect)
    return f"{behaviour_of(effect)} ({either(causes)})"


def say_in_words(say: Say) -> Say:
    """Tell a line of progress in words."""
    return lambda line: say(in_words(line))


def for_readers(content: Mapping[str, Any]) -> dict[str, Any]:
    """Give what gap.json holds as the page shows it: every name in words."""
    return {
        key: value if key in _OF_THE_USER else _worded(value, every=True)
        for key, value in content.items()
    }


def with_device(
    content: Mapping[str, Any], kind: DeviceKind | None, quantities: Quantities
) -> dict[str, Any]:
    """Tell what the device is, and what causes the effects in it.

    Parameters
    ----------
    content : mapping
        What gap.json holds.
    kind : str, optional
        Kind of the device, where it is known.
    quantities : Quantities

    Returns
    -------
    dict
        With ``device``, with ``behaviour`` and ``causes`` of each effect, and with
        sentences that call effects by what they do.
    """
    told: dict[str, Any] = _worded(content, every=False)
    told.pop("device", None)  # told where the fit records decided: it goes last
    told["effects"] = _with_causes(told["effects"], kind)
    for part in ("withdrawn", "built_in"):
        if told.get(part):
            own = _with_causes(told[part]["effects"], kind)
            told[part] = told[part] | {"effects": own}
    told["device"] = {
        "kind": kind,
        "input": quantities.input,
        "output": quantities.output,
        "causality": quantities.causality,
    }
    return told


def _with_causes(named: list[dict[str, Any]], kind: DeviceKind | None) -> list[Any]:
    return [
        item
        | {
            "behaviour": behaviour_of(item["name"]),
            "causes": list(_effects()[item["name"]].causes_in(kind)),
        }
        for item in named
    ]


def _worded(value: Any, every: bool, key: str = "") -> Any:
    """Word texts at any depth: every one, or sentences alone; keys stay."""
    if isinstance(value, Mapping):
        return {name: _worded(item, every, name) for name, item in value.items()}
    if isinstance(value, list):
        return [_worded(item, every, key) for item in value]
    if isinstance(value, str) and (every or key in _SENTENCES):
        return in_words(value)
    return value

"""The parts of a model's block diagram: its blocks, each in its place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.base import Block
from hystbench.blocks.force import Force
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.parameter import HUGE
from hystbench.blocks.sensor_noise import SensorNoise
from hystbench.blocks.simulator import Simulator
from hystbench.blocks.store import Store
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.device_kinds import behaviour_of
from hystbench.errors import InputError, nearest
from hystbench.figures.style import unit_text
from hystbench.gap.effects import effects
from hystbench.model import Model

Whose = Literal["simulator", "added", "put in"]

#: Numbers of an effect that its box has.
NUMBERS_IN_BOX = 2
_Number = tuple[object, str]
"""A value, and its unit."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Part:
    """What stands in one box, and who put it there."""

    words: str
    """Name of the block, or of the effect that it stands for."""
    numbers: tuple[str, ...] = ()
    """The first numbers of an effect, with units."""
    whose: Whose = "simulator"
    """Whose part it is: the simulator's as it was given, added by the search, or put in
    by the user."""


@dataclass(frozen=True)
class Stage:
    """A block that the signal passes, with what is attached to it."""

    core: Part
    within: tuple[Part, ...] = ()
    """Effects that are numbers of the block itself."""
    around: tuple[Part, ...] = ()
    """What changes the block, from the inside out."""
    fed_back: tuple[Part, ...] = ()
    """Forces that act against its motion."""
    beside: tuple[Stage, ...] = ()
    """What has the same input, and is added to its output."""
    spilt: Part | None = None
    """What leaves it where it is full."""
    caught: bool = False
    """Whether a part of what is spilt goes on with its output."""

    @property
    def parts(self) -> tuple[Part, ...]:
        """All of them."""
        spilt = (self.spilt,) if self.spilt else ()
        attached = (*self.within, *self.around, *self.fed_back)
        beside = (part for stage in self.beside for part in stage.parts)
        return (self.core, *attached, *beside, *spilt)


@dataclass(frozen=True)
class _Owner:
    """An effect that a block of the chain stands for, with its numbers there."""

    effect: str
    whose: Whose
    numbers: Mapping[str, _Number]
    """Value and unit of each, by parameter."""

    @property
    def of_block(self) -> bool:
        """Whether they are numbers of a block that is not the effect's own."""
        return bool(effects()[self.effect].numbers)

    @property
    def part(self) -> Part:
        """Its name and first numbers; those that are zero say nothing."""
        told = [
            number_words(name, value, unit)
            for name, (value, unit) in self.numbers.items()
            if isinstance(value, float | int) and value != 0
        ]
        return Part(behaviour_of(self.effect), tuple(told[:NUMBERS_IN_BOX]), self.whose)


def stages(model: Model, gap: Mapping[str, Any]) -> tuple[Stage, ...]:
    """Give what the signal passes from input to output, noise left out.

    The class of a block decides its place: what is attached to the block before it is
    drawn around it, as feedback or beside it; every other block stands behind the last
    one. A new block needs no entry here.

    Parameters
    ----------
    model : Model
        With its effects.
    gap : mapping
        What gap.json holds: its ``effects`` and ``built_in`` tell which blocks were
        added.

    Returns
    -------
    tuple of Stage
    """
    owners = _owners(model, gap)
    found: list[Stage] = []
    host: Block | None = None
    for k, block in enumerate(model.chain):
        own = owners.get(k, [])
        part = next((x.part for x in own if not x.of_block), Part(_name(block)))
        if isinstance(block, SensorNoise):
            continue
        if isinstance(block, AttachedBlock):
            found[-1] = _attached(found[-1], block, host, part)
            continue
        host = block
        found.append(_stage(block, part, [x for x in own if x.of_block]))
    return tuple(found)


def in_one_line(model: Model, found: Sequence[Stage]) -> str:
    """Tell the diagram in words, for those who do not see it."""
    return ", then ".join([model.input.name, *map(_told, found), model.output.name])


def number_words(name: str, value: float, unit: str) -> str:
    """Write a number of an effect: ``time_constant_s`` as ``time constant 0.025 s``.

    No line breaks between the number and its unit.
    """
    label = name.removesuffix(f"_{unit.lower()}").replace("_", " ")
    shown = f"{value:.3g}".replace("e+", "e")
    if "e" in shown:
        digits, power = shown.split("e")
        shown = f"{digits}·10{str(int(power)).translate(_RAISED)}"
    shown = shown.replace("-", "−")  # noqa: RUF001  (a minus sign, not a hyphen)
    if unit not in ("", "-", "1"):
        shown += f"\u00a0{unit_text(unit)}"
    return f"{label} {shown}"


def _name(block: Block) -> str:
    if isinstance(block, Simulator):
        return block.label
    return block.name.replace("-", " ")


def _stage(block: Block, part: Part, own: Sequence[_Owner]) -> Stage:
    """Start a stage with a block; some of its numbers may be effects."""
    if not isinstance(block, Store):
        return Stage(part, within=tuple(x.part for x in own))
    spills = [x.part for x in own if "height" in x.numbers]
    if block.height < HUGE and not spills:
        spills = [Part("overflow")]
    return Stage(
        part,
        within=tuple(x.part for x in own if "height" not in x.numbers),
        spilt=next(iter(spills), None),
        caught=block.output == "outflow" and block.caught > 0,
    )


def _attached(stage: Stage, block: Block, host: Block | None, part: Part) -> Stage:
    """Attach a block where its class says.

    The force of an impedance is a part of its output; in a mechanism it acts against
    the motion that it depends on, of the last mechanism beside if there is one.
    """
    if isinstance(block, WrappingBlock):
        return replace(stage, around=(*stage.around, part))
    if isinstance(block, Force) and not isinstance(host, Impedance):
        if not stage.beside:
            return replace(stage, fed_back=(*stage.fed_back, part))
        *others, last = stage.beside
        last = replace(last, fed_back=(*last.fed_back, part))
        return replace(stage, beside=(*others, last))
    return replace(stage, beside=(*stage.beside, Stage(part)))


def _told(stage: Stage) -> str:
    def words(parts: Sequence[Part]) -> list[str]:
        return [part.words for part in parts]

    places = (
        ("in it", words(stage.within)),
        ("around it", words(stage.around)),
        ("fed back", words(stage.fed_back)),
        ("beside it", [_told(one) for one in stage.beside]),
        ("above it", [stage.spilt.words] if stage.spilt else []),
    )
    told = [f"{' and '.join(each)} {place}" for place, each in places if each]
    return stage.core.words + (f" with {' and '.join(told)}" if told else "")


def _owners(model: Model, gap: Mapping[str, Any]) -> dict[int, list[_Owner]]:
    """Find the effects that each block of the chain stands for.

    What the user put in was fitted again since its numbers were told: blocks that have
    its name and that the search did not add are its own, with their numbers of today.
    """
    found: dict[int, list[_Owner]] = {}
    places = {label: k for k, (label, _) in enumerate(model.labelled())}
    for item in gap["effects"]:
        for label in item.get("blocks", ()):
            if label not in places:
                raise InputError(
                    f"gap.json: {item['name']}: no block {label!r} in model.yaml; "
                    f"{nearest(label, places)}"
                )
            k = places[label]
            own = _Owner(item["name"], "added", _told_of(item, model.chain[k]))
            found.setdefault(k, []).append(own)
    for item in (gap.get("built_in") or {"effects": []})["effects"]:
        names = {item["name"], *effects()[item["name"]].laws}
        for k, block in enumerate(model.chain):
            if block.name in names and all(x.of_block for x in found.get(k, [])):
                own = _Owner(item["name"], "put in", _now_of(item, block))
                found.setdefault(k, []).append(own)
    return found


def _told_of(item: Mapping[str, Any], block: Block) -> dict[str, _Number]:
    """Give the numbers of an effect that are some number of a block."""
    known = block.parameters()
    own = [known[name].plain(getattr(block, name)) for name in known]
    return {
        key.partition("#")[0]: (about["value"], about["unit"])
        for key, about in item["parameters"].items()
        if about["value"] in own
    }


def _now_of(item: Mapping[str, Any], block: Block) -> dict[str, _Number]:
    """Give the numbers of an effect as a block has them today."""
    known = block.parameters()
    return {
        name: (known[name].plain(getattr(block, name)), about["unit"])
        for name, about in item["parameters"].items()
        if name in known
    }

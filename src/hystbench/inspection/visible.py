"""Which effects records can reveal: how strong each must be to be seen, and told.

Each effect is simulated on the records' own inputs. What the base could do as well (its
offset, its gain, another shape of its hysteresis) is taken off what it adds; the rest
has to stand out of the noise as far as the search for names asks. What is left then of
it beside a rival's best fit has to do so too, before one can be told from the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from hystbench.blocks import block_class
from hystbench.gap.fitting.on_records import free_numbers
from hystbench.gap.fitting.score import record_weight
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.reshape import orthonormal, products, reshapings
from hystbench.gap.thresholds import PARAMETER, PAYS
from hystbench.inspection.shapes import Shape, shapes_of
from hystbench.model import Model
from hystbench.record import FloatArray, Hold, Record
from hystbench.sentences import either

REVEALED = 0.1
"""Share of the output's rms: an effect that must be larger to be seen is not
revealed."""
ROUNDING_SHARE = 1e-9
"""Share of the power of what an effect does that is rounding."""
ABSORBED_SHARE = 0.99
"""Share of what an effect does that the base could do, worth telling."""


@dataclass(frozen=True)
class SmallestSeen:
    """How strong an effect must be on these records."""

    effect: str
    seen_from: float = np.inf
    """The rms that it must add for the search to pay for it, as a share of the output's
    rms about its mean; infinite where nothing it does stands out."""
    value: float = np.nan
    """The number that says how strong it then is; NaN where none does."""
    number: str = ""
    unit: str = ""
    """Name and unit of that number in the block, U and Y for those of the signals."""
    form: str = ""
    """Form in which it is seen first, with the other numbers of that."""
    rivals: tuple[tuple[str, float], ...] = ()
    """What it can be mistaken for, with the share from which on it can be told;
    infinite where never. The nearest first."""
    why: str = ""
    """Why it is not revealed; empty where it is."""
    judged: bool = True
    """Whether it was simulated here. A force inside the dynamics is not."""

    @property
    def revealed(self) -> bool:
        """Whether it shows before it is a tenth of the output."""
        return self.seen_from <= REVEALED

    @property
    def told_from(self) -> float:
        """Share of the output from which on it can be told from every rival."""
        return max((share for _, share in self.rivals), default=self.seen_from)


def seen_effects(
    base: Model, records: Sequence[Record], floor: float, hold: Hold
) -> tuple[SmallestSeen, ...]:
    """Find how strong each effect must be to be seen and told on records.

    Parameters
    ----------
    base : Model
        Beside which effects are simulated.
    records : sequence of Record
        Those that are fitted.
    floor : float
        RMS of the noise, in the output's unit, above zero.
    hold : {"zero-order", "linear", "band-limited"}

    Returns
    -------
    tuple of SmallestSeen
        All effects of the vocabulary, by what it takes to see them.

    Raises
    ------
    InputError
        If the base does not run on the records.
    """
    sample = ScoredSamples.of(records)
    base = base.with_hold(hold)
    free = free_numbers(base)
    state = ModelState(base.chain, tuple(records), sample, free=free, hold=hold)
    shapes, declined = shapes_of(state)
    own = _own(state)
    own_loop: list[Shape] = []
    if "hysteresis" in declined and (own_loop := _hysteresis(state)):
        shapes += own_loop
        del declined["hysteresis"]
    outputs = [record.y[record.counted] for record in records]
    reach = float(np.sqrt(np.mean([np.var(y) for y in outputs])))
    judge = _Judge(state, own, floor, reach)
    measured = [judge.measured(shape, shape in own_loop) for shape in shapes]
    found = []
    for name in dict.fromkeys(shape.effect for shape in shapes):
        mine = [item for item in measured if item.shape.effect == name]
        rest = [item for item in measured if item.shape.effect != name]
        found.append(judge.seen(mine, rest))
    for name, why in declined.items():
        found.append(SmallestSeen(name, why=why, judged=False))
    return tuple(sorted(found, key=lambda item: (item.seen_from, item.effect)))


def could_do(has_loop: bool, is_free: bool) -> str:
    """Say what of a base may be another: what it could do as well is taken off."""
    words = ["gain", "offset"]
    words += ["shape of the hysteresis"] * has_loop + ["free number"] * is_free
    return either(words)


def _own(state: ModelState) -> FloatArray:
    """Give an orthonormal basis of what the base could do as well."""
    simulation, sample = state.simulation, state.sample
    one = np.ones((len(sample), 1))
    output = sample.take(simulation.output)[:, None]
    return orthonormal(
        np.hstack(
            [
                one,
                output,
                reshapings(simulation, sample),
                products(simulation, sample),
                state.tangents,
            ]
        )
    )


def _hysteresis(state: ModelState) -> list[Shape]:
    """Give the hysteresis of the base itself, as what stands beside a gain alone."""
    simulation, sample = state.simulation, state.sample
    place = simulation.hysteresis
    if place is None:
        return []
    block = simulation.chain[place]
    gain = block_class("gain").from_mapping({"value": 1.0})
    straight = simulation.run(
        (gain, *simulation.chain[place + 1 :]), simulation.at(place)
    )
    plain = sample.take(straight)
    line = np.column_stack([np.ones(len(sample)), plain])
    loop = sample.take(simulation.output)
    loop = loop - line @ np.linalg.lstsq(line, loop, rcond=None)[0]
    if not loop.any():
        return []
    return [Shape("hysteresis", "", {}, "", block, loop[:, None], 1.0, 8.0)]


@dataclass(frozen=True)
class _Measured:
    """A shape, what is left of it beside the base, and how large it is.

    ``size`` is the rms of what it adds, ``needed`` the size at which it would stand
    out, both as shares of the output's rms.
    """

    shape: Shape
    left: FloatArray
    basis: FloatArray
    size: float
    needed: float
    absorbed: float


class _Found(NamedTuple):
    """Where an effect stands out: its size and number there, and a shape near it."""

    share: float
    value: float
    item: _Measured


class _Judge:
    """What it takes for a shape to stand out, on some records over some noise."""

    def __init__(
        self, state: ModelState, own: FloatArray, floor: float, reach: float
    ) -> None:
        self.state, self.own, self.floor, self.reach = state, own, floor, reach
        self.slices = state.sample.slices
        self.weight = record_weight(len(self.slices))

    def measured(self, shape: Shape, of_base: bool) -> _Measured:
        """Take off what the base could do, and see how much of the rest it takes.

        The hysteresis of the base itself stays: it stands beside a line already.
        """
        columns = shape.columns
        left = columns
        if not of_base:
            left = columns - self.own @ (self.own.T @ columns)
        total, rest = float(np.sum(columns**2)), float(np.sum(left**2))
        if rest < ROUNDING_SHARE * total:
            left, rest = np.zeros_like(left), 0.0
        size = float(np.sqrt(total / len(columns))) / self.reach
        needed = size * self._factor(left, shape.charge)
        basis = orthonormal(left[:, np.any(left != 0, axis=0)])
        return _Measured(
            shape, left, basis, size, needed, 1 - rest / max(total, 1e-300)
        )

    def _factor(self, left: FloatArray, charge: float) -> float:
        """Give the factor on a shape at which the search for names pays for it."""
        powers = np.array(
            [float(np.sum(left[part] ** 2)) / len(left[part]) for part in self.slices]
        )
        powers = powers / self.floor**2
        asked = PAYS + PARAMETER * charge
        if not powers.max() > 0:
            return float("inf")

        def lacks(logarithm: float) -> float:
            gain = self.weight * np.sum(np.log1p(np.exp(2 * logarithm) * powers))
            return float(gain) - asked

        start = -0.5 * np.log(powers.max())
        return float(np.exp(brentq(lacks, start - 30, start + 30)))

    def seen(
        self, mine: Sequence[_Measured], rest: Sequence[_Measured]
    ) -> SmallestSeen:
        """Give what it takes to see an effect, in the form in which it shows first."""
        nowhere = _Found(np.inf, np.nan, min(mine, key=lambda each: each.needed))
        found = [nowhere, *_scaled(mine), *_graded(mine)]
        share, value, item = min(found, key=lambda each: each.share)
        return SmallestSeen(
            item.shape.effect,
            share,
            value,
            *_number(item.shape),
            _words(item.shape),
            self._rivals(item, share, rest) if np.isfinite(share) else (),
            self._why(item, share),
        )

    def _rivals(
        self, first: _Measured, share: float, rest: Sequence[_Measured]
    ) -> tuple[tuple[str, float], ...]:
        """Give the shares from which on an effect is told from each other one."""
        powers = np.sum(first.left**2, axis=0)
        power, column = float(powers.max()), int(np.argmax(powers))
        left = first.left[:, column : column + 1]
        told: dict[str, float] = {}
        for other in rest:
            basis = other.basis
            if not basis.shape[1]:
                continue
            stays = float(np.sum((left - basis @ (basis.T @ left)) ** 2)) / power
            name = other.shape.effect
            told[name] = min(told.get(name, np.inf), max(stays, 0.0))
        found = {
            name: share / np.sqrt(stays) if stays > 1e-12 else float("inf")
            for name, stays in told.items()
        }
        near = {name: value for name, value in found.items() if value > 2 * share}
        ordered = sorted(near.items(), key=lambda item: -item[1])
        return tuple((name, float(value)) for name, value in ordered)

    def _why(self, item: _Measured, share: float) -> str:
        if share <= REVEALED:
            return ""
        if item.absorbed > ABSORBED_SHARE:
            could = could_do(
                self.state.simulation.loop is not None, bool(self.state.free)
            )
            return (
                f"{100 * item.absorbed:.4g} % of what it does is what another {could} "
                "does too"
            )
        noise = f"the noise ({100 * self.floor / self.reach:.2g} % of the output)"
        if not np.isfinite(share):
            return f"nowhere in the range that these inputs allow is it above {noise}"
        return (
            f"it stands out of {noise} only from {100 * share:.2g} % of the output on"
        )


def _scaled(mine: Sequence[_Measured]) -> list[_Found]:
    """Give where shapes stand out that are proportional to a number."""
    return [
        _Found(item.needed, item.shape.unit * item.needed / item.size, item)
        for item in mine
        if (item.shape.scaled or item.shape.block is None)
        and np.isfinite(item.needed)
        and item.size > 0
    ]


def _graded(mine: Sequence[_Measured]) -> list[_Found]:
    """Give where shapes stand out of which another number says how strong they are.

    Between two points of its range the logarithms are taken to go straight.
    """
    rows: dict[tuple[str, ...], list[_Measured]] = {}
    for item in mine:
        shape = item.shape
        if not shape.scaled and shape.block is not None and item.size > 0:
            others = [f"{k}={v}" for k, v in list(shape.values.items())[1:]]
            rows.setdefault((shape.form, *others), []).append(item)
    found = []
    for row in rows.values():
        row.sort(key=lambda item: item.size)
        stands = [item.needed <= item.size for item in row]
        if not any(stands):
            continue
        k = stands.index(True)
        item = row[k]
        value = next(iter(item.shape.values.values()), float("nan"))
        share = item.needed
        value *= item.needed / item.size if not k else 1.0
        if k and np.isfinite(row[k - 1].needed):
            before = row[k - 1]
            low = np.log(before.size / before.needed)
            high = np.log(item.size / item.needed)
            part = float(-low / (high - low)) if high > low else 1.0
            share = float(before.size ** (1 - part) * item.size**part)
            old = next(iter(before.shape.values.values()), value)
            if value * old > 0:
                value = float(
                    np.sign(value) * abs(old) ** (1 - part) * abs(value) ** part
                )
        found.append(_Found(share, value, item))
    return found


def _number(shape: Shape) -> tuple[str, str]:
    """Give the name and unit of the number that says how strong a shape is."""
    name = shape.scaled or next(iter(shape.values), "")
    if shape.block is None or not name:
        return "", ""
    about = shape.block.parameters()
    plain = name.rpartition(" ")[0] + "s" if name[-1].isdigit() else name
    known = name if name in about else plain
    if known not in about:  # a bias is the offset of a gain
        return name, ""
    return name, about[known].unit


def _words(shape: Shape) -> str:
    """Give the form of a shape with the numbers that it has there."""
    parts = [shape.form] if shape.form else []
    if shape.scaled:
        parts += [f"{name} {value:.3g}" for name, value in shape.values.items()]
    return ", ".join(parts)

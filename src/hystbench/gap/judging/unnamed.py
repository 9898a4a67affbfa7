"""What stays unnamed: structure in the residual that the named effects cannot own.

A name is right when what it leaves is noise, a slightly wrong shape of the base's
hysteresis, or what other numbers of the same effect would take away. Anything else that
follows known signals speaks against it, however small beside the gap.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from hystbench.gap.effects.sensor import FORMS, WINDING, degree
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.judging.drifts import beside_a_drift
from hystbench.gap.judging.grouped_evidence import ColumnProducts
from hystbench.gap.judging.known_signals import (
    PATH,
    SLOW_POWER,
    generic_groups,
    halves,
    paths,
)
from hystbench.gap.locate.forms import f_test
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.reshape import orthonormal, products
from hystbench.gap.thresholds import (
    BY_CHANCE,
    LOOSE,
    MOST,
    UNNAMED_SHARE,
    WORTH_A_WORD,
)
from hystbench.record import FloatArray, Record

SURROGATES = round(1 / BY_CHANCE) - 1
"""What follows nothing explains more than all of them by chance alone."""

STRETCHES = 10
"""Stretches of a record. Their means tell how much the mean of the whole may differ by
chance. They are as few as a variance needs, so that each is as long as it may be."""

SORTS = {
    "strength": "its strength changes with time or between records, perhaps with level",
    "history": "it depends on how hard the device was driven before",
    "memory": "it has memory or delay of another kind",
    "curve": "it is a curve or a loop of another kind",
    "unrelated": "it does not follow the recorded input in any way that was tried",
}
"""What is said of each sort of structure."""
SORT_OF = {
    "strength": "strength",
    "gain": "strength",
    "path": "strength",
    SLOW_POWER: "history",
    "dynamics": "memory",
    "rate": "memory",
    "statics": "curve",
    "memory": "curve",
}
"""Sort of a residual that a group of columns explains best."""


@dataclass(frozen=True)
class Unnamed:
    """What stays unnamed, as shares of the power of the gap above the floor."""

    structured: float
    """What follows known signals and the named effects cannot own."""
    allowed: float = UNNAMED_SHARE
    """Share of it that may stay."""
    changing: float | None = None
    """What goes if the effects' strength and numbers may differ between the halves of
    each recording, a record or all windows cut from one; None where no effect acts
    on the input. It is told and decides nothing: what changes in time is structure
    too."""
    unrelated: float = 0.0
    """What follows no known signal."""
    gains: Mapping[str, float] = field(default_factory=dict)
    """How far each group of known signals, alone, raises the evidence, in natural
    logarithms; empty where so little stays that no sort is said."""
    factors: tuple[float, ...] = ()
    """The effects' strength in each record, as a multiple of what it is in all of them;
    empty where no effect acts on the input."""
    by_chance: float = 0.0
    """What seems to follow known signals, but does so no more than when it is moved in
    time against them; it counts as unrelated."""

    @property
    def stays(self) -> float:
        """Share of the gap that the names leave beyond what they may own."""
        return self.structured + self.unrelated

    @property
    def too_much(self) -> bool:
        """Whether more follows known signals, without being owned, than is allowed."""
        return self.structured > self.allowed

    @property
    def told(self) -> bool:
        """Whether so much stays that its sort is said."""
        return self.too_much or self.stays > LOOSE

    @property
    def follows_nothing(self) -> bool:
        """Whether much stays, and no more of it than may follows known signals."""
        return self.stays > LOOSE and not self.too_much

    def trust(self, of_base: bool = False) -> float:
        """Give the factor on a name's confidence: one where no more stays than may.

        Else it is the allowed over the actual share. Where the base may have left that
        as well, it is the square root of that share, halfway to one on a logarithmic
        scale.
        """
        factor = self.allowed / self.structured if self.too_much else 1.0
        return math.sqrt(factor) if of_base else factor

    @property
    def sort(self) -> str:
        """Sort of what stays: a key of :data:`SORTS`."""
        best = max(self.gains, key=lambda name: self.gains[name], default=None)
        lone = self.structured < WORTH_A_WORD * self.stays
        if best is None or self.gains[best] <= 0 or lone:
            return "unrelated"
        return SORT_OF[best]

    @property
    def reason(self) -> str:
        """Why no name stands."""
        return (
            f"{100 * self.structured:.2g} % of the gap's power follows known signals, "
            "and no parameter values of the named effects explain it: "
            f"{SORTS[self.sort]}"
        )

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds: no sort where no more stays than may."""
        sort = self.sort if self.told else None
        return {
            "allowed": self.allowed,
            "structured": self.structured,
            "changing": self.changing,
            "by_chance": self.by_chance,
            "unrelated": self.unrelated,
            "sort": sort,
            "sentence": SORTS[sort] if sort else None,
            "factors": list(self.factors),
        }


def what_is_unnamed(
    base: ModelState,
    state: ModelState,
    floor: Floor,
    share: float = UNNAMED_SHARE,
) -> Unnamed:
    """Measure what the effects of a model cannot own of what they leave.

    Three variances of noise are found by evidence (:mod:`grouped_evidence`): ``s0``
    with the columns that the names may own, ``s1`` with all known signals as well, and
    ``s2`` with changes of the effects in time instead. With ``P`` the power of the gap
    the shares are ``(s0 - s1) / P``, ``(s0 - s2) / P`` and, of what is left above the
    floor, ``(s1 - floor) / P``.

    Parameters
    ----------
    base, state : ModelState
        Without and with the effects.
    floor : Floor
        RMS of the noise. A gap of less power than the noise counts as one of as much.
    share : float
        What may stay: of what sort it is, is looked for where more does.
    """
    square = floor.square
    power = base.gap(square)
    own, generic = owned(state), generic_groups(base, state)
    changing: dict[str, FloatArray] = {}
    slow_power: dict[str, FloatArray] = {}
    increment = base.residual - state.residual
    if any(item.blocks for item in state.added):
        changing = {"changing": halves(state, _numbers(state, increment))}
    drifts = any(beside.effect == PATH for beside, _ in state.beside)
    if drifts or any(record.decay_s is not None for record in state.records):
        # A path owns all that is slow, the input's slow power too, as far as the most
        # winding form of a drift may go in a record. A free mass makes a path in each
        # of its windows of any small error of a force.
        path = generic.pop("path")
        own["path"] = paths(state, allowed=winding) if drifts else path
        slow_power[SLOW_POWER] = generic.pop(SLOW_POWER)
    groups = own | generic | changing | slow_power
    table = ColumnProducts.of(groups, state.residual)
    alone, with_generic, with_changing = (
        table.explained([*own, *more]) for more in ((), generic, changing)
    )
    structured = max(alone.noise - with_generic.noise, 0.0) / power
    if drifts:
        structured, generic = beside_a_drift(
            state, own, generic, slow_power, structured, share, power
        )
    found = Unnamed(
        structured,
        share,
        max(alone.noise - with_changing.noise, 0.0) / power if changing else None,
        max(with_generic.noise - square, 0.0) / power,
        factors=_factors(state, increment) if changing else (),
    )
    if not found.told:
        return found
    if not drifts:
        chance = _by_chance(state, table, own, [*own, *generic])
        chance = min(chance / power, structured)
        if chance > 0 and means_may_differ_by_chance(state):
            chance = structured
        found = replace(
            found,
            structured=structured - chance,
            unrelated=found.unrelated + chance,
            by_chance=chance,
        )
        if not found.told:
            return found
    gains = {
        name: table.explained([*own, name]).evidence - alone.evidence
        for name in generic
    }
    return replace(found, gains=gains)


def _by_chance(
    state: ModelState,
    table: ColumnProducts,
    own: Collection[str],
    every: Collection[str],
) -> float:
    """Give the power of what seems to follow known signals and does so by chance.

    Noise that is not white looks like much that is slow, and like the response of much
    that is lightly damped. Moved along a record, the end to the beginning, it keeps its
    colour and no longer follows anything: a surrogate [1]_. What follows known signals
    must be more than in each of nineteen of them, a test at 5 %. The mean of a record
    does not move, and is left out. Of a few tones the test tells nothing: moved in time
    they are explained as well. So of the simulated output, moved as far, the larger
    part must stay unexplained. A record that repeats its input needs no test: its
    periods tell what is noise.

    Returns
    -------
    float
        All that is explained, but for the means of records, or zero.

    References
    ----------
    .. [1] J. Theiler, S. Eubank, A. Longtin, B. Galdrikian, J. D. Farmer, "Testing for
       nonlinearity in time series: the method of surrogate data", Physica D 58 (1992)
       77-94.
    """
    if any(record.repeats for record in state.records):
        return 0.0

    def explained(signal: FloatArray) -> float:
        other = table.of_another(signal)
        return other.explained(own).noise - other.explained(every).noise

    left = state.sample.about_means(state.residual)
    structured = explained(left)
    for k in range(1, SURROGATES + 1):
        if explained(_moved(state, left, k)) < structured:
            continue
        output = state.sample.about_means(state.measured - state.residual)
        output = _moved(state, output, k)
        stays = table.of_another(output).explained(every).noise
        return max(structured, 0.0) if stays > MOST * np.mean(output**2) else 0.0
    return 0.0


def means_may_differ_by_chance(state: ModelState) -> bool:
    """Tell whether the means of records differ no more than those of their stretches.

    Of noise that is slow the mean of a record is not zero, and no surrogate moves it.
    An F test at 5 % holds the variance between records against that between the
    stretches of each: batch means [1]_.

    References
    ----------
    .. [1] A. M. Law, Simulation Modeling and Analysis, 5th edition, McGraw-Hill, 2015,
       chapter 9.
    """
    records = [state.residual[part] for part in state.sample.slices]
    count = min(STRETCHES, *map(len, records))
    if len(records) < 2 or count < 2:
        return len(records) < 2  # one constant for all is not counted
    each = np.array(
        [[np.mean(x) for x in np.array_split(own, count)] for own in records]
    )
    whole = float(np.sum((each - np.mean(each)) ** 2))
    within = float(np.sum((each - each.mean(axis=1, keepdims=True)) ** 2))
    share = 1.0 - within / whole if whole > 0 else 0.0
    return f_test(share, len(records) - 1, each.size - 1) > BY_CHANCE


def _moved(state: ModelState, signal: FloatArray, k: int) -> FloatArray:
    """Move a signal in each record by ``k`` of its parts, the end to the beginning."""
    moved = np.empty_like(signal)
    for part in state.sample.slices:
        own = signal[part]
        moved[part] = np.roll(own, k * len(own) // (SURROGATES + 1))
    return moved


def winding(record: Record) -> int:
    """Give how far the path of a drift may wind in a record."""
    return degree(record, FORMS[WINDING])


def owned(state: ModelState) -> dict[str, FloatArray]:
    """Give the columns that the named effects and the base may own, by group.

    Of the base a wrong shape of its hysteresis; of the effects other numbers, as far as
    slopes tell, while other forms were tried by name; a constant and a gain; of what is
    new in every record its own columns.
    """
    rows = len(state.sample)
    simulated = state.measured - state.residual
    return {
        "shape": state.wrong_shape,
        "mixed shape": orthonormal(products(state.simulation, state.sample)),
        "numbers": state.tangents,
        "constant and gain": np.column_stack([np.ones(rows), simulated]),
        "beside": state.beside_columns,
    }


def _numbers(state: ModelState, increment: FloatArray) -> FloatArray:
    """Give what the effects add, and how it changes with each of their numbers."""
    own = state.places_added
    at = [k for k, free in enumerate(state.free) if free.block in own]
    return np.column_stack([increment, state.tangents[:, at]])


def _factors(state: ModelState, increment: FloatArray) -> tuple[float, ...]:
    """Give the strength of what the effects add in each record, by least squares."""
    found = []
    for part in state.sample.slices:
        own = increment[part]
        square = float(own @ own)
        more = float(own @ state.residual[part]) / square if square > 0 else 0.0
        found.append(1.0 + more)
    return tuple(found)

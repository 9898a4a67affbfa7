"""What stays unnamed: structure in the residual that the named effects cannot own.

A name is right when what it leaves is noise, a slightly wrong shape of the base's
hysteresis, or what other numbers of the same effect would take away. Anything else that
follows known signals speaks against it, however small beside the gap.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

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
from hystbench.gap.judging.unowned import Unowned
from hystbench.gap.locate.forms import f_test
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.reshape import orthonormal, products
from hystbench.gap.thresholds import (
    BY_CHANCE,
    MOST,
    UNNAMED_SHARE,
)
from hystbench.record import FloatArray, Record

SURROGATES = round(1 / BY_CHANCE) - 1
"""What follows nothing explains more than all of them by chance alone."""

STRETCHES = 10
"""Stretches of a record. Their means tell how much the mean of the whole may differ by
chance. They are as few as a variance needs, so that each is as long as it may be."""


def measure_unowned(
    base: ModelState,
    state: ModelState,
    floor: Floor,
    allowed: float = UNNAMED_SHARE,
) -> Unowned:
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
    allowed : float
        Share that may stay: of what sort it is, is looked for where more does.
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
            state, own, generic, slow_power, structured, allowed, power
        )
    found = Unowned(
        structured,
        allowed,
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

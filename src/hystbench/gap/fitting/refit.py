"""Refitting all numbers of a model from near, and adding an effect to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.calls import CallsUsedUp
from hystbench.blocks.simulator import Simulator
from hystbench.errors import InputError
from hystbench.gap.fitting.added_signals import beside_slope
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.held import Held
from hystbench.gap.fitting.least_squares import fitted_to_the_end
from hystbench.gap.fitting.model_score import beside_of, make_score, score_of
from hystbench.gap.fitting.score import Score, Told
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.variant_search import Trial
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import SCALE
from hystbench.record import FloatArray

ROUNDS = 5
"""Rounds of least squares in a refit whose tangents are taken anew."""

MENDED = 4
"""Rounds for each of them at most, with those whose tangents are mended."""

DAMPING = (0.0, 1e2, 1e4, 1e6)
"""Charge for a change of the whole of a number, tried until a step pays."""

FAR, NOWHERE = 1e6, 1e100
"""Times its own list's largest that a number may become; where all of it is zero."""

FIXED = 1e30
"""Charge for the square of a change of a number that goes to the end of its range."""

ENOUGH = 0.05
"""A round that lowers the score by less is the last."""

RANGE = 1.5
"""Times a number, up and down, that is looked over before a simulator."""
LOOKS = 16
"""Simulations a number at most."""


def refit(
    state: ModelState,
    score: Score,
    rounds: int = ROUNDS,
    wanted: float = np.inf,
    lent: FloatArray | None = None,
) -> tuple[ModelState, float]:
    """Refit all free numbers together (Levenberg and Marquardt on the score).

    Tangents cost a simulation a number. Those of the base's numbers change little from
    round to round, so they are mended by what a step has done (Broyden) and taken anew
    where the rounds since have gained what matters. Those of the effects' own numbers
    are taken in every round.

    Parameters
    ----------
    state : ModelState
    score : Score
    rounds : int
        Of tangents that are taken anew, at most.
    wanted : float
        Score that is of use. A refit ends after its second round where it would not
        come so far if each further one gained as much. (The first may be short.)
    lent : ndarray, shape (scored samples, k), optional
        Tangents of a model near this one, to begin with. They are not taken anew: the
        result is near enough to compare candidates by.

    Returns
    -------
    state : ModelState
        Never worse than the one given.
    score : float

    References
    ----------
    .. [1] C. G. Broyden, "A class of methods for solving nonlinear simultaneous
       equations", Mathematics of Computation 19 (1965) 577-593.
    """
    own = [k for k, free in enumerate(state.free) if free.block in state.places_added]
    best = since = score_of(state, score)
    tangents, taken, least = None if lent is None else lent.copy(), 0, 0
    for left in reversed(range(MENDED * rounds if state.free else 0)):
        anew = tangents is None
        if tangents is None:
            tangents, since, taken, least = state.tangents, best, taken + 1, 0
        else:
            tangents[:, own] = state.tangents_of(own)
        size = sizes(state, tangents)
        begun, before = state, best
        told = score.told(state.residual, tangents, beside_of(state, score))
        for level in range(least, len(DAMPING)):
            step = _step_in_range(state, score, told, DAMPING[level] / size**2)
            change = dict(enumerate(step.tolist()))
            try:
                moved = state.moved(change, reflected=True)
                value = score_of(moved, score)
            except InputError:
                continue  # out of what the blocks accept together: go less far
            # At the floor the score is flat, and a short step still right. What a fold
            # does not tell would go anywhere.
            idle = value > best - ENOUGH and np.any(np.abs(step) > size)
            if value <= best and not idle:
                state, best, least = moved, value, max(level - 1, 0)
                break
        gained = before - best
        first = left == MENDED * rounds - 1
        if not (first or best - left * gained <= wanted):
            break
        if gained < (ENOUGH if anew else SCALE):
            as_good = since - best < SCALE
            if anew or lent is not None or as_good or taken == rounds:
                break
            tangents = None
        else:
            tangents = mended(tangents, begun, state, size)
    return state, best


def _step_in_range(
    state: ModelState, score: Score, told: Told, damping: FloatArray
) -> FloatArray:
    """Give the step of all free numbers that lowers the score most, as slopes tell.

    A number that would leave its range goes to its end, and the others are solved for
    anew: cut off behind, it would leave them a step that made up for its own.
    """
    ranges = np.array([state.range_of(free) for free in state.free]).reshape(-1, 2)
    values = np.array([state.value(free) for free in state.free])
    low, high = (ranges - values[:, None]).T
    held = state.held.in_steps(damping)
    while True:
        found = score.solved(told, state.freedom, held).values
        ends = np.clip(found, low, high)
        beyond = np.abs(found - ends) > 1e-6 * np.maximum(np.abs(values), np.abs(ends))
        beyond &= held.stiffness < FIXED
        if not beyond.any():
            return found
        held = Held(
            np.where(beyond, FIXED, held.stiffness), np.where(beyond, -ends, held.moved)
        )


def mended(
    tangents: FloatArray, state: ModelState, moved: ModelState, size: FloatArray
) -> FloatArray:
    """Give tangents that foretell what a step has done, and else change least.

    Parameters
    ----------
    tangents : ndarray, shape (scored samples, k)
    state, moved : ModelState
        Before and after the step.
    size : ndarray, shape (k,)
        Of each free number, in which lengths of steps are measured.
    """
    values = [moved.value(free) - state.value(free) for free in state.free]
    step = np.array(values) / size
    missed = (state.residual - moved.residual) - tangents @ (step * size)
    length = max(float(step @ step), 1e-300)
    return tangents + np.outer(missed, step / (size * length))


def sizes(state: ModelState, tangents: FloatArray) -> FloatArray:
    """Give the size of each free number: its value, or what moves the output a tenth.

    The second is for those that are zero, or nearly; but none is far more than the
    numbers of its own list: what hardly moves the output would else run away.
    """
    output = state.measured - state.residual
    moved = np.sqrt(np.mean(tangents**2, axis=0))
    tenth = 0.1 * float(np.sqrt(np.mean(output**2)))
    tenth = tenth / np.maximum(moved, max(tenth / NOWHERE, 1e-300))
    values = np.array([abs(state.value(free)) for free in state.free])
    lists = [
        np.abs(getattr(state.chain[free.block], free.parameter)) for free in state.free
    ]
    largest = np.array([float(np.max(each)) for each in lists])
    most = np.where(largest > 0, FAR * largest, NOWHERE)
    return np.where(values > 1e-3 * tenth, values, np.minimum(tenth, most))


def added(
    state: ModelState, trial: Trial, score: Score, wanted: float = np.inf
) -> tuple[ModelState, float]:
    """Add an effect as a trial found it and refit everything together.

    Parameters
    ----------
    state : ModelState
    trial : Trial
    score : Score
    wanted : float
        Score that is of use, as of :func:`refit`.

    Raises
    ------
    InputError
        If a block refuses the values.
    """
    variant = trial.variant
    about = [variant.effect, variant.place, variant.form, variant.start]
    about.append(variant.operates)
    return remembered_of(
        state,
        lambda: ["added", *about, trial.values, score.digest, wanted],
        lambda: _added(state, trial, score, wanted),
    )


def _added(
    state: ModelState, trial: Trial, score: Score, wanted: float
) -> tuple[ModelState, float]:
    variant = trial.variant
    after = with_effect(state, variant, trial.values)
    if variant.zero is not None:
        after = after.settled()
    if variant.begun:
        after = fitted_to_the_end(after, score).state
        return refit(after, score, wanted=wanted)
    # The model before lends its tangents; the effect's own numbers are the last.
    gone = variant.start if variant.replaces else None
    stay = [k for k, free in enumerate(state.free) if free.block != gone]
    lent = np.zeros((len(state.sample), len(after.free)))
    lent[:, : len(stay)] = state.tangents[:, stay]
    return refit(after, score, wanted=wanted, lent=lent)


def tuned(state: ModelState, score: Score) -> ModelState:
    """Refine what was searched of the signals beside (a frequency): Gauss and Newton.

    Returns
    -------
    ModelState
        Never worse than the one given.
    """
    searched = [(k, key) for k, (_, own) in enumerate(state.beside) for key in own]
    for number, key in searched:
        for _ in range(ROUNDS):
            before = score_of(state, score)
            beside, values = state.beside[number]
            own = state.by_signal(state.beside_amplitudes)[number].ravel()
            slope = beside_slope(state.records, state.sample, beside, values, key, own)
            columns = np.column_stack([state.tangents, state.beside_columns, slope])
            held = state.held.padded(columns.shape[1])
            step = score.amplitudes(state.residual, columns, 0.0, held).values[-1]
            items = list(state.beside)
            items[number] = (beside, {**values, key: values[key] + float(step)})
            moved = replace(state, beside=tuple(items))
            after = score_of(moved, score)
            if after <= before:
                state = moved
            if before - after < ENOUGH:
                break
    return state


def finished(state: ModelState, score: Score) -> tuple[ModelState, float]:
    """Simulate a model exactly and refit it to the end."""
    return remembered_of(
        state,
        lambda: ["finished", score.digest],
        lambda: _finished(state, score),
    )


def _finished(state: ModelState, score: Score) -> tuple[ModelState, float]:
    state = state.settled()
    best, least = state, score_of(state, score)
    for _ in range(ROUNDS):
        state, _ = refit(state, score)
        state = tuned(state, score)
        promised = score_of(state, score)
        state = state.settled()
        value = score_of(state, score)
        if value < least:
            best, least = state, value
        # Where numbers went far, the quick simulation lacks something else than before.
        if value - promised < SCALE:
            break
    return best, least


def finished_to_the_end(state: ModelState, score: Score) -> ModelState:
    """Refit a model exactly, again while the score falls by what matters.

    Numbers that stand in for each other come near in many small steps.
    """
    last, (best, least) = score_of(state, score), finished(state, score)
    while last - least >= SCALE:
        last = least
        try:
            again, value = finished(best, score)
        except CallsUsedUp:
            break  # what was found stands
        if value < least:
            best, least = again, value
    return best


def scanned(state: ModelState, floor: Floor) -> ModelState:
    """Look over the numbers of effects before a simulator, one after the other.

    What a simulator of relays or of rounded numbers gives is a staircase of what it
    takes: the slope over a small step says nothing, and a refit stays where it began.

    Returns
    -------
    ModelState
        The same where nothing scores better by more than a tie, as where no effect
        stands before a simulator.
    """
    last = max(
        (k for k, block in enumerate(state.chain) if isinstance(block, Simulator)),
        default=-1,
    )
    own = {place for item in state.added for place in item.blocks if place < last}
    places = [
        k
        for k, free in enumerate(state.free)
        if free.block in own and free.element is None and state.value(free) != 0.0
    ]
    if not places:
        return state
    from scipy.optimize import minimize_scalar  # late: few searches need it

    score = make_score(state, floor, forms=False)
    best, found = score_of(state, score), state
    for k in places:
        value, free = found.value(found.free[k]), found.free[k]
        ends = sorted((value / RANGE, value * RANGE))
        low, high = np.clip(ends, free.low, free.high).tolist()

        def at(number: float, from_: ModelState = found, k: int = k) -> float:
            try:
                return score_of(from_.at({k: number}), score)
            except CallsUsedUp:  # half a look decides nothing
                raise
            except InputError:  # out of what the simulator takes: no candidate
                return np.inf

        about = {"maxiter": LOOKS, "xatol": 1e-3 * (high - low)}
        there = minimize_scalar(at, bounds=(low, high), method="bounded", options=about)
        if there.fun < best - SCALE:
            found, best = refit(found.at({k: float(there.x)}), score)
    return found

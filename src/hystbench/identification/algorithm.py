"""Algorithm 1: envelopes, thresholds and weights from one slow record.

Equation and step numbers are those of Zhang and Ma, "Modeling of Rate-Dependent
Hysteresis Using a GPO-Based Adaptive Filter", Sensors 16(2), 205, 2016,
doi:10.3390/s16020205.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hystbench.envelope import (
    PUBLISHED_ENVELOPE,
    Envelope,
    fewest_samples,
    thresholds,
)
from hystbench.errors import InputError
from hystbench.identification import shape
from hystbench.identification.result import Identification
from hystbench.identification.search import Progress, Search
from hystbench.identification.weights import Samples, Start, lead_in, solve
from hystbench.metrics import relative_error
from hystbench.record import FloatArray, Record

#: Samples of the thinned record on which starting points are improved.
SEARCH_SAMPLES = 600
#: Share of the iterations after which no new starting point is begun.
SEARCH_SHARE = 0.6
#: Relative error that is tolerable where the caller names no epsilon.
TOLERABLE_RELATIVE_ERROR = 0.005
#: A constant is fitted where the middle of the output is off zero by this share of
#: half its range: the envelopes carry smaller ones.
OFFSET_SHARE = 0.1
#: The same for a loop that runs clockwise, as a share of the box around it.
CLOCKWISE_SHARE = 0.05


def identify(
    u: ArrayLike,
    y: ArrayLike,
    order: int,
    *,
    epsilon: float | None = None,
    max_iterations: int = 1000,
    starts: int = 10,
    seed: int = 0,
    scale: float | None = None,
    offset: bool | None = None,
    nonnegative: bool | None = None,
    start: Start | None = None,
    published: Envelope | None = None,
    progress: Progress | None = None,
) -> Identification:
    """Identify the generalized Prandtl-Ishlinskii model of a slow record.

    Algorithm 1 of the paper. Each iteration takes Steps 4 to 7: thresholds by
    Eq. 10 for the envelopes at hand, the model by Eq. 9, a step down J of Eq. 11,
    and the check against epsilon. For given envelopes the best nonnegative weights
    are a linear problem, which is solved exactly each time; so the search is over
    the envelopes alone (variable projection [1]_ with Kaufman's Jacobian [2]_,
    steps of Levenberg and Marquardt).

    Parameters
    ----------
    u, y : array_like, shape (n,)
        Input and output of the slow record, in any units.
    order : int
        Order N; there are N + 1 operators.
    epsilon : float, optional
        Tolerable J; by default the J of a relative error of 0.005.
    max_iterations : int
        Iterations in all, over all starting points.
    starts : int
        Starting points: a plain one, then random ones.
    seed : int
        Seed of the random starting points.
    scale : float, optional
        Largest magnitude of the envelopes on the range of the input. Envelopes and
        thresholds times s with weights over s are the same model, so data cannot
        tell it; by default the largest magnitude of the input.
    offset : bool, optional
        Whether to fit a constant beside Eq. 9; by default where the output is far
        from centred on zero, which nonnegative weights cannot follow.
    nonnegative : bool, optional
        Whether the weights may not be negative; by default unless the loop runs
        clockwise, as force over displacement does where friction takes energy:
        nonnegative plays only lag, and none of their sums can lead.
    start : {"rest", "settled"}, optional
        States before the first sample; by default whichever fits better from the
        first starting point.
    published : Envelope, optional
        Envelopes to compare with, with weights of their own.
    progress : callable, optional
        Called with the iteration and the least J after each iteration.

    Returns
    -------
    Identification
        The best model found, whether epsilon was reached or not.

    Raises
    ------
    InputError
        If the record is too short, constant or not finite, or a setting makes no
        sense.

    References
    ----------
    .. [1] G. H. Golub and V. Pereyra, "The differentiation of pseudo-inverses and
       nonlinear least squares problems whose variables separate", SIAM J. Numer.
       Anal. 10(2), 413-432, 1973, doi:10.1137/0710036.
    .. [2] L. Kaufman, "A variable projection method for solving separable nonlinear
       least squares problems", BIT 15, 49-57, 1975, doi:10.1007/BF01932995.
    """
    u, y = _checked(u, y, order)
    if starts < 1 or max_iterations < 1:
        raise InputError("starts, max_iterations: expected 1 or more")
    if scale is not None and not 0 < scale < np.inf:
        raise InputError(f"scale: {scale} given, expected above 0")
    if offset is None:
        offset = bool(abs(y.max() + y.min()) > OFFSET_SHARE * np.ptp(y))
    if nonnegative is None:
        nonnegative = clockwise_share(u, y) < CLOCKWISE_SHARE
    if epsilon is None:
        epsilon = float(TOLERABLE_RELATIVE_ERROR**2 * np.sum(y**2))
    low, high = float(u.min()), float(u.max())
    random = np.random.default_rng(seed)
    points = [shape.plain_point()]
    points += [shape.random_point(random) for _ in range(starts - 1)]

    record = Samples(u, y, u[:0], offset, nonnegative)
    search = Search(record, order, epsilon, max_iterations, progress)
    kinds: list[Start] = ["rest", "settled"] if start is None else [start]
    used = 0
    for point in points:
        if search.ended or len(search.history) >= SEARCH_SHARE * max_iterations:
            break
        used += 1
        for kind in kinds:
            if not search.ended:
                search.descend(point, kind, SEARCH_SAMPLES)
        kinds = [search.best.start]
    # the valley of the best point is long: down it on few samples, then on all
    for count, steps in ((SEARCH_SAMPLES, 200), (len(u), 40)):
        if not search.ended:
            best = search.best
            search.descend(best.point, best.start, count, steps, least_gain=1e-6)
    best = search.best
    size = scale if scale is not None else max(abs(low), abs(high))
    envelope, _ = search.envelope(best.point)
    unit = shape.envelope_scale(envelope, low, high)
    fit = partial(
        fit_weights,
        u,
        y,
        order=order,
        offset=offset,
        nonnegative=nonnegative,
        start=best.start,
    )
    compared = None if published is None else fit(published).relative_error
    return replace(
        fit(shape.rescaled(envelope, size / unit)),
        cost_history=tuple(search.history),
        epsilon=epsilon,
        starts=used,
        published_relative_error=compared,
    )


def identify_slow_loop(
    slow: Record, settings: Mapping[str, Any], progress: Progress | None = None
) -> Identification:
    """Identify envelope functions, thresholds and weights on a slow record.

    On the twin the published envelopes are fitted beside the identified ones, and
    these get the same scale: data cannot tell it, and the GPO filter's convergence
    factor depends on it.

    Parameters
    ----------
    slow : Record
    settings : mapping
        ``tolerable_relative_error``, ``order``, ``max_iterations``, ``starts`` and
        ``seed``.
    progress : callable, optional
        As for :func:`hystbench.identification.identify`.
    """
    tolerable = settings["tolerable_relative_error"]
    twin = slow.origin == "twin"
    span = float(slow.u.min()), float(slow.u.max())
    return identify(
        slow.u,
        slow.y,
        settings["order"],
        epsilon=tolerable**2 * float(np.sum(slow.y**2)),
        max_iterations=settings["max_iterations"],
        starts=settings["starts"],
        seed=settings["seed"],
        scale=shape.envelope_scale(PUBLISHED_ENVELOPE, *span) if twin else None,
        published=PUBLISHED_ENVELOPE if twin else None,
        progress=progress,
    )


def fit_weights(
    u: ArrayLike,
    y: ArrayLike,
    envelope: Envelope,
    order: int,
    *,
    offset: bool = False,
    nonnegative: bool = True,
    start: Start = "rest",
) -> Identification:
    """Find the best weights for envelopes that are given.

    Parameters
    ----------
    u, y : array_like, shape (n,)
        Input and output of a slow record.
    envelope : Envelope
        Envelopes, kept as they are.
    order : int
        Order N.
    offset : bool
        Whether to fit a constant beside Eq. 9.
    nonnegative : bool
        Whether the weights may not be negative.
    start : {"rest", "settled"}
        States before the first sample.

    Returns
    -------
    Identification
        With an epsilon of zero, since nothing is iterated.

    Raises
    ------
    InputError
        As for :func:`identify`.
    """
    u, y = _checked(u, y, order)
    amplitude = float(np.max(np.abs(u)))
    samples = Samples(u, y, lead_in(u, start), offset, nonnegative)
    r = thresholds(envelope, amplitude, order)
    weights, constant = solve(samples.outputs(envelope, r), y, offset, nonnegative)
    error = samples.model(envelope, r, weights) + constant - y
    cost = float(error @ error)
    return Identification(
        envelope=envelope,
        thresholds=r,
        weights=weights,
        offset=constant,
        amplitude=amplitude,
        start=start,
        cost=cost,
        cost_history=(cost,),
        epsilon=0.0,
        relative_error=relative_error(error, y),
        starts=0,
    )


def clockwise_share(u: FloatArray, y: FloatArray) -> float:
    """Area that a record encloses clockwise, as a share of the boxes around it.

    Negative where the output lags the input, as with plays of positive weight.
    """
    back = np.append(u[1:], u[0]) - u
    area = float(np.sum(0.5 * (y + np.append(y[1:], y[0])) * back))
    return area / float(0.5 * np.sum(np.abs(back)) * np.ptp(y))


def _checked(u: ArrayLike, y: ArrayLike, order: int) -> tuple[FloatArray, FloatArray]:
    """Take a slow record as arrays, or say what is wrong with it."""
    u = np.ascontiguousarray(u, dtype=np.float64)
    y = np.ascontiguousarray(y, dtype=np.float64)
    if u.ndim != 1 or u.shape != y.shape:
        raise InputError(f"slow record: u {u.shape} and y {y.shape} must match")
    if order < 0:
        raise InputError(f"order: {order} given, expected 0 or more")
    if len(u) < fewest_samples(order):
        raise InputError(
            f"slow record: {len(u)} samples, expected at least "
            f"{fewest_samples(order)} for order {order}"
        )
    for name, values in (("u", u), ("y", y)):
        if not np.isfinite(values).all():
            raise InputError(f"slow record: {name} is not finite")
        if np.ptp(values) == 0:
            raise InputError(f"slow record: {name} is constant")
    return u, y

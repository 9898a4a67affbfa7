"""What a block does at one sample, for code that runs elsewhere.

A block of the vocabulary says its step as the name of a function and what that
function takes: constants, and states that are all zero at the start. The functions are
written twice, in C and in Python, in :mod:`hystbench.export`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyfromroots

from hystbench.record import FloatArray

LARGEST_POINTS = 8
"""Samples that a curve goes through at most where none to come is known."""
CENTRAL = np.array([-0.5, 0.0, 0.5])
"""Weights of a sample and its neighbours for the central difference, per sample."""
LARGEST_AHEAD = 15
"""Samples to come that a block gains by at most: a curve through so many on both sides
is within a millionth of a sine's amplitude up to a fifth of the sampling rate."""


@dataclass(frozen=True)
class Sampling:
    """What is known of the signal that exported code will get.

    Parameters
    ----------
    dt : float
        Sampling interval in seconds.
    points : int
        A signal that is smooth between its samples is taken as the polynomial through
        the newest so many: code that runs sample by sample knows none to come.
    duration_s : float, optional
        Length of the record to which a path of drift belongs.
    delay : int
        Samples by which the output may be late: so many to come are then known.
    ahead : int
        Of a block: samples that are known beyond the one that it is asked for.
    late : int
        Of a block: samples by which what it is asked for is behind the model's input.
    """

    dt: float
    points: int = 6
    duration_s: float | None = None
    delay: int = 0
    ahead: int = 0
    late: int = 0

    @property
    def curve_points(self) -> int:
        """Samples that a curve goes through: at least as many on either side."""
        return max(self.points, 2 * self.ahead + 2)


@dataclass(frozen=True)
class Step:
    """One call of a function: constants, states, and then the signals that it takes.

    Parameters
    ----------
    function : str
        Name of the function, without the prefix that it has in C.
    constants : mapping of str to int, float or ndarray of float
        In the order of the function's arguments.
    states : mapping of str to int
        Name and length of each state, an array of numbers; zero at the start.
    watches : bool
        Whether its state ``history`` is of the model's input; it is filled, with as
        many samples as the constant ``points`` says, before anything else is done.
    forward : bool
        Whether the step is nearer to the simulation where samples to come are known.
    rates : int
        Samples to come that make a rate which it takes exact; none where it takes none.
    grows : bool
        Whether it takes a factor on its thresholds.
    drives : int
        For a block that wraps hysteresis: 0 where it adds its own output to that of
        what is inside; else how often, at most, it calls what is inside in one sample.
    undoes : bool
        Whether it looks for the input of what is inside it, of which it tries some.
    past : str
        What came before the first sample, if that depends on samples to come:
        :data:`PASSED` or :data:`TURNED`. What is remembered of a passage is the state
        ``w``.
    differs : str
        How the step differs from the block's simulation of a whole record, if it does:
        the end of a sentence that begins with the block.
    """

    function: str
    constants: Mapping[str, Any] = field(default_factory=dict)
    states: Mapping[str, int] = field(default_factory=dict)
    watches: bool = False
    forward: bool = False
    rates: int = 0
    grows: bool = False
    drives: int = 0
    undoes: bool = False
    past: str = ""
    differs: str = ""


def polynomial(*coefficients: float) -> Step:
    """Give the step of a polynomial, the constant first."""
    count = len(coefficients)
    return Step("polynomial", {"count": count, "coefficients": np.array(coefficients)})


def through_samples(
    points: int, moment: Callable[[int], float | FloatArray], origin: float = 0.0
) -> FloatArray:
    """Find what a linear functional takes of the polynomial through the newest samples.

    Parameters
    ----------
    points : int
        Samples, the newest at time 0 and the others at -1, -2 and so on.
    moment : callable
        Gives the functional of ``(t - origin)^m`` from m.
    origin : float
        A time where the functional looks: about it powers are well told apart.

    Returns
    -------
    ndarray, shape (points,) or (points, k)
        Weights of the samples, the newest first; ``(points, k)`` for k functionals.
    """
    places = -np.arange(points) - origin
    # The polynomials that are one at a sample and zero at the others.
    basis = np.empty((points, points))
    for k, place in enumerate(places):
        others = np.delete(places, k)
        basis[k] = polyfromroots(others) / np.prod(place - others)
    weights: FloatArray = basis @ np.array([moment(m) for m in range(points)])
    return weights


def value_at(points: int, place: float) -> FloatArray:
    """Weights of the samples for the curve's value at a time, the newest at 0."""
    return through_samples(points, lambda m: float(m == 0), place)


def about_sample(weights: FloatArray, points: int, ahead: int) -> FloatArray:
    """Weights of the newest samples for a difference about one of them.

    Where the samples that it takes are known it is that of these alone.

    Parameters
    ----------
    weights : ndarray, shape (2 k + 1,)
        Of the sample, the k before it and the k after it, the oldest first.
    points, ahead : int
        Samples that a curve goes through; so many of them are later.

    Returns
    -------
    ndarray, shape (points,)
        The newest first.
    """
    reach = len(weights) // 2
    if ahead < reach:
        around = np.arange(-reach, reach + 1.0)
        return through_samples(points, lambda m: float(weights @ around**m), -ahead)
    taken = np.zeros(points)
    taken[ahead - reach : ahead + reach + 1] = weights[::-1]
    return taken


def central_difference(points: int, place: float, half_width: float) -> FloatArray:
    """Weights of the samples for a central difference of the curve, per sample."""

    def moment(m: int) -> float:
        return (half_width**m - (-half_width) ** m) / (2 * half_width)

    return through_samples(points, moment, place)


def line_corners(hold: str, points: int, ahead: int = 0) -> tuple[int, int, FloatArray]:
    """Give what straight lines between two samples take of the newest samples.

    Parameters
    ----------
    hold : {"zero-order", "linear", "band-limited"}
        A band-limited input is taken as :func:`straight_lines` twice as fine.
    points : int
        Samples that a band-limited curve goes through.
    ahead : int
        So many of them are later than the one that the output is for.

    Returns
    -------
    segments : int
        Lines of an interval.
    points : int
        Samples that are needed.
    corners : ndarray, shape ((segments + 1) points,)
        Weights of the samples for each corner, the oldest corner first.
    """
    if hold != "band-limited":
        points = 2 + ahead
        return 1, points, np.eye(points)[[ahead + 1, ahead]].ravel()
    each = [_smooth_corner(points, at - ahead) for at in (-1.0, -0.5, 0.0)]
    return 2, points, np.concatenate(each)


def _smooth_corner(points: int, place: float) -> FloatArray:
    """Weights of the samples for a corner of :func:`straight_lines`, twice as fine.

    ``1 / sinc^2`` of a frequency w is ``1 + (w h)^2 / 12 + (w h)^4 / 240 + ...`` with
    the corners h apart: so much of the curve's second and fourth derivative, with
    their signs, is added to its value.
    """
    h = 0.5
    share = {0: 1.0, 2: -(h**2) / 12 * 2, 4: h**4 / 240 * 24}
    return through_samples(points, lambda m: share.get(m, 0.0), place)


def smooth_curve(points: int, ahead: int = 0) -> str:
    """Say what becomes of a band-limited input."""
    later = f" ({ahead} of them later)" if ahead else ""
    return (
        "takes its input between two samples from the polynomial through the newest "
        f"{points}{later}, and not from all samples of a record"
    )


def foretold(weights: FloatArray, points: int, ahead: int) -> str:
    """Say what becomes of a rate; nothing where it knows the samples on both sides.

    Parameters
    ----------
    weights : ndarray, shape (2 k + 1,)
        Of the samples that it takes, per sample, as for :func:`about_sample`.
    points, ahead : int
    """
    needed = len(weights) // 2
    if ahead >= needed:
        return ""
    noise = noise_of_rate(about_sample(weights, points, ahead)) / noise_of_rate(weights)
    missing = needed - ahead
    return (
        f"foretells the next {'sample' if missing == 1 else f'{missing} samples'} by "
        f"the polynomial through the newest {points}, for its rate, in which noise is "
        f"{noise:.2g} times as large as with --delay {needed}"
    )


def noise_of_rate(weights: FloatArray) -> float:
    """Give how noisy a rate is, of white noise, over that of a central difference.

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Of the samples, for the rate per sample.
    """
    return float(np.sqrt(np.sum(weights**2) / np.sum(CENTRAL**2)))


PASSED, TURNED = "passed", "turned"
"""What came before the first sample: its input passed once, and its hysteresis
remembers that; or its input came as it leaves, the record turned about its start."""
UNKNOWN_PAST = {
    PASSED: "starts at rest, as without --past it is not known what has passed",
    TURNED: "starts settled on its first sample, as without --past it is not known "
    "what came before",
}
"""What code does that is given no record: it knows none of its samples to come."""

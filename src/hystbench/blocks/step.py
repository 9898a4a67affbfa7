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

from hystbench.record import FloatArray

LARGEST_POINTS = 8
"""Samples that a curve goes through at most; the C functions hold so many."""


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
    points: int, moment: Callable[[int], float | FloatArray]
) -> FloatArray:
    """Find what a linear functional takes of the polynomial through the newest samples.

    Parameters
    ----------
    points : int
        Samples, the newest at time 0 and the others at -1, -2 and so on.
    moment : callable
        Gives the functional of ``t^m`` from m.

    Returns
    -------
    ndarray, shape (points,) or (points, k)
        Weights of the samples, the newest first; ``(points, k)`` for k functionals.
    """
    degrees = np.arange(points)
    places = -np.arange(points, dtype=np.float64)
    wanted = np.array([moment(int(m)) for m in degrees])
    weights: FloatArray = np.linalg.solve(places[None, :] ** degrees[:, None], wanted)
    return weights


def value_at(points: int, place: float) -> FloatArray:
    """Weights of the samples for the curve's value at a time, the newest at 0."""
    return through_samples(points, lambda m: place**m)


def sample_rate(sampling: Sampling, ahead: int) -> FloatArray:
    """Weights of the samples for the central difference at a sample, per second.

    Where the next sample is known it is that of the two neighbours alone.
    """
    if ahead:
        weights = np.zeros(sampling.points)
        weights[[ahead - 1, ahead + 1]] = 0.5, -0.5
    else:
        weights = central_difference(sampling.points, 0.0, 1.0)
    return np.asarray(weights / sampling.dt)


def central_difference(points: int, place: float, half_width: float) -> FloatArray:
    """Weights of the samples for a central difference of the curve, per sample."""
    ahead, back = place + half_width, place - half_width
    return through_samples(points, lambda m: (ahead**m - back**m) / (2 * half_width))


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
        return 1, 2, np.concatenate([value_at(2, -1.0), value_at(2, 0.0)])
    each = [_smooth_corner(points, at - ahead) for at in (-1.0, -0.5, 0.0)]
    return 2, points, np.concatenate(each)


def _smooth_corner(points: int, place: float) -> FloatArray:
    """Weights of the samples for a corner of :func:`straight_lines`, twice as fine.

    ``1 / sinc^2`` of a frequency w is ``1 + (w h)^2 / 12 + (w h)^4 / 240 + ...`` with
    the corners h apart: so much of the curve's second and fourth derivative, with
    their signs, is added to its value.
    """
    h = 0.5

    def derivative(m: int, order: int) -> float:
        lost = float(np.prod(np.arange(m, m - order, -1.0)))
        return lost * place ** (m - order) if m >= order else 0.0

    def moment(m: int) -> float:
        second, fourth = derivative(m, 2), derivative(m, 4)
        return derivative(m, 0) - h**2 / 12 * second + h**4 / 240 * fourth

    return through_samples(points, moment)


def second_difference(points: int) -> FloatArray:
    """Weights of the samples for a second difference of the curve at the newest."""
    return through_samples(points, lambda m: 1.0 + (-1.0) ** m - 2 * 0.0**m)


def smooth_curve(points: int, ahead: int = 0) -> str:
    """Say what becomes of a band-limited input."""
    later = f" ({ahead} of them later)" if ahead else ""
    return (
        "takes its input between two samples from the polynomial through the newest "
        f"{points}{later}, and not from all samples of a record"
    )


def foretold(points: int, ahead: int = 0) -> str:
    """Say what becomes of a central difference; nothing where it knows both sides."""
    if ahead:
        return ""
    return (
        f"foretells the next sample by the polynomial through the newest {points}, "
        "for its rate"
    )


PASSED, TURNED = "passed", "turned"
"""What came before the first sample: its input passed once, and its hysteresis
remembers that; or its input came as it leaves, the record turned about its start."""
UNKNOWN_PAST = {
    PASSED: "starts at rest, as without --past it is not known what has passed",
    TURNED: "starts settled on its first sample, as without --past it is not known "
    "what came before",
}
"""What code does that is given no record: it knows none of its samples to come."""

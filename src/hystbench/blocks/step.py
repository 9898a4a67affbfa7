"""What a block does at one sample, for code that runs elsewhere.

A block of the vocabulary says its step as the name of a function and what that
function takes: constants, and states that are all zero at the start, unless
:mod:`hystbench.export.on_record` gives others. The functions are in C, in
:mod:`hystbench.export`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.curve import AHEAD, CENTRAL, about_sample, corner
from hystbench.record import FloatArray

LARGEST_POINTS = 8
"""Samples that a curve goes through at most where none to come is known."""


@dataclass(frozen=True)
class Sampling:
    """What is known of the signal that exported code will get."""

    dt: float
    """Sampling interval in seconds."""
    points: int = 6
    """A signal that is smooth between its samples is taken as the polynomial through
    the newest so many: code that runs sample by sample knows none to come."""
    duration_s: float | None = None
    """Length of the record to which a path of drift belongs."""
    delay: int = 0
    """Samples by which the output may be late: so many to come are then known."""
    ahead: int = 0
    """Samples that a block needs to know beyond the one that it is asked for."""
    late: int = 0
    """Samples by which what a block is asked for is behind the model's input."""

    @property
    def curve_points(self) -> int:
        """Samples that a curve goes through: at least as many on either side."""
        return max(self.points, 2 * self.ahead + 2)


@dataclass(frozen=True)
class Step:
    """One call of a function: constants, states, and then the signals that it takes."""

    function: str
    """Name of the function, without the prefix that it has in C."""
    constants: Mapping[str, Any] = field(default_factory=dict)
    """Constants, in the order of the function's arguments."""
    states: Mapping[str, int] = field(default_factory=dict)
    """Name and length of each state, an array of numbers; zero at the start."""
    watches: bool = False
    """Whether its state ``history`` is of the model's input; it is filled, with as many
    samples as the constant ``points`` says, before anything else is done."""
    gains: int = 0
    """Samples to come with which the step is the simulation's, or as near as it gets;
    none where it needs none."""
    rates: int = 0
    """Samples to come that make a rate exact; none where it takes no rate."""
    grows: bool = False
    """Whether it takes a factor on its thresholds."""
    drives: int = 0
    """For a block that wraps hysteresis: 0 where it adds its own output to that of what
    is inside; else how often, at most, it calls what is inside in one sample."""
    undoes: bool = False
    """Whether it looks for the input of what is inside it, of which it tries some."""
    past: str = ""
    """What came before the first sample, if that depends on samples to come:
    :data:`PASSED`, :data:`TURNED` or :data:`REPEATED`. What is remembered of a passage
    is the state ``w``."""
    differs: str = ""
    """How the step differs from the block's simulation of a whole record, if it does:
    the end of a sentence that begins with the block."""


def polynomial(*coefficients: float) -> Step:
    """Give the step of a polynomial, the constant first."""
    count = len(coefficients)
    return Step("polynomial", {"count": count, "coefficients": np.array(coefficients)})


class Lines(NamedTuple):
    """Straight lines between two samples, along which a step's function moves."""

    segments: int
    """Segments of an interval."""
    constants: dict[str, Any]
    """What the function takes: corners are weights of samples, the oldest first."""
    states: dict[str, int]
    told: dict[str, Any]
    """How the step differs, and how many later samples would make it exact."""


def lines_of(hold: str, sampling: Sampling) -> Lines:
    """Give the lines that the newest samples make.

    Parameters
    ----------
    hold : {"zero-order", "linear", "band-limited"}
        A band-limited input is taken as
        :func:`~hystbench.blocks.curve.held_lines` twice as fine.
    sampling : Sampling
    """
    ahead, segments, told = sampling.ahead, 1, ""
    points = 2 + ahead
    corners = np.eye(points)[[ahead + 1, ahead]].ravel()
    if hold == "band-limited":
        segments, points = 2, sampling.curve_points + 1
        told = smooth_curve(points - 1, ahead)
        middle, end = (corner(points - 1, place - ahead) for place in (-0.5, 0.0))
        each = [np.append(0.0, end), np.append(middle, 0.0), np.append(end, 0.0)]
        corners = np.concatenate(each)
    constants = {
        "segments": segments,
        "points": points,
        "ahead": ahead,
        "corners": corners,
        "ramp": float(hold != "zero-order"),
    }
    gains = AHEAD * (segments > 1)
    return Lines(
        segments, constants, {"history": 1 + points}, {"gains": gains, "differs": told}
    )


def smooth_curve(points: int, ahead: int = 0) -> str:
    """Say what becomes of a band-limited input, if not what the simulation does."""
    if ahead >= AHEAD:
        return ""
    later = f" ({ahead} of them later)" if ahead else ""
    return (
        "takes its input between two samples from the polynomial through the newest "
        f"{points}{later}, and not from as many on either side"
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


PASSED, TURNED, REPEATED = "passed", "turned", "repeated"
"""What came before the first sample: its input passed once, and its hysteresis
remembers that; its input came as it leaves, the record turned about its start; or the
whole record."""
_SETTLED = (
    "starts settled on its first sample, as without --past it is not known "
    "what came before"
)
UNKNOWN_PAST = {
    PASSED: "starts at rest, as without --past it is not known what has passed",
    TURNED: _SETTLED,
    REPEATED: _SETTLED,
}
"""What code does that is given no record: it knows none of its samples to come."""

"""Steps that undo a block, for code that is given its output sample by sample."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from math import comb

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.curve import AHEAD, derivative_at
from hystbench.blocks.force import Force
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.linear import LinearBlock, linear_step
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.rate_dependent_hysteresis import RateDependentHysteresis
from hystbench.blocks.starts import PASTS
from hystbench.blocks.state_space import StateSpace
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.blocks.wrapping import Wrappable
from hystbench.record import FloatArray

Ends = tuple[float, float]
"""Lowest and highest value of a signal."""
Making = Callable[[Sampling], Step]
"""Makes a step for what is known of the signal at its place."""

KNOTS = 1001
"""Knots of the table that stands for an inverted curve."""
FINER_TIMES = 20
"""Times as many points, by which the curve is sampled and the table judged."""
ROUNDING = 1e-13
"""Share of the output's range within which the input of hysteresis stands still: where
the output says nothing of it, it stays where it was."""
NEAR_SHARE = 0.01
"""Share by which a rate may be off in the band that is told."""


class CannotBe(ValueError):  # noqa: N818 - it reads as a sentence where it is raised
    """Why a block cannot be undone; the end of a sentence."""


def left(why: str, sampling: Sampling) -> Step:
    """Leave the block alone and say so."""
    step = polynomial(0.0, 1.0)
    return Step(step.function, step.constants, differs=why)


def straight(offset: float, slope: float, sampling: Sampling) -> Step:
    """Undo a straight line."""
    return polynomial(-offset / slope, 1 / slope)


def curve(block: Block, ends: Ends, sampling: Sampling) -> Step:
    """Undo a block without memory by a table, or by a line where it is one.

    Raises
    ------
    CannotBe
        If the block remembers, or its curve does not rise or fall throughout.
    """
    step = block.step(sampling)
    if step.states or step.watches:
        raise CannotBe("none is known")
    if step.function == "polynomial" and step.constants["count"] == 2:
        offset, slope = step.constants["coefficients"]
        if slope == 0:
            raise CannotBe("its output does not depend on its input")
        return straight(offset, slope, sampling)
    x = np.linspace(*ends, (KNOTS - 1) * FINER_TIMES + 1)
    y = block.simulate(x, x, 1.0)
    if y[-1] < y[0]:
        x, y = x[::-1], y[::-1]
    rises = np.flatnonzero(np.diff(y) > 0)  # flat at its ends: it stands there
    if not len(rises):
        raise CannotBe("its output does not depend on its input")
    x, y = (values[rises[0] : rises[-1] + 2] for values in (x, y))
    if not (np.diff(y) > 0).all():
        raise CannotBe("its curve does not rise or fall throughout")
    places = np.linspace(y[0], y[-1], KNOTS)
    values = np.interp(places, y, x)
    off = np.abs(np.interp(y, places, values) - x).max() / np.ptp(x)
    constants = {
        "last": KNOTS - 1,
        "low": float(y[0]),
        "each": float(places[1] - places[0]),
        "values": values,
    }
    told = f"is a table of {KNOTS} knots, within {off:.1g} of the input's range"
    return Step("looked_up", constants, differs=told)


def hysteresis(
    inner: Wrappable, ends: Ends, by: RateDependentHysteresis | None = None
) -> Making:
    """Find the input of hysteresis by trial, its thresholds growing with a rate or not.

    Raises
    ------
    CannotBe
        If its slow loop does not rise, or fall, with its input.
    """
    up = np.linspace(*ends, KNOTS)
    path = np.concatenate([up, up[::-1], up])
    y = inner.grow(path, path, 1.0, None)
    reach = float(np.ptp(y))
    falling, rising = np.diff(y[KNOTS : 2 * KNOTS]), np.diff(y[2 * KNOTS :])
    moved = np.concatenate([-falling, rising])
    way = 1.0 if moved.sum() > 0 else -1.0
    if reach == 0 or (way * moved < -1e-9 * reach).any():
        raise CannotBe("its output does not rise or fall throughout with its input")
    rate = (by.coefficient, by.exponent, by.knee) if by else (0.0, 1.0, 0.0)

    def making(sampling: Sampling) -> Step:
        constants = {
            "near": ROUNDING * reach,
            "low": ends[0],
            "high": ends[1],
            "way": way,
            "coefficient": rate[0],
            "exponent": rate[1],
            "knee": rate[2],
            "dt": sampling.dt,
        }
        told = "takes the rate of the interval before, which is one sample old"
        states = {"at": 2, "pace": 4}
        differs = told if by else ""
        return Step("undo", constants, states, undoes=True, differs=differs)

    return making


def field(by: RateDependentHysteresis, sampling: Sampling) -> Step:
    """Find the field that is applied from the one that acts: v = g + c |dg/dt|^a.

    Raises
    ------
    CannotBe
        If what is lost follows the rate of v: its inverse runs away.
    """
    if by.form == "excess-field":
        raise CannotBe(
            "the field that is lost follows the rate of the one that is sought, which "
            "diverges; with 'form: acting-field' it does not"
        )
    smooth = by.holding == "band-limited"
    points = sampling.curve_points if smooth else 2
    ahead = sampling.ahead if smooth else 0
    constants = {
        "coefficient": by.coefficient,
        "exponent": by.exponent,
        "points": points,
        "ahead": ahead,
        "rate": derivative_at(points, -ahead, 1) / sampling.dt,
    }
    told = f"takes its rate from the polynomial through the newest {points}"
    return Step(
        "applied_field",
        constants,
        {"history": 1 + points},
        gains=AHEAD * smooth,
        differs=told if smooth else "",
    )


def linear(block: LinearBlock) -> Iterator[Making]:
    """Give what undoes linear dynamics.

    The output is behind the input by some integrations: with so many derivatives,
    ``(1 + s / w)^r``, w being the fastest pole, it answers at once, and input and
    output can be exchanged.
    """
    system, order, w = _advanced(block)
    if order:
        yield partial(_derivatives, order, w)
    yield partial(_exchanged, system, getattr(block, "start", "rest"))


def _derivatives(order: int, w: float, sampling: Sampling) -> Step:
    """Take derivatives of the curve through the newest samples.

    Raises
    ------
    CannotBe
        If the curve has not so many.
    """
    points, ahead = sampling.curve_points, sampling.ahead
    if order > points - 1:
        raise CannotBe(
            f"it takes {order} derivatives, and --points {points} gives less"
        )
    taps = np.zeros(points)
    for k in range(order + 1):
        share = comb(order, k) / (w * sampling.dt) ** k
        taps += share * derivative_at(points, -ahead, k)
    top = _band(taps, ahead, order, w * sampling.dt) / sampling.dt
    many = "one derivative" if order == 1 else f"{order} derivatives"
    return Step(
        "at_samples",
        {"points": points, "taps": taps},
        {"history": 1 + points},
        gains=AHEAD,
        differs=f"takes {many} of the curve through the newest {points}, within "
        f"{100 * NEAR_SHARE:g} % to {top:.3g} Hz",
    )


def _exchanged(system: StateSpace, start: str, sampling: Sampling) -> Step:
    """Exchange the input and the output of what answers at once.

    What depends on samples to come begins settled, which is told.

    Raises
    ------
    CannotBe
        If that is unstable.
    """
    d = system.d
    if d == 0:
        raise CannotBe("its output does not depend on its input")
    if not system.c.any():
        return straight(0.0, d, sampling)
    a = system.a - np.outer(system.b, system.c) / d
    if (np.linalg.eigvals(a).real >= 0).any():
        raise CannotBe("its inverse is unstable")
    inverse = StateSpace(a, system.b / d, -system.c / d, 1 / d)
    step = linear_step(inverse, sampling, "band-limited", start != "rest")
    told = "begins as if its first value had always been there"
    return replace(step, differs=told) if start in PASTS else step


def motion(block: Mechanism, forces: tuple[Force, ...], sampling: Sampling) -> Step:
    """Find the force that a coordinate's motion takes."""
    force = Impedance(
        mass=block.mass,
        damping=block.damping,
        stiffness=block.stiffness,
        input=block.output,
    )
    return force.driven_step(sampling, forces)


def _advanced(block: LinearBlock) -> tuple[StateSpace, int, float]:
    """Multiply a block by ``(1 + s / w)`` until its output answers at once.

    Returns
    -------
    system : StateSpace
        With a direct path, if it has an output at all.
    order : int
    w : float
        The fastest pole, in radians per second.
    """
    a, b, c, d = block.continuous()
    w = float(np.abs(np.linalg.eigvals(a)).max())
    order = 0
    while d == 0 and order < len(b):
        rise = float(c @ b) / w
        small = 1e-12 * float(np.abs(c) @ np.abs(b)) / w
        d, c = (0.0 if abs(rise) <= small else rise), c + c @ a / w
        order += 1
    scale = float(np.abs(c).max(initial=0.0))
    c = np.where(np.abs(c) <= 1e-12 * max(scale, abs(d)), 0.0, c)
    return StateSpace(a, b, c, d), order, w


def _band(taps: FloatArray, ahead: int, order: int, turn: float) -> float:
    """Give the frequency, per sample, up to which the taps are near ``(1 + s/w)^r``."""
    frequency = np.linspace(0, 0.5, 5001)[1:]
    angle = 2j * np.pi * frequency
    made = np.exp(-np.outer(angle, np.arange(len(taps)) - ahead)) @ taps
    off = np.abs(made / (1 + angle / turn) ** order - 1)
    beyond = np.flatnonzero(off > NEAR_SHARE)
    return float(frequency[beyond[0]] if len(beyond) else frequency[-1])

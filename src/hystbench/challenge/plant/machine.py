"""Machines: one moving part with forces inside, and tanks in a row.

Their physics and numerics are their own: velocity Verlet with set-valued friction for a
part, the classical Runge-Kutta method for tanks, on a grid much finer than the
record's.
"""

from dataclasses import astuple, dataclass
from functools import lru_cache

import numpy as np

from hystbench.challenge import kernels
from hystbench.record import FloatArray

#: Steps of the fine grid a sample.
FINE = 32


@dataclass(frozen=True)
class MovingPart:
    """A moving part: ``m q'' + c q' + k q + forces = u``."""

    mass: float = 1.0
    damping: float = 0.0
    stiffness: float = 0.0
    """The linear part."""
    quadratic: float = 0.0
    cubic: float = 0.0
    """Factors of q^2 and q^3 in the spring's force."""
    sinh_force: float = 0.0
    sinh_reach: float = 1.0
    """Adds ``sinh_force (sinh(q / sinh_reach) - q / sinh_reach)``."""
    pendulum: float = 0.0
    angle: float = 0.0
    """Adds ``pendulum`` times what ``sin(q + angle)`` differs from its tangent at 0."""
    wall_right: float = np.inf
    wall_left: float = np.inf
    wall_stiffness: float = 0.0
    """Springs that are touched beyond a clearance to either side."""
    coulomb: float = 0.0
    surplus: float = 0.0
    stribeck_speed: float = 1.0
    """Dry friction ``coulomb + surplus exp(-(v / stribeck_speed)^2)``."""
    presliding: float = 0.0
    """Distance over which dry friction builds up; 0 for a rigid contact."""
    drag: float = 0.0
    """Adds ``drag v |v|``."""
    remembered: float = 0.0
    yield_distance: float = 1.0
    sharpness: float = 1.0
    unloading: float = 1.0
    """Bouc-Wen's force: at most ``remembered``, and its slope on the way back."""
    slider_stiffness: float = 0.0
    slip: float = 0.0
    clearance: float = 0.0
    """A spring that slips beyond ``slip`` and carries nothing within ``clearance``."""
    coil_width: float = 0.0
    coil_shift: float = 0.0
    """What drives it has a force that falls by half at this distance from the middle of
    its magnet; 0 for a force that is the same everywhere."""
    ripple: float = 0.0
    ripple_rate: float = 0.0
    ripple_phase: float = 0.0
    """Share by which the linear spring swings in time, in rad/s and rad."""
    loose_stiffness: float = 0.0
    loose: float = 0.0
    wear: float = 0.0
    """A spring behind a clearance that grows by ``wear`` times the way gone."""

    @property
    def numbers(self) -> FloatArray:
        """All of them in the order that the kernel has them in."""
        return np.array(list(vars(self).values()), dtype=np.float64)


@dataclass(frozen=True)
class PartMotion:
    """What a part did, on the fine grid: a force and the motion under it."""

    force: FloatArray
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


def move(
    part: MovingPart,
    drive: FloatArray,
    dt: float,
    begun: tuple[float, float] = (0.0, 0.0),
    gains: tuple[float, float] = (0.0, 0.0),
) -> PartMotion:
    """Move a part by a force, or along a reference.

    Parameters
    ----------
    part : MovingPart
    drive : ndarray, shape (n,)
        The force; with gains the position that is wanted.
    dt : float
        Step in seconds.
    begun : tuple of float
        Position and velocity at the first sample.
    gains : tuple of float
        Force for each unit of the error of position and of velocity; zeros for none.
    """
    drive = np.ascontiguousarray(drive, dtype=np.float64)
    n = len(drive)
    out = [np.empty(n) for _ in range(4)]
    kernels.call("hc_mass", n, dt, *begun, *gains, part.numbers, drive, *out)
    return PartMotion(*out)


def resist(part: MovingPart, position: FloatArray, dt: float) -> FloatArray:
    """Compute the force that a prescribed motion of a part takes."""
    return kernels.run("hc_impedance", dt, part.numbers, over=position)


@dataclass(frozen=True)
class Tank:
    """A tank: ``area h' = inflow - coefficient h^exponent``, with a rim."""

    area: float
    coefficient: float
    exponent: float = 1.0
    rim: float = np.inf
    """Level above which it runs over."""
    caught: float = 0.0
    """Share of what runs over that falls into the next tank."""
    back: float = 0.0
    """1 where the next tank's level stands against the outlet, else 0."""
    leak: float = 0.0
    leak_time: float = 1.0
    """A seal lets through ``leak coefficient w h``, where ``w`` is how wet it is: it
    follows the level with this time in seconds."""


def fill(
    tanks: tuple[Tank, ...],
    inflow: FloatArray,
    dt: float,
    begun: tuple[float, ...] = (0.0, 0.0),
) -> FloatArray:
    """Compute the level of the last of one or two tanks.

    Parameters
    ----------
    tanks : tuple of Tank
        The first gets the inflow, the next what leaves it.
    inflow : ndarray, shape (n,)
    dt : float
        Step in seconds.
    begun : tuple of float
        Level of each at the first sample.
    """
    numbers = np.array([astuple(tank) for tank in tanks], dtype=np.float64).ravel()
    levels = np.array(begun, dtype=np.float64)
    return kernels.run("hc_tanks", len(tanks), dt, numbers, levels, over=inflow)


def decimated(fine: FloatArray, steps: int = FINE) -> FloatArray:
    """Take the record's samples off a grid of so many steps a sample.

    A low-pass without delay stands before.
    """
    from scipy.signal import resample_poly  # late: not needed for actuators

    y = resample_poly(fine, 1, steps, window=low_pass(steps))
    return np.asarray(y, dtype=np.float64)


@lru_cache
def low_pass(rate: int) -> FloatArray:
    """Give the filter that ``resample_poly`` would design anew at each call."""
    from scipy.signal import firwin  # late: not needed for actuators

    return np.asarray(firwin(20 * rate + 1, 1.0 / rate, window=("kaiser", 5.0)))

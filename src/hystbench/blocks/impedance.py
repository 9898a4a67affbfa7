"""Block ``impedance``: the force that a given motion takes."""

from collections.abc import Sequence, Set
from functools import lru_cache

import numpy as np

from hystbench.blocks.attached import Others, OthersOnRecords, Signals
from hystbench.blocks.curve import (
    AHEAD,
    POINTS,
    SHORT_STEPS,
    about_sample,
    coarser,
    derivative_at,
    low_pass_taps,
    through_samples,
    weighed,
)
from hystbench.blocks.force import Dynamics, Force, Motion, against, exported, rows
from hystbench.blocks.held import Hold
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.step import Sampling, Step, foretold, smooth_curve
from hystbench.record import FloatArray

INPUTS = ("position", "velocity")
NUMBERS = ("mass", "damping", "stiffness", "bias")
REACH = 4
"""Samples on either side that a rate is taken from, where they are there."""


def _differences(order: int) -> FloatArray:
    """Weigh samples for a derivative at one of them, per sample, shape (5, 9).

    The rows are for the first sample of a record, the second and so on: the last is
    for all others but the last four, for which these are turned round. Each is of the
    polynomial through the samples on both sides, five at least; the middle column is
    for the sample itself.
    """
    weights = np.zeros((REACH + 1, 2 * REACH + 1))
    for place, row in enumerate(weights):
        later = max(place, REACH - place)
        newest_first = derivative_at(place + later + 1, -later, order)
        row[REACH - place : REACH + later + 1] = newest_first[::-1]
    return weights


RATE, CURVATURE = _differences(1), _differences(2)


class Impedance(Dynamics, name="impedance", place="base"):
    """Force of a device that is moved: ``y = m q'' + c q' + k q + F(q, q') + bias``.

    F is the sum of the forces that follow it in the chain. The input is the position q,
    or the velocity, which is then integrated by the trapezoidal rule. Rates are
    taken from nine samples, to the eighth order in the sampling interval [2]_, and from
    fewer near the ends of a record (second differences of three make the force of a
    mass too small by 1 % at 18 samples a period, which looks like another force). Of
    a band-limited motion rates are those of the smooth curve through its samples. F is
    then taken eight times finer, as friction reverses between samples, and of F what
    passes a low-pass filter at half the sampling rate: what an instrument records that
    samples without aliasing. ``zero-order`` is as ``linear``.

    References
    ----------
    .. [1] P. Gardonio, M. J. Brennan, "On the origins and development of mobility and
       impedance methods in structural dynamics", Journal of Sound and Vibration 249
       (2002) 557-573.
    .. [2] B. Fornberg, "Generation of finite difference formulas on arbitrarily spaced
       grids", Mathematics of Computation 51 (1988) 699-706.
    """

    smooths = False
    one_of = NUMBERS[:3]

    mass: float = number("Y s^2/U", "m", default=0.0)
    damping: float = number("Y s/U", "c, of a viscous force", default=0.0)
    stiffness: float = number("Y/U", "k", default=0.0)
    bias: float = number("Y", "constant force", default=0.0)
    input: str = choice("what the input is", INPUTS, "position")

    @classmethod
    def columns(cls, moved: str, hold: Hold, z: FloatArray, dt: float) -> FloatArray:
        """Give the force of each number at one, with the others at zero.

        The force of any impedance is the sum of theirs, times its numbers.

        Parameters
        ----------
        moved : {"position", "velocity"}
            What the motion is.
        hold : {"zero-order", "linear", "band-limited"}
        z : ndarray, shape (n,)
            The motion.
        dt : float
            Sampling interval in seconds.

        Returns
        -------
        ndarray, shape (n, len(NUMBERS))
        """
        numbers: dict[str, float] = dict.fromkeys(NUMBERS, 0.0)
        motion = cls(**numbers, input=moved, hold=hold).motion(z, dt, ())
        ones = np.ones(len(z))
        return np.column_stack(
            [motion.acceleration, motion.velocity, motion.position, ones]
        )

    def outputs(
        self,
        signals: Signals,
        dts: Sequence[float],
        forces: tuple[Force, ...],
        others: OthersOnRecords,
        pieces: float = 1.0,
    ) -> list[Signals]:
        """Give the force of the motion that it is given, and those of others.

        What moves alike moves once, and meets forces that are the same once. The motion
        is given, so that ``pieces`` of steps change nothing.
        """
        of_records = [
            self._near(z, dt, forces, [(other, own[k]) for other, own in others])
            for k, (z, dt) in enumerate(zip(signals, dts, strict=True))
        ]
        hosts = (self, *(other.host for other, _ in others))
        return [
            tuple(map(host.given, own))
            for host, own in zip(hosts, zip(*of_records, strict=True), strict=True)
        ]

    def motion(
        self, z: FloatArray, dt: float, forces: tuple[Force, ...], pieces: float = 1.0
    ) -> Motion:
        """Give the motion of one record and the forces that it meets."""
        return self._near(z, dt, forces, ())[0]

    def _near(
        self, z: FloatArray, dt: float, forces: tuple[Force, ...], others: Others
    ) -> list[Motion]:
        """Give the motion of one record, and those of others."""
        path = np.ascontiguousarray(z, dtype=np.float64)
        still = Motion(*self._moved(path, dt), np.zeros(len(path)))
        alike = [other.forces for other, moved in others if moved is z]
        met = self._met(still, path, dt, {forces, *alike})
        found = [still._replace(force=met[forces])]
        for other, moved in others:
            if moved is z:
                found.append(still._replace(force=met[other.forces]))
            else:
                found.append(other.host.motion(moved, dt, other.forces))
        return found

    def given(self, motion: Motion) -> FloatArray:
        """Give the force of a motion."""
        return (
            self.mass * motion.acceleration
            + self.damping * motion.velocity
            + self.stiffness * motion.position
            + motion.force
            + self.bias
        )

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Take rates from the curve through the newest samples."""
        points, ahead, dt = sampling.curve_points, sampling.ahead, sampling.dt
        smooth, exact = self.holding == "band-limited", ahead >= AHEAD
        rate, curvature = (
            [about_sample(row, points, ahead) for row in rows]
            for rows in (RATE, CURVATURE)
        )
        way = np.zeros(points)
        way[ahead : ahead + 2] = 0.5
        told = "" if smooth and exact else foretold(RATE[-1], points, ahead)
        between = exact and smooth and bool(forces)
        if smooth:
            way = _way(points, ahead)
            for taken, order in ((rate, 1), (curvature, 2)):
                if exact:
                    taken += [taken[-1]] * (AHEAD + 1 - REACH)
                taken[-1] = derivative_at(points, -ahead, order)
            if not exact:
                told = f"{told}; {smooth_curve(points, ahead)}".removeprefix("; ")
                if forces:
                    told += "; takes its forces at samples, without a low-pass filter"
        taps = low_pass_taps() if between else np.ones(1)
        inside, memory = exported(rows(forces))
        constants = {
            **self.constants(*NUMBERS),
            "velocity": int(self.input == "velocity"),
            "points": points,
            "ahead": ahead,
            "last": len(rate) - 1,
            "rate": np.ravel(rate) / dt,
            "curvature": np.ravel(curvature) / dt**2,
            "way": way * dt,
            "fine": SHORT_STEPS if between else 0,
            "dt": dt,
            "width": len(taps),
            "taps": taps,
            **inside,
        }
        states = {
            "place": 2,
            "between": 2,
            "memory": memory,
            "filtered": 1 + len(taps),
            "history": 1 + points,
        }
        return Step(
            "impedance",
            constants,
            states,
            gains=AHEAD if smooth else REACH,
            rates=REACH,
            differs=told,
        )

    def _met(
        self, motion: Motion, z: FloatArray, dt: float, every: Set[tuple[Force, ...]]
    ) -> dict[tuple[Force, ...], FloatArray]:
        """Give the sum of each of some forces along a motion, that of an input."""
        found = {forces: np.zeros(len(z)) for forces in every}
        acting = [forces for forces in every if forces]
        curved = self._is_curve(z)
        if acting and curved:
            fine = self._between(z, motion.position, dt)
        for forces in acting:
            if curved:
                found[forces] = coarser(against(forces, *fine, dt / SHORT_STEPS))
            else:
                found[forces] = against(forces, motion.position, motion.velocity, dt)
        return found

    def _is_curve(self, z: FloatArray) -> bool:
        return self.holding == "band-limited" and len(z) >= 3

    def _between(
        self, z: FloatArray, q: FloatArray, dt: float
    ) -> tuple[FloatArray, FloatArray]:
        """Give position and velocity ``SHORT_STEPS`` times finer.

        The velocity takes straight lines: the mean one of an interval is that in the
        middle of it. A device that stops between two samples rests soon after; the
        band-limited curve would go on to and fro, and friction with it.
        """
        samples = np.arange(len(z))
        fine = np.arange((len(z) - 1) * SHORT_STEPS + 1) / SHORT_STEPS
        if self.input == "velocity":
            velocity = np.interp(fine, samples, z)
        else:
            velocity = np.interp(fine, samples[:-1] + 0.5, np.diff(z) / dt)
        steps = (velocity[1:] + velocity[:-1]) / 2 * (dt / SHORT_STEPS)
        return np.append(q[0], q[0] + np.cumsum(steps)), velocity

    def _moved(
        self, z: FloatArray, dt: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Give position, velocity and acceleration."""
        if self._is_curve(z):
            return self._along_curve(z, dt)
        rate = _weighed(z, RATE, 1) / dt
        if self.input == "position":
            return z, rate, _weighed(z, CURVATURE, 2) / dt**2
        way = np.cumsum((z[1:] + z[:-1]) / 2 * dt)
        return np.concatenate([np.zeros(min(len(z), 1)), way]), z.copy(), rate

    def _along_curve(
        self, z: FloatArray, dt: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Give position, velocity and acceleration of a band-limited motion."""
        way, rate, curvature = weighed(z, _of_curve())
        # The curve is turned about its ends: its derivatives have a kink there.
        first, last = slice(AHEAD + 1), slice(-AHEAD, None)
        for found, table, order in ((rate, RATE, 1), (curvature, CURVATURE, 2)):
            found[first] = _weighed(z[: AHEAD + 1 + REACH], table, order)[first]
            found[last] = _weighed(z[-AHEAD - REACH :], table, order)[last]
            found /= dt**order
        if self.input == "position":
            return z, rate, curvature
        way[0] = 0.0
        return np.cumsum(way * dt), z.copy(), rate


def _way(points: int, ahead: int) -> FloatArray:
    """Weights of the samples for the curve's integral over an interval, per sample."""
    return through_samples(points, lambda m: (-1.0) ** m / (m + 1), -ahead)


@lru_cache(maxsize=1)
def _of_curve() -> FloatArray:
    """Weights for the curve's integral over an interval, and its first derivatives."""
    derivatives = (derivative_at(POINTS, -AHEAD, order) for order in (1, 2))
    return np.array([_way(POINTS, AHEAD), *derivatives])


def _weighed(x: FloatArray, rows: FloatArray, order: int) -> FloatArray:
    """Weigh every sample and its neighbours for a derivative, per sample."""
    if len(x) < rows.shape[1]:
        for _ in range(order):
            x = np.gradient(x) if len(x) > 1 else np.zeros(len(x))
        return x
    found = np.empty(len(x))
    found[REACH:-REACH] = np.correlate(x, rows[-1], mode="valid")
    back, sign = x[::-1], (-1.0) ** order
    for place, row in enumerate(rows[:-1]):
        own = row[REACH - place :]
        found[place] = own @ x[: len(own)]
        found[-1 - place] = sign * (own @ back[: len(own)])
    return found

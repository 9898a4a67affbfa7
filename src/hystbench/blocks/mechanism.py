"""Block ``mechanism``: one coordinate whose forces act inside the dynamics."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import OthersOnRecords, Signals
from hystbench.blocks.curve import held_lines
from hystbench.blocks.force import Driven, Dynamics, Force, Motion, exported, rows
from hystbench.blocks.parameter import TINY, choice, number
from hystbench.blocks.starts import PASTS, STARTS, path_from
from hystbench.blocks.state_space import after_interval
from hystbench.blocks.step import Sampling, Step, lines_of
from hystbench.errors import InputError
from hystbench.record import FloatArray

OUTPUTS = ("position", "velocity", "acceleration", "force")
PHASE = 0.05
"""Largest angle, in radians, by which the linear coordinate turns in one step.

Steps miss a thousandth of the motion of a mode that hardens threefold.
"""
MOST = 40
"""Steps of an interval, at most: the linear part is exact however fast it is."""
CONTACT = 10
"""Steps of an interval that a stiff contact may ask for: it is stable without."""


class Mechanism(Dynamics, name="mechanism", place="base"):
    """A coordinate q of a machine: ``m q'' + c q' + k q + F(q, q') = gain z + bias``.

    F is the sum of the forces that follow it in the chain; without one it is linear. A
    free mass has a stiffness of zero. The output is the motion, or the force on the
    mount, ``c q' + k q + F``.

    The linear part is exact over a step, in which the forces count with their mean over
    the way, which does their exact work (a discrete gradient): of second order, and
    stable however stiff they are. A step in which the motion turns back is taken in
    eighths where a force turns with it. A band-limited input is taken as straight lines
    on a grid twice as fine. With ``start: settled`` it begins where the springs balance
    the first value; friction holds nothing there yet. A free mass has no such place:
    where the output does not show its place, what was before begins at rest.

    References
    ----------
    .. [1] O. Gonzalez, "Time integration and discrete Hamiltonian systems", Journal of
       Nonlinear Science 6 (1996) 449-467.
    """

    reference = "Gonzalez, J. Nonlinear Sci. 6 (1996)"

    mass: float = number("U s^2/Q", "m; Q is the unit of the coordinate", TINY)
    damping: float = number("U s/Q", "c, of a viscous force", 0.0)
    stiffness: float = number("U/Q", "k; zero for a free mass", 0.0)
    gain: float = number("-", "of what drives it", default=1.0)
    bias: float = number("U", "constant force beside what drives it", default=0.0)
    output: str = choice("what the output is", OUTPUTS, "position")
    blend: float = number(
        "s or 1/s",
        "share of the velocity in the output; of the acceleration, where the output is "
        "the velocity",
        default=0.0,
    )
    start: str = choice("state before the first sample", STARTS, "rest")
    start_position: float = number("Q", "q at the first sample", default=0.0)
    start_velocity: float = number("Q/s", "q' at the first sample", default=0.0)

    def check(self) -> None:
        """Refuse a start from balance where there is none."""
        if self.stiffness == 0.0 and self.start not in free_starts(self.output):
            raise InputError(
                f"start: {self.start}; expected "
                f"{' or '.join(free_starts(self.output))}, as without a stiffness "
                "there is no place of balance"
            )

    def given(self, motion: Motion) -> FloatArray:
        """Give the output of a motion, which may have run away."""
        with np.errstate(over="ignore", invalid="ignore"):
            if self.output == "force":
                spring = self.stiffness * motion.position + motion.force
                return spring + (self.damping + self.blend) * motion.velocity
            if self.output == "position":
                return motion.position + self.blend * motion.velocity
            if self.output == "velocity":
                return motion.velocity + self.blend * motion.acceleration
            return motion.acceleration + self.blend * motion.velocity

    def motions(
        self,
        signals: Signals,
        dts: Sequence[float],
        forces: tuple[Force, ...],
        others: OthersOnRecords,
        pieces: float = 1.0,
    ) -> list[list[Motion]]:
        """Compute how the coordinate moves, and how others with numbers near do.

        Each step of those is the tangent of this one's: right for small differences.
        Records of one sampling interval take one call of the kernel.
        """
        every = (Driven(self, forces, pieces), *(other for other, _ in others))
        given = (signals, *(own for _, own in others))
        alike: dict[tuple[float, int], list[int]] = {}
        for k, (z, dt) in enumerate(zip(signals, dts, strict=True)):
            alike.setdefault((dt, min(len(z), 3)), []).append(k)
        found: list[dict[int, Motion]] = [{} for _ in every]
        for (dt, _), places in alike.items():
            drives = [[own[k] for k in places] for own in given]
            for own, moves in zip(found, self._moved(every, drives, dt), strict=True):
                own.update(zip(places, moves, strict=True))
        return [[own[k] for k in range(len(signals))] for own in found]

    def _moved(
        self, every: Sequence[Driven], drives: Sequence[Signals], dt: float
    ) -> list[list[Motion]]:
        """Move near motions through records, which have three samples or as many."""
        first, signals = every[0], drives[0]
        hosts: list[Any] = [each.host for each in every]
        if not len(signals[0]):
            return [[Motion(*[z] * 4) for z in signals] for _ in hosts]
        numbers = np.array([rows(each.forces) for each in every])
        holding = self.holding
        quick = holding == "band-limited" and first.forces and first.pieces < 1
        if quick and self._parts(dt, first.forces, first.pieces) == 1:
            holding = "linear"  # finer lines would be shorter than a step
        driven = _Corners.of(signals, self.start, holding)
        step, ends = dt / driven.fine, np.cumsum(driven.lengths)
        parts = self._parts(step, first.forces, first.pieces)
        gain, bias, mass, damping, stiffness = np.array(
            [[x.gain, x.bias, x.mass, x.damping, x.stiffness] for x in hosts]
        ).T[..., None]
        q, v, force = np.zeros((3, len(hosts), ends[-1]))
        p = gain * driven.values + bias
        begins = ends - driven.lengths
        for k, host in enumerate(hosts):
            own = driven
            if any(x is not z for x, z in zip(drives[k], signals, strict=True)):
                own = _Corners.of(drives[k], self.start, holding)
                p[k] = host.gain * own.values + host.bias
            q[k, begins], v[k, begins] = host.start_position, host.start_velocity
            if self.start != "rest" and host.stiffness > 0.0:
                rested = host.gain * np.array(own.before) + host.bias
                q[k, begins] += [host._balance(z, numbers[k]) for z in rested]
        kernels.call(
            "hb_mechanism",
            ends[-1],
            len(ends),
            ends.ctypes.data,
            len(every) - 1,
            parts,
            step,
            float(holding != "zero-order"),
            step_weights(tuple(x.linear for x in hosts), step / parts),
            numbers.shape[1],
            numbers,
            np.empty(numbers.shape[:2]),
            p,
            q,
            v,
            force,
        )
        with np.errstate(over="ignore", invalid="ignore"):  # it may have run away
            curved = (p - damping * v - stiffness * q - force) / mass
        shown = [
            slice(end - (len(z) - 1) * driven.fine - 1, end, driven.fine)
            for z, end in zip(signals, ends.tolist(), strict=True)
        ]
        return [
            [Motion(*(x[k, own] for x in (q, v, curved, force))) for own in shown]
            for k in range(len(hosts))
        ]

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Move the coordinate over the interval that has passed."""
        lines = lines_of(self.holding, sampling)
        line = sampling.dt / lines.segments
        parts = self._parts(line, forces)
        balanced = 0.0 if self.start == "rest" else self.stiffness
        inside, memory = exported(forces)
        constants = {
            "gain": self.gain,
            "bias": self.bias,
            **lines.constants,
            "parts": parts,
            "h": line / parts,
            "step": step_weights((self.linear,), line / parts).ravel(),
            "shown": self._shown(),
            "start": np.array([self.start_position, self.start_velocity, balanced]),
            **inside,
        }
        states = {"motion": 2, "memory": memory, **lines.states}
        past = PASTS.get(self.start, "")
        return Step("mechanism", constants, states, past=past, **lines.told)

    def _shown(self) -> FloatArray:
        """Weights of q, q', the forces inside and the driving force in the output."""
        spring = np.array([self.stiffness, self.damping, 1.0, 0.0])
        acceleration = (np.array([0.0, 0.0, 0.0, 1.0]) - spring) / self.mass
        position, velocity = np.eye(4)[:2]
        weights: dict[str, FloatArray] = {
            "position": position + self.blend * velocity,
            "velocity": velocity + self.blend * acceleration,
            "acceleration": acceleration + self.blend * velocity,
            "force": spring + self.blend * velocity,
        }
        return weights[self.output]

    def _balance(self, p: float, numbers: FloatArray) -> float:
        """Find where the springs hold a force, next to where the linear one does."""
        q, memory = np.zeros(1), np.zeros(len(numbers))
        kernels.call("hb_settle", self.stiffness, p, len(numbers), numbers, memory, q)
        return float(q[0])

    def _parts(self, dt: float, forces: tuple[Force, ...], pieces: float = 1.0) -> int:
        """Steps of an interval: one without forces, as the linear part is exact.

        With forces they are short for the linear coordinate, as far as it swings no
        faster than half the sampling rate, and for a contact. Of a
        damped coordinate the slow pole counts: what dies out fast is exact.
        """
        if not forces:
            return 1
        contact = max(item.stiffest for item in forces)
        linear, stiff = (
            self._rate(k) for k in (self.stiffness, self.stiffness + contact)
        )
        swings = min(max(linear, *(item.swings for item in forces)), pi / dt)
        smooth, met = (ceil(pieces * dt * rate / PHASE) for rate in (swings, stiff))
        return max(1, min(smooth, MOST), min(met, CONTACT))

    def _rate(self, stiffness: float) -> float:
        """Give the magnitude of the slower pole, in rad/s, for a stiffness."""
        natural, half = sqrt(stiffness / self.mass), 0.5 * self.damping / self.mass
        if half <= natural:
            return natural
        return natural * natural / (half + sqrt(half**2 - natural**2))

    @property
    def linear(self) -> tuple[float, float, float]:
        """Mass, damping and stiffness."""
        return self.mass, self.damping, self.stiffness


class _Corners(NamedTuple):
    """What drives a coordinate: corners of straight lines, a record behind another."""

    values: FloatArray
    lengths: list[int]
    """Corners of each record, with what was before it."""
    before: list[float]
    """What was for ever before that."""
    fine: int
    """Lines between two samples."""

    @classmethod
    def of(cls, signals: Signals, start: str, holding: str) -> _Corners:
        """Give those of signals from a start."""
        begun = [path_from(z, start) for z in signals]
        held = [held_lines(path, holding) for path, _ in begun]
        corners = [lines for lines, _ in held]
        before = [first for _, first in begun]
        return cls(np.concatenate(corners), [*map(len, corners)], before, held[0][1])


def free_starts(output: str) -> tuple[str, ...]:
    """Give the starts that a mass without a spring may have.

    It forgets its speed and never its place. So it may have moved before the record
    only where the output does not show the place.
    """
    return ("rest", *PASTS) if output in ("velocity", "acceleration") else ("rest",)


@lru_cache(maxsize=256)
def step_weights(
    coordinates: tuple[tuple[float, float, float], ...], dt: float
) -> FloatArray:
    """Give weights of q, q' and of the driving force at both ends of a step.

    Of masses on springs without forces inside. They are kept, as a fit simulates many
    records with the same linear part.

    Parameters
    ----------
    coordinates : tuple of (float, float, float)
        Mass, damping and stiffness of each.
    dt : float
        The step in seconds.

    Returns
    -------
    ndarray, shape (coordinates, 2, 2, 4)
        Of a step, and of an eighth of it; not to be written to.
    """
    every = {each: k for k, each in enumerate(dict.fromkeys(coordinates))}
    mass, damping, stiffness = np.array(list(every)).T
    a, b = np.zeros((len(every), 2, 2)), np.zeros((len(every), 2))
    a[:, 0, 1], a[:, 1, 0], a[:, 1, 1] = 1.0, -stiffness / mass, -damping / mass
    b[:, 1] = 1.0 / mass
    steps = np.array([dt, dt / 8])[:, None, None]
    weights = after_interval(a * steps[..., None], b * steps)
    weights[..., 2] -= weights[..., 3]
    found = weights[:, [every[each] for each in coordinates]].swapaxes(0, 1)
    found = np.ascontiguousarray(found)
    found.setflags(write=False)
    return found

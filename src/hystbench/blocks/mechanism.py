"""Block ``mechanism``: one coordinate whose forces act inside the dynamics."""

from functools import lru_cache
from math import ceil, pi, sqrt
from typing import Any

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import Others
from hystbench.blocks.curve import held_lines
from hystbench.blocks.force import Driven, Dynamics, Force, Motion, exported, rows
from hystbench.blocks.parameter import TINY, choice, number
from hystbench.blocks.starts import PASTS, STARTS, path_from
from hystbench.blocks.state_space import StateSpace, discretise
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
        z: FloatArray,
        dt: float,
        forces: tuple[Force, ...],
        others: Others,
        pieces: float = 1.0,
    ) -> list[Motion]:
        """Compute how the coordinate moves, and how others with numbers near do.

        Each step of those is the tangent of this one's: right for small differences.
        """
        every = (Driven(self, forces), *(other for other, _ in others))
        hosts: list[Any] = [each.host for each in every]
        signals = (z, *(own for _, own in others))
        numbers = np.array([rows(each.forces) for each in every])
        path, before = path_from(z, self.start)
        holding = self.holding
        quick = holding == "band-limited" and forces and pieces < 1
        if quick and self._parts(dt, forces, pieces) == 1:
            holding = "linear"  # finer lines would be shorter than a step
        lines, fine = held_lines(path, holding)
        n, step = len(lines), dt / fine
        parts = self._parts(step, forces, pieces)
        gain, bias, mass, damping, stiffness = np.array(
            [[x.gain, x.bias, x.mass, x.damping, x.stiffness] for x in hosts]
        ).T[..., None]
        q, v, force = np.zeros((3, len(hosts), n))
        p = gain * lines + bias
        for k, host in enumerate(hosts if n else ()):
            first = before
            if signals[k] is not z:
                own, first = path_from(signals[k], self.start)
                p[k] = host.gain * held_lines(own, holding)[0] + host.bias
            q[k, 0], v[k, 0] = host.start_position, host.start_velocity
            if self.start != "rest" and host.stiffness > 0.0:
                q[k, 0] += host._balance(host.gain * first + host.bias, numbers[k])
        if n:
            kernels.call(
                "hb_mechanism",
                n,
                len(others),
                parts,
                step,
                float(holding != "zero-order"),
                np.array([host._steps(step / parts) for host in hosts]),
                numbers.shape[1],
                numbers,
                np.zeros(numbers.shape[:2]),
                p,
                q,
                v,
                force,
            )
        with np.errstate(over="ignore", invalid="ignore"):  # it may have run away
            curved = (p - damping * v - stiffness * q - force) / mass
        shown = slice((len(path) - len(z)) * fine, None, fine)
        moves = (x[:, shown] for x in (q, v, curved, force))
        return [Motion(*each) for each in zip(*moves, strict=True)]

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
            "step": self._steps(line / parts).ravel(),
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

    def _steps(self, dt: float) -> FloatArray:
        """Weights of a step, and of an eighth of it."""
        return step_weights(self.mass, self.damping, self.stiffness, dt)


def free_starts(output: str) -> tuple[str, ...]:
    """Give the starts that a mass without a spring may have.

    It forgets its speed and never its place. So it may have moved before the record
    only where the output does not show the place.
    """
    return ("rest", *PASTS) if output in ("velocity", "acceleration") else ("rest",)


@lru_cache(maxsize=256)
def step_weights(
    mass: float, damping: float, stiffness: float, dt: float
) -> FloatArray:
    """Give weights of q, q' and of the driving force at both ends of a step.

    Of a mass on a spring without forces inside. They are kept, as a fit simulates many
    records with the same linear part.

    Returns
    -------
    ndarray, shape (2, 2, 4)
        Of a step, and of an eighth of it; not to be written to.
    """
    system = StateSpace(
        np.array([[0.0, 1.0], [-stiffness / mass, -damping / mass]]),
        np.array([0.0, 1.0 / mass]),
        np.array([1.0, 0.0]),
        0.0,
    )
    weights = np.array(
        [
            np.column_stack([phi, now, following])
            for phi, now, following in (
                discretise(system, step, "linear") for step in (dt, dt / 8)
            )
        ]
    )
    weights.setflags(write=False)
    return weights

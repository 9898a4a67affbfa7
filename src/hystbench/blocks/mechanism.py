"""Block ``mechanism``: one coordinate whose forces act inside the dynamics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt

import numpy as np

from hystbench import kernels
from hystbench.blocks.attached import Signals
from hystbench.blocks.force import Driven, Force, exported, less_stiff, rows
from hystbench.blocks.forced import ForcedDynamics, step_weights, tables_of
from hystbench.blocks.parameter import TINY, choice, number
from hystbench.blocks.starts import PASTS
from hystbench.blocks.step import Sampling, Step, lines_of
from hystbench.errors import InputError
from hystbench.record import FloatArray

OUTPUTS = ("position", "velocity", "acceleration", "force")


class Mechanism(ForcedDynamics, name="mechanism", place="base"):
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

    def _moved(
        self,
        every: Sequence[Driven],
        drives: Sequence[Signals],
        dt: float,
        of_first: FloatArray | None = None,
    ) -> list[Signals]:
        """Move near motions through records, which have three samples or as many."""
        slope = slope_of(every[0].forces)
        stiffer = [_stiffer(each, slope) for each in every]
        hosts, laws = [own for own, _ in stiffer], np.array([x for _, x in stiffer])
        driven = hosts[0].lines(every[0], drives, dt)
        gain, bias = np.array([[x.gain, x.bias] for x in hosts]).T[..., None]
        starts = np.empty((len(hosts), len(driven.ends), 2))
        for k, host in enumerate(hosts):
            starts[k] = host.start_position, host.start_velocity
            if self.start != "rest" and host.stiffness > 0.0:
                rested = host.gain * driven.before[k] + host.bias
                starts[k, :, 0] += [host._balance(z, laws[k]) for z in rested]
        one = np.ones((len(hosts), 1))
        modes = [(host.linear,) for host in hosts]
        tables = tables_of(modes, one, one, driven.step / driven.parts)
        shown = np.array([host.weights() for host in hosts])
        asked = shown[:1] if of_first is None else of_first
        p = gain * driven.values + bias
        return driven.move(p, tables, laws, starts, shown, asked)

    def driven_step(self, sampling: Sampling, forces: tuple[Force, ...]) -> Step:
        """Move the coordinate over the interval that has passed."""
        stiffer, numbers = _stiffer(Driven(self, forces), slope_of(forces))
        lines = lines_of(self.holding, sampling)
        line = sampling.dt / lines.segments
        parts = stiffer.parts(line, forces)
        balanced = 0.0 if self.start == "rest" else stiffer.stiffness
        inside, memory = exported(numbers)
        constants = {
            "gain": self.gain,
            "bias": self.bias,
            **lines.constants,
            "parts": parts,
            "h": line / parts,
            "step": step_weights((stiffer.linear,), line / parts).ravel(),
            "shown": stiffer.weights(),
            "start": np.array([self.start_position, self.start_velocity, balanced]),
            **inside,
        }
        states = {"motion": 2, "memory": memory, **lines.states}
        past = PASTS.get(self.start, "")
        return Step("mechanism", constants, states, past=past, **lines.told)

    def weights(self) -> FloatArray:
        """Give the weights of q, q', the forces inside and the driving force."""
        position, velocity, acceleration, force = self._of_motion(())
        spring = np.array([self.stiffness, self.damping, 0.0, 0.0])
        shown: dict[str, FloatArray] = {
            "position": position + self.blend * velocity,
            "velocity": velocity + self.blend * acceleration,
            "acceleration": acceleration + self.blend * velocity,
            "force": spring + force + self.blend * velocity,
        }
        return shown[self.output]

    def _of_motion(self, forces: tuple[Force, ...]) -> FloatArray:
        """Give the weights of position, velocity, acceleration and forces."""
        slope = slope_of(forces)
        position, velocity, force, drive = np.eye(4)
        spring = (self.stiffness + slope) * position + self.damping * velocity
        acceleration = (drive - force - spring) / self.mass
        return np.array([position, velocity, acceleration, force + slope * position])

    def _balance(self, p: float, numbers: FloatArray) -> float:
        """Find where the springs hold a force, next to where the linear one does."""
        q, memory = np.zeros(1), np.zeros(len(numbers))
        kernels.call("hb_settle", self.stiffness, p, len(numbers), numbers, memory, q)
        return float(q[0])

    def rates(self, contact: float, shown: float) -> tuple[float, float]:
        """Give how fast it swings, in rad/s: alone, and in a contact of a stiffness.

        Of what is damped the slow pole counts: what dies out faster is exact.
        """
        return self._rate(self.stiffness), self._rate(self.stiffness + contact)

    @property
    def swings(self) -> bool:
        """Whether it is damped by less than the critical damping."""
        return self.damping**2 < 4.0 * self.mass * self.stiffness

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


def slope_of(forces: Sequence[Force]) -> float:
    """Give the stiffness that a spring may take over from smooth forces.

    Over a step the host's spring is exact, and a force is of second order.
    """
    return max(sum(item.slope for item in forces), 0.0)


def _stiffer(driven: Driven, slope: float) -> tuple[Mechanism, FloatArray]:
    """Give a mass that moves as before, with so much of its forces in its spring."""
    host, numbers = driven.host, rows(driven.forces)
    assert isinstance(host, Mechanism)  # noqa: S101  (for the type checker)
    if slope == 0.0:
        return host, numbers
    more = replace(host, stiffness=host.stiffness + slope)
    return more, less_stiff(numbers, slope)


def free_starts(output: str) -> tuple[str, ...]:
    """Give the starts that a mass without a spring may have.

    It forgets its speed and never its place. So it may have moved before the record
    only where the output does not show the place.
    """
    return ("rest", *PASTS) if output in ("velocity", "acceleration") else ("rest",)

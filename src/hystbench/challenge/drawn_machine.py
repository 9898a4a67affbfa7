"""One machine with its records: drawn, read, and held against its best linear model."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from hystbench.challenge.campaigns import (
    FAST_HZ,
    RecordCommand,
    filling,
    machine_records,
)
from hystbench.challenge.plant.kind import HiddenEffect, Reach, log_uniform
from hystbench.challenge.plant.machine import (
    FINE,
    MovingPart,
    PartMotion,
    Tank,
    decimated,
    fill,
    low_pass,
    move,
    resist,
)
from hystbench.record import Channel, FloatArray, Use

#: Samples behind a record's end, which the low-pass in front of the converter sees.
TAIL = 16
#: Steps a sample with which linear models are fitted.
COARSE = 8
#: Sampling rates of machines.
RATES_HZ = (100.0, 200.0, 500.0, 1000.0, 2000.0)
MOTIONS = ("position", "velocity", "acceleration")
#: Of a motion along a line, and of one that turns.
UNITS = {"position": "mm", "velocity": "mm/s", "acceleration": "mm/s^2", "force": "N"}
TURNING_UNITS = {
    "position": "rad",
    "velocity": "rad/s",
    "acceleration": "rad/s^2",
    "force": "N*m",
}

InputsAndOutputs = list[tuple[FloatArray, FloatArray]]
"""Input and output of each record; for a linear fit each output and that of the
model."""


@dataclass(frozen=True)
class Machine:
    """A linear machine and how it is driven."""

    family: str
    rate_hz: float
    """Sampling rate."""
    part: MovingPart | None
    """None of tanks."""
    tanks: tuple[Tank, ...]
    output: str
    """A motion, ``force`` or ``level``."""
    size: float
    """Factor to the records' unit: newtons, millimetres or, for tanks, volts."""
    gains: tuple[float, float]
    """Gains of a controller, where the records are its reference; zeros for none."""
    records: tuple[RecordCommand, ...]
    """Those to fit first."""

    @property
    def channels(self) -> tuple[Channel, Channel]:
        """Input and output by name and unit."""
        if self.part is None:
            return Channel("pump", "V"), Channel("level", "cm")
        units = TURNING_UNITS if self.family == "pendulum" else UNITS
        given = "position" if self.output == "force" else "force"
        return Channel(given, units[given]), Channel(self.output, units[self.output])

    @property
    def dt(self) -> float:
        """Step of the fine grid in seconds."""
        return 1.0 / (self.rate_hz * FINE)

    def command(self, item: RecordCommand) -> FloatArray:
        """Compute a record's command on the fine grid, in its unit."""
        return self.size * _on_fine_grid(item)

    def run(
        self, item: RecordCommand, hidden: Sequence[HiddenEffect], reach: Reach
    ) -> PartMotion:
        """Give force and motion under a record, on the fine grid."""
        part = self.with_forces(hidden, reach)
        if self.output == "force":
            position = self.command(item)
            velocity = np.gradient(position, self.dt)
            force = resist(part, position, self.dt)
            return PartMotion(force, position, velocity, np.gradient(velocity, self.dt))
        command = self.driven(item, hidden, reach)
        return move(part, command, self.dt, gains=self.gains)

    def driven(
        self, item: RecordCommand, hidden: Sequence[HiddenEffect], reach: Reach
    ) -> FloatArray:
        """Compute what a record's command becomes before it drives the machine."""
        command = self.command(item)
        for effect in hidden:
            if effect.kind.place == "before" and effect.of_form.curve:
                command = effect.of_form.curve(command, effect.parameters, reach)
        return command

    def with_forces(self, hidden: Sequence[HiddenEffect], reach: Reach) -> MovingPart:
        """Give the part with what is hidden inside it."""
        assert self.part is not None  # noqa: S101  (for the type checker)
        part = self.part
        for effect in hidden:
            if effect.of_form.numbers:
                part = replace(part, **effect.of_form.numbers(effect.parameters, reach))
        return part

    def read(
        self, hidden: Sequence[HiddenEffect], reach: Reach, use: Use
    ) -> InputsAndOutputs:
        """Give noise-free input and output of the records of a use at their samples."""
        chosen = [item for item in self.records if item.use == use]
        return [self._read(item, hidden, reach) for item in chosen]

    def _read(
        self, item: RecordCommand, hidden: Sequence[HiddenEffect], reach: Reach
    ) -> tuple[FloatArray, FloatArray]:
        u = self.command(item)
        if self.part is None:
            tanks = with_holes(self.tanks, hidden, reach)
            inflow = self.driven(item, hidden, reach)
            y = fill(tanks, inflow, self.dt)
        else:
            motion = self.run(item, hidden, reach)
            y = getattr(motion, self.output)
            # an effect before the machine is not seen in the recorded command
            u = motion.force if self.gains[0] else u
        for effect in hidden:
            if effect.kind.place == "behind" and effect.of_form.curve:
                y = effect.of_form.curve(y, effect.parameters, reach)
        return decimated(u)[: item.samples], decimated(y)[: item.samples]


@lru_cache(maxsize=16)
def _on_fine_grid(item: RecordCommand) -> FloatArray:
    """Compute a record's command, which a case asks for many times."""
    count = (item.samples + TAIL) * FINE
    return item(np.arange(count) / (FAST_HZ * FINE))


def with_holes(
    tanks: tuple[Tank, ...], hidden: Sequence[HiddenEffect], reach: Reach
) -> tuple[Tank, ...]:
    """Give the tanks with what is hidden in them.

    All bend their outflow; only the first has a rim or a seal.
    """
    out = list(tanks)
    for effect in hidden:
        if effect.of_form.numbers is None:  # a curve before or behind them
            continue
        numbers = effect.of_form.numbers(effect.parameters, reach)
        if "exponent" not in numbers:
            if "rim" in numbers and out[0].back:
                # behind an outlet against its level the last stands half as high
                numbers["rim"] *= 2.0
            out[0] = replace(out[0], **numbers)
        else:
            power, about = numbers["exponent"], numbers["about"]
            out = [
                replace(
                    tank,
                    exponent=power,
                    coefficient=tank.coefficient * about ** (1.0 - power),
                )
                for tank in out
            ]
    return tuple(out)


def reach_of(machine: Machine) -> Reach:
    """Look how far the linear machine goes on its fit records."""
    nothing = Reach(1.0, 1.0, 1.0, 1.0, 1.0)
    chosen = [item for item in machine.records if item.use == "fit"]
    if machine.part is None:
        most = max(float(np.max(y)) for _, y in machine.read((), nothing, "fit"))
        pumped = max(float(np.max(machine.command(item))) for item in chosen)
        settling = machine.tanks[0].area / machine.tanks[0].coefficient
        return Reach(most, most / settling, pumped, most, 1.0)
    motions = [machine.run(item, (), nothing) for item in chosen]
    reach, speed, most, read = (
        max(float(np.max(np.abs(getattr(motion, name)))) for motion in motions)
        for name in ("position", "velocity", "force", machine.output)
    )
    return Reach(reach, speed, most, read, machine.part.stiffness or most / reach)


def draw_machine(
    family: str, random: np.random.Generator, closed: bool | None = None
) -> Machine:
    """Draw a machine of a family, how it is driven and what is measured.

    Parameters
    ----------
    family : str
    random : numpy.random.Generator
    closed : bool, optional
        False for no controller; by default a coin of a mass tells.
    """
    between = partial(log_uniform, random)
    rate = float(random.choice(RATES_HZ))
    # samples a period of the middle frequency
    period = between(25.0, 60.0)
    middle = FAST_HZ / period
    w = 2.0 * np.pi * rate / period
    size, coin = between(0.3, 5.0), random.uniform()
    output = str(random.choice(MOTIONS))
    gains = (0.0, 0.0)
    if family in ("tank", "coupled-tanks"):
        count = 1 + int(random.uniform() < 0.5)
        coupled = float(family == "coupled-tanks")
        coefficient = between(0.5, 3.0)
        # it settles over two hundred to four hundred samples
        area = coefficient * between(60.0, 120.0) / rate
        tank = Tank(area, coefficient, back=coupled)
        tanks = (tank,) * (2 if coupled else count)
        records = filling(random, FAST_HZ / between(300.0, 600.0))
        return Machine(
            family, rate, None, tanks, "level", 10.0 * coefficient, gains, records
        )
    records = machine_records(random, middle)
    stiffness = between(0.5, 50.0)
    mass = stiffness / w**2
    part = MovingPart(mass, 2.0 * between(0.03, 0.3) * mass * w, stiffness)
    if family == "impedance":
        # stiff more than heavy: force is not all inertia
        part = replace(part, mass=mass * between(0.02, 0.2))
        part = replace(part, damping=between(0.1, 0.6) * stiffness / w)
        return Machine(family, rate, part, (), "force", size, gains, records)
    if family == "free-mass":
        part = replace(part, stiffness=0.0, damping=between(0.02, 0.3) * mass * w)
    controlled = coin < (0.6 if family == "free-mass" else 0.3)
    if controlled and closed is not False:
        gains = (2.0 * mass * w**2, 1.4 * mass * w)
    elif output == "position" and family == "free-mass":
        # without a controller its position runs away
        output = "velocity"
    machine = Machine(family, rate, part, (), output, 1.0, gains, records)
    wanted = between(0.5, 1.0) if family == "pendulum" else size
    return replace(machine, size=wanted / reach_of(machine).position)


def linear_parts(machine: Machine, signals: InputsAndOutputs) -> InputsAndOutputs:
    """Fit the same machine without any effect; give each record's model output.

    Parameters
    ----------
    machine : Machine
    signals : list of (input, output)
        At the samples, without noise.

    Returns
    -------
    list of (output, model's output)
        The model is the best of the machine's own equation in least squares, with an
        offset of its output, and hence what no effect could improve on.
    """
    if machine.output == "force":
        return _linear_impedance(machine, signals)
    from scipy.optimize import least_squares  # late: not needed for actuators

    inputs = [_between(u) for u, _ in signals]
    outputs = [y for _, y in signals]
    pooled = np.concatenate(outputs)
    centre = pooled.mean()

    def modelled(logs: FloatArray) -> list[FloatArray]:
        return [
            _simulated(machine, np.exp(logs), u)[: len(y)]
            for u, y in zip(inputs, outputs, strict=True)
        ]

    def solved(logs: FloatArray) -> tuple[FloatArray, FloatArray]:
        x = np.concatenate(modelled(logs))
        if not np.all(np.isfinite(x)):
            x = np.zeros(len(x))  # it runs away: such a step explains nothing
        design = np.stack([x, np.ones_like(x)], axis=1)
        return design, np.asarray(np.linalg.lstsq(design, pooled)[0])

    def left(logs: FloatArray) -> FloatArray:
        design, numbers = solved(logs)
        return np.asarray((design @ numbers - pooled) / np.std(pooled - centre))

    begun = np.log(_own_numbers(machine))
    found = least_squares(left, begun, diff_step=1e-4, max_nfev=30).x
    design, numbers = solved(found)
    ends = np.cumsum([len(y) for y in outputs])[:-1]
    return list(zip(outputs, np.split(design @ numbers, ends), strict=True))


def _own_numbers(machine: Machine) -> list[float]:
    """Numbers that a linear fit searches; the gain is solved for."""
    if machine.part is None:
        return [tank.area / tank.coefficient for tank in machine.tanks]
    part = machine.part
    numbers = [part.damping / part.mass]
    return numbers + ([part.stiffness / part.mass] if part.stiffness else [])


def _simulated(machine: Machine, values: FloatArray, u: FloatArray) -> FloatArray:
    dt = machine.dt * FINE / COARSE
    if machine.part is None:
        tanks = tuple(
            Tank(float(value), 1.0, back=tank.back)
            for value, tank in zip(values, machine.tanks, strict=True)
        )
        return decimated(fill(tanks, u, dt), COARSE)
    part = MovingPart(
        1.0, float(values[0]), float(values[1]) if len(values) > 1 else 0.0
    )
    return decimated(getattr(move(part, u, dt), machine.output), COARSE)


def _between(u: FloatArray) -> FloatArray:
    """Put a record's input on the grid on which linear models are fitted."""
    from scipy.signal import resample_poly  # late: not needed for actuators

    padded = np.concatenate([u, np.full(TAIL, u[-1])])
    return np.asarray(
        resample_poly(padded, COARSE, 1, window=low_pass(COARSE), padtype="line")
    )


def _linear_impedance(machine: Machine, signals: InputsAndOutputs) -> InputsAndOutputs:
    columns = []
    for u, _ in signals:
        fine = _between(u)
        parts = [MovingPart(1.0), MovingPart(0.0, 1.0), MovingPart(0.0, 0.0, 1.0)]
        forces = [resist(p, fine, machine.dt * FINE / COARSE) for p in parts]
        moved = [decimated(force, COARSE)[: len(u)] for force in forces]
        columns.append(np.stack([*moved, np.ones(len(u))], axis=1))
    design, pooled = np.concatenate(columns), np.concatenate([y for _, y in signals])
    sizes = np.maximum(np.sqrt(np.mean(design**2, axis=0)), 1e-300)
    numbers = np.linalg.lstsq(design / sizes, pooled, rcond=1e-10)[0] / sizes
    return [(y, part @ numbers) for part, (_, y) in zip(columns, signals, strict=True)]

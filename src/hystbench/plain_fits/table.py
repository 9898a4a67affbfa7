"""Where each effect acts, and what of it is searched, between which bounds."""

from dataclasses import dataclass

import numpy as np

from hystbench.blocks.attached import AttachedBlock
from hystbench.plain_fits.task import Task

#: Frequencies that a mode is looked for at, over the records' band.
MODES = 60


@dataclass(frozen=True)
class Searched:
    """One parameter of a search: bounds, starts, and whether its sign is known."""

    low: float
    high: float
    starts: tuple[float, ...]

    @property
    def logarithmic(self) -> bool:
        """Whether the search goes by the logarithm."""
        return self.low > 0.0

    def inner(self, value: float) -> float:
        """Give what the search varies."""
        return float(np.log(value) if self.logarithmic else value / self.high)

    def outer(self, varied: float) -> float:
        """Give the parameter's value, within its bounds."""
        value = np.exp(varied) if self.logarithmic else varied * self.high
        return float(np.clip(value, self.low, self.high))


# Where an effect acts: before the chain, just behind the hysteresis, or at its end.
PLACE_IN_CHAIN = {
    "input-delay": "start",
    "drive-lag": "start",
    "eddy-diffusion": "start",
    "drive-saturation": "start",
    "slew-limit": "start",
    "dead-zone": "start",
    "asymmetry": "material",
    "saturation": "material",
    "rate-dependent-hysteresis": "material",
    "resonance": "end",
    "stiffness-hardening": "mode",
    "friction": "end",
    "backlash": "end",
    "creep": "end",
    "thermal-drift": "end",
    "sensor-lag": "end",
    "sensor-nonlinearity": "end",
    "calibration-error": "end",
}


def place_of(task: Task, effect: str) -> int | None:
    """Give the place of an effect's block in the chain; None where it has none."""
    where, end = PLACE_IN_CHAIN[effect], len(task.model.chain)
    if where == "material":
        if task.hysteresis is None:
            return None if effect == "rate-dependent-hysteresis" else next_to(task, 0)
        return next_to(task, task.hysteresis)
    if where == "mode":
        names = [block.name for block in task.model.chain]
        return names.index("resonance") if "resonance" in names else end
    return 0 if where == "start" else end


def searched_of(task: Task, effect: str) -> dict[str, Searched]:
    """Bounds and starts: from the records alone, and what physics allows."""
    step, span, reach, size = task.step, task.span, task.reach, task.size
    quick = Searched(step / 10, 100 * step, (step, 10 * step))
    small = Searched(-0.3 / size, 0.3 / size, (0.01 / size,))
    slow = Searched(span / 200, span, (span / 50, span / 8))
    share = Searched(-1.0, 1.0, (0.02,))
    two_decades = np.geomspace(0.0045 / step, 0.45 / step, MODES).tolist()
    mode = {
        "frequency_hz": Searched(2.0 / span, 0.45 / step, tuple(two_decades)),
        "damping_ratio": Searched(1e-3, 0.3, (0.05,)),
        "participation": Searched(-1.0, 1.0, (0.1,)),
    }
    table: dict[str, dict[str, Searched]] = {
        "input-delay": {"delay_s": quick},
        "drive-lag": {"time_constant_s": quick},
        "eddy-diffusion": {"time_constant_s": quick},
        "drive-saturation": {"limit": Searched(reach / 10, reach, (0.8 * reach,))},
        "slew-limit": {"rate": Searched(task.rate / 100, task.rate, (task.rate / 3,))},
        "dead-zone": {"half_width": Searched(reach / 1e3, reach / 3, (reach / 30,))},
        "asymmetry": {"coefficient": small},
        "saturation": {"level": Searched(size / 2, 50 * size, (2 * size,))},
        "rate-dependent-hysteresis": {
            "coefficient": Searched(
                1e-4 * task.rate**-0.75,
                10.0 * task.rate**-0.75,
                (0.01 * task.rate**-0.75, 0.1 * task.rate**-0.75),
            ),
            "exponent": Searched(0.3, 1.5, (0.75,)),
        },
        "resonance": mode,
        "stiffness-hardening": {
            "coefficient": Searched(
                -1.0 / size**2, 3.0 / size**2, (1e-3 / size**2, 0.1 / size**2)
            )
        },
        "friction": {
            "coulomb": Searched(-0.2 * size, 0.2 * size, (0.01 * size,)),
            "velocity_scale": Searched(task.rate / 1e4, task.rate, (task.rate / 100,)),
        },
        "backlash": {"half_width": Searched(size / 1e4, size / 5, (size / 100,))},
        "creep": {"magnitudes": share, "time_constants_s": slow},
        "thermal-drift": {
            "coefficient": Searched(-size / reach**2, size / reach**2, (1e-2 * size,)),
            "time_constant_s": slow,
        },
        "sensor-lag": {"time_constant_s": quick},
        "sensor-nonlinearity": {
            "quadratic": small,
            "cubic": Searched(-0.3 / size**2, 0.3 / size**2, (1e-3 / size**2,)),
        },
        "calibration-error": {
            "gain": Searched(0.5, 1.5, (1.0,)),
            "offset": Searched(-0.2 * size, 0.2 * size, (0.0,)),
        },
    }
    has_mode = any(block.name == "resonance" for block in task.model.chain)
    if effect == "stiffness-hardening" and not has_mode:
        table[effect] |= mode
    return table[effect]


#: The parameter that the effect is proportional to.
PROPORTIONAL_TO = {
    "resonance": "participation",
    "friction": "coulomb",
    "creep": "magnitudes",
    "thermal-drift": "coefficient",
}


def next_to(task: Task, place: int) -> int:
    """Give the place behind a block and all that is attached to it."""
    chain = task.model.chain
    behind = place + 1
    while behind < len(chain) and isinstance(chain[behind], AttachedBlock):
        behind += 1
    return behind

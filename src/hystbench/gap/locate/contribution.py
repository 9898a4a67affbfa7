"""What a named effect adds to the output, and the view in which it shows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hystbench.gap.locate.view import Kind
from hystbench.record import FloatArray

VIEWS: Mapping[str, Kind] = {
    "asymmetry": "amplitude",
    "backlash": "branch",
    "calibration-error": "amplitude",
    "creep": "slow-time",
    "dead-zone": "amplitude",
    "drag": "rate",
    "drift": "unexplained",
    "drive-lag": "frequency",
    "drive-saturation": "amplitude",
    "eddy-diffusion": "frequency",
    "friction": "branch",
    "gravity": "amplitude",
    "hysteresis": "branch",
    "hysteresis-shape": "branch",
    "hysteretic-force": "branch",
    "input-delay": "delay",
    "mains-pickup": "unexplained",
    "outflow": "amplitude",
    "overflow": "amplitude",
    "rate-dependent-hysteresis": "rate",
    "resonance": "frequency",
    "saturation": "amplitude",
    "sensor-lag": "frequency",
    "sensor-nonlinearity": "amplitude",
    "slew-limit": "rate",
    "slider-with-gap": "branch",
    "stiffness-hardening": "frequency",
    "stop": "amplitude",
    "thermal-drift": "slow-time",
}
"""By effect, what an engineer looks at first."""


@dataclass(frozen=True)
class Contribution:
    """What a named effect adds to the output of the base on each record.

    Parameters
    ----------
    effect : str
    added : tuple of ndarray, shape (n,)
        In the unit of the output, a record each.
    freedom : float
        Numbers that were fitted for it.
    """

    effect: str
    added: tuple[FloatArray, ...]
    freedom: float = 1.0

    @property
    def view(self) -> Kind | None:
        """Where it shows; None of an effect that the table does not know."""
        return VIEWS.get(self.effect)

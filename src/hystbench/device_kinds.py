"""Kinds of devices, and what causes each effect in each of them.

One table. An effect that nothing causes in a kind of device cannot be there: a search
leaves it out. The causes that are left say what the effect is called there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, get_args

DeviceKind = Literal[
    "magnetostrictive",
    "piezoelectric",
    "electromechanical",
    "hydraulic",
    "thermal",
    "electronic",
    "mechanical",
]

DEVICE_KINDS: tuple[DeviceKind, ...] = get_args(DeviceKind)

_MAGNETIC: Sequence[DeviceKind] = ("magnetostrictive", "electromechanical")
_ELECTRIC: Sequence[DeviceKind] = (*_MAGNETIC, "piezoelectric", "electronic")
_MOVING: Sequence[DeviceKind] = (*_MAGNETIC, "piezoelectric", "hydraulic", "mechanical")

#: By effect, then by cause: the kinds of devices that it acts in.
CAUSES: Mapping[str, Mapping[str, Sequence[DeviceKind]]] = {
    "outflow": {
        "a free outlet, whose flow goes with the root of the level": ("hydraulic",),
        "radiation, or heat that is carried off by its own draught": ("thermal",),
    },
    "overflow": {
        "a full tank": ("hydraulic",),
        "a safety valve, or a change of phase": ("hydraulic", "thermal"),
    },
    "input-delay": {
        "sampling and computing of a controller": DEVICE_KINDS,
        "transport of the medium": ("hydraulic", "thermal"),
    },
    "drive-lag": {
        "the coil's inductance and resistance": _MAGNETIC,
        "the amplifier, which charges a capacitance": ("piezoelectric",),
        "the amplifier's bandwidth": _ELECTRIC,
        "the valve or the pump": ("hydraulic",),
        "the heater's own heat capacity": ("thermal",),
        "the shaker and its amplifier": ("mechanical",),
    },
    "eddy-diffusion": {
        "eddy currents in the core or the housing": _MAGNETIC,
        "relaxation of polarization": ("piezoelectric",),
        "the charge amplifier": ("piezoelectric",),
        "viscous flow that needs time to develop": ("hydraulic",),
        "heat that diffuses into the part": ("thermal",),
        "dielectric absorption or a distributed line": ("electronic",),
        "viscoelastic parts": ("mechanical",),
    },
    "drive-saturation": {
        "the amplifier's limit": _ELECTRIC,
        "the valve fully open, or the pump's pressure": ("hydraulic",),
        "the heater's full power": ("thermal",),
        "the shaker's limit": ("mechanical",),
    },
    "slew-limit": {
        "the amplifier's slew rate or charging current": _ELECTRIC,
        "the valve's speed": ("hydraulic",),
        "the heater's ramp limit": ("thermal",),
        "the shaker's amplifier": ("mechanical",),
    },
    "dead-zone": {
        "crossover of the amplifier": _ELECTRIC,
        "overlap of the valve": ("hydraulic",),
        "the dead band of the switch": ("thermal",),
        "a force that does not reach the part": ("mechanical",),
    },
    "hysteresis": {
        "magnetic domains": _MAGNETIC,
        "ferroelectric domains": ("piezoelectric",),
        "friction of seals and spool": ("hydraulic",),
        "a change of phase, or a thermostat": ("thermal",),
        "a ferrite core or a Schmitt trigger": ("electronic",),
        "micro-slip of joints, or plasticity": ("mechanical",),
    },
    "hysteresis-shape": {
        "magnetic domains": _MAGNETIC,
        "ferroelectric domains": ("piezoelectric",),
        "friction of seals and spool": ("hydraulic",),
        "a change of phase": ("thermal",),
        "a ferrite core": ("electronic",),
        "micro-slip of joints, or plasticity": ("mechanical",),
    },
    "asymmetry": {
        "a bias field": _MAGNETIC,
        "a force by the square of the current or voltage": (
            *_MAGNETIC,
            "piezoelectric",
        ),
        "poling or a bias voltage": ("piezoelectric",),
        "unequal areas of the piston": ("hydraulic",),
        "cooling that is not heating reversed": ("thermal",),
        "even-order distortion of the circuit": ("electronic",),
        "a diode's exponential curve": ("electronic",),
        "a valve of equal percentage": ("hydraulic", "thermal"),
        "preload or gravity": ("mechanical",),
    },
    "saturation": {
        "magnetic saturation": _MAGNETIC,
        "saturation of polarization": ("piezoelectric",),
        "flow that the supply pressure limits": ("hydraulic",),
        "losses that grow with temperature": ("thermal",),
        "the supply rails": ("electronic",),
        "a soft stop": ("mechanical",),
    },
    "rate-dependent-hysteresis": {
        "excess losses of moving domain walls": _MAGNETIC,
        "ferroelectric domain walls that move slowly": ("piezoelectric",),
        "seals whose friction depends on speed": ("hydraulic",),
        "excess losses of a ferrite core": ("electronic",),
        "viscoelastic joints": ("mechanical",),
        "a change of phase that takes time": ("thermal",),
    },
    "resonance": {
        "mass and stiffness of the mechanics": _MOVING,
        "inductance and capacitance": ("electronic",),
    },
    "stiffness-hardening": {
        "a spring, membrane or support that stiffens": _MOVING,
        "a nonlinear capacitance or feedback": ("electronic",),
    },
    "stop": {"a stop, or a contact that opens": _MOVING},
    "drag": {"turbulent flow of a fluid": _MOVING},
    "hysteretic-force": {
        "micro-slip of joints, or a fluid that yields": _MOVING,
    },
    "gravity": {"a weight on an arm": _MOVING},
    "slider-with-gap": {"friction behind a clearance": _MOVING},
    "friction": {"friction of guides, bearings, seals or joints": _MOVING},
    "backlash": {"play of a joint, a gear or a thread": _MOVING},
    "creep": {
        "magnetic after-effect": _MAGNETIC,
        "slow switching of domains": ("piezoelectric",),
        "slow leakage": ("hydraulic",),
        "heat that reaches the surroundings slowly": ("thermal",),
        "dielectric absorption": ("electronic",),
        "viscoelastic parts or glue": ("mechanical",),
    },
    "thermal-drift": {
        "Joule heat of the coil": _MAGNETIC,
        "dielectric losses that heat the ceramic": ("piezoelectric",),
        "losses that warm the oil": ("hydraulic",),
        "electrical power, the square of voltage or current": ("thermal",),
        "self-heating of the parts": ("electronic",),
        "damping that warms the part": ("mechanical",),
    },
    "sensor-lag": {"the sensor's own filter": DEVICE_KINDS},
    "sensor-nonlinearity": {"the sensor's curve": DEVICE_KINDS},
    "mains-pickup": {"cables and grounding beside the mains": DEVICE_KINDS},
    "drift": {"zero of the sensor that moves, or slow temperature": DEVICE_KINDS},
    "calibration-error": {"gain and zero of the sensor or its amplifier": DEVICE_KINDS},
}

#: What an effect is called where its name is that of one of its causes.
BEHAVIOURS: Mapping[str, str] = {"eddy-diffusion": "diffusion-like lag"}


def causes_of(effect: str, kind: DeviceKind | None = None) -> tuple[str, ...]:
    """Give what usually causes an effect, in a kind of device or in any.

    Parameters
    ----------
    effect : str
    kind : str, optional

    Returns
    -------
    tuple of str
        Empty where such a device cannot have it, and of an effect that the table does
        not have.
    """
    rows = CAUSES.get(effect, {}).items()
    return tuple(cause for cause, kinds in rows if kind is None or kind in kinds)


def impossible_in(kind: DeviceKind | None) -> tuple[str, ...]:
    """Name the effects that a kind of device cannot have; none where it is unknown."""
    if kind is None:
        return ()
    return tuple(effect for effect in CAUSES if not causes_of(effect, kind))


def behaviour_of(effect: str) -> str:
    """Call an effect by what it does, whatever causes it."""
    return BEHAVIOURS.get(effect, effect.replace("-", " "))

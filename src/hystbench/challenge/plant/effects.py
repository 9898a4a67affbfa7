"""All effects by name: those of the vocabulary and those outside it."""

from __future__ import annotations

from hystbench.challenge.plant import drive, material, mechanics, sensor, unlisted
from hystbench.challenge.plant.kind import Kind, read_kinds

KINDS: dict[str, Kind] = read_kinds(
    "effects.yaml", drive, material, mechanics, sensor, unlisted
)
VOCABULARY = {name: kind for name, kind in KINDS.items() if kind.use == "vocabulary"}
UNLISTED = {name: kind for name, kind in KINDS.items() if kind.use != "vocabulary"}

#: One effect or the other, never both: the data could not tell which is there, or one
#: takes the place of the other.
APART = (
    {"asymmetry", "sensor-nonlinearity"},
    {"hysteresis", "hysteresis-shape"},
    {"hysteresis", "rate-dependent-hysteresis"},
    {"resonance", "stiffness-hardening"},
    {"drive-lag", "eddy-diffusion"},
    {"drive-lag", "sensor-lag"},
    {"drive-lag", "input-delay"},
    {"sensor-lag", "input-delay"},
    {"sensor-lag", "eddy-diffusion"},
    {"input-delay", "eddy-diffusion"},
    {"creep", "thermal-drift"},
    {"creep", "drift"},
    {"thermal-drift", "drift"},
    {"saturation", "sensor-nonlinearity"},
    {"saturation", "drive-saturation"},
    {"friction", "backlash"},
    {"friction", "rate-dependent-hysteresis"},
    {"hysteresis", "backlash"},
    {"hysteresis", "friction"},
    {"hysteresis-shape", "backlash"},
    {"hysteresis-shape", "rate-dependent-hysteresis"},
)


def may_meet(names: tuple[str, ...]) -> bool:
    """Tell whether effects may be hidden together."""
    chosen = set(names)
    return len(chosen) == len(names) and not any(pair <= chosen for pair in APART)

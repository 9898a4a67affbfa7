"""All effects by name: those of the vocabulary and those outside it."""

from hystbench.challenge.plant import drive, material, mechanics, sensor, unlisted
from hystbench.challenge.plant.kind import read_kinds

IN_ACTUATOR, APART = read_kinds(
    "effects.yaml", drive, material, mechanics, sensor, unlisted
)
VOCABULARY = {name: kind for name, kind in IN_ACTUATOR.items() if kind.listed}
UNLISTED = {name: kind for name, kind in IN_ACTUATOR.items() if not kind.listed}

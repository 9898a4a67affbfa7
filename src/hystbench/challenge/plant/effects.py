"""What an actuator can hide, by name: listed in the vocabulary and outside it."""

from hystbench.challenge.plant import drive, material, mechanics, sensor, unlisted
from hystbench.challenge.plant.kind import read_kinds

IN_ACTUATOR, APART = read_kinds(
    "effects.yaml", drive, material, mechanics, sensor, unlisted
)

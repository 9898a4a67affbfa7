"""What actuators and machines can hide, by name: in the vocabulary and outside it."""

from hystbench.challenge.plant import (
    drive,
    inside,
    material,
    mechanics,
    sensor,
    unlisted,
)
from hystbench.challenge.plant.kind import read_kinds

IN_ACTUATOR, APART = read_kinds(
    "effects.yaml", drive, material, mechanics, sensor, unlisted
)
IN_MACHINE, APART_IN_MACHINE = read_kinds(
    "inside.yaml", inside, drive, material, sensor
)
MACHINES = (
    *("mass-spring", "free-mass", "pendulum", "impedance"),
    *("tank", "coupled-tanks"),
)

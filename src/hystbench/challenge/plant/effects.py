"""What actuators and machines can hide, by name: in the vocabulary and outside it."""

from hystbench.challenge.plant import (
    around_machine,
    drive,
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
    "in_machine.yaml", around_machine, drive, material, sensor
)
MACHINES = (
    *("mass-spring", "free-mass", "pendulum", "impedance"),
    *("tank", "coupled-tanks"),
)

"""Two forces that are missing in a mechanism of known numbers."""

import numpy as np
import pytest

from hystbench.gap.asked import Asked
from hystbench.record import Channel, Record
from tests.gap.closing import closed_beside
from tests.gap.made import evidence_of
from tests.gap.searched import among
from tests.gap.solved import motion

DT, COUNT, NOISE = 0.02, 750, 5e-3
MASS, DAMPING, SPRING = 0.09, 0.08, 1.5  # kg m^2, Nm s, Nm: .65 Hz, damped by .11
WEIGHT, DRAG = 0.5, 0.05  # Nm, Nm s^2
PADDLE = f"""
name: paddle
input: {{name: torque, unit: Nm}}
output: {{name: angle, unit: rad}}
chain:
- mechanism: {{mass: {MASS}, damping: {DAMPING}, stiffness: {1.01 * SPRING}}}
"""
FORCES = "gravity", "drag", "slider-with-gap"
CURVES = "dead-zone", "saturation", "stiffness-hardening"
"""With them, what is put in and what took its place in a search of singles alone."""


def swung(u):
    """A paddle that hangs in water, by a general solver."""
    time = np.arange(COUNT) * DT

    def slope(t, state):
        q, v = state
        torque = np.interp(t, time, u) - SPRING * q - DAMPING * v
        return [v, (torque - WEIGHT * np.sin(q) - DRAG * v * abs(v)) / MASS]

    return motion(slope, [0.0, 0.0], time, DT)


def torques():
    """Random steps, a sweep through resonance, and a random sum of sines."""
    time, rng = np.arange(COUNT) * DT, np.random.default_rng(26)
    steps = np.repeat(rng.uniform(-1.6, 1.6, COUNT // 125), 125)
    sweep = 0.6 * np.sin(2 * np.pi * (0.2 + 0.6 * time / time[-1]) * time)
    lines = zip(rng.uniform(0.1, 1.4, 9), rng.uniform(0, 6, 9), strict=True)
    sines = sum(0.35 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
    return {"steps": steps, "sweep": sweep, "sines": sines * np.clip(time / 2, 0, 1)}


def records():
    rng = np.random.default_rng(27)
    for (name, u), use in zip(
        torques().items(), ["fit", "fit", "hold-out"], strict=True
    ):
        y = swung(u) + NOISE * rng.standard_normal(COUNT)
        about = Channel("torque", "Nm"), Channel("angle", "rad"), "twin", use
        yield Record(name, DT, u, y, *about)


@pytest.mark.parametrize(
    ("free", "offered"),
    [("free: []\n", (*FORCES, *CURVES)), ("", FORCES)],
    ids=["exact", "about"],
)
def test_a_weight_and_a_drag_are_named_though_each_alone_is_beaten(
    free, offered, tmp_path
):
    """In a host that is exact there is no other one with its numbers fitted.

    Beside numbers that are free, curves take no force's place.
    """
    model = tmp_path / "model.yaml"
    model.write_text(PADDLE + free)
    told = "linear", NOISE, "force", "position"
    evidence = evidence_of("paddle", list(records()), *told)
    asked = Asked(vocabulary=among(*offered))
    content = closed_beside(model, evidence, asked)
    assert content["verdict"] == "named"
    found = {item["name"]: item["parameters"] for item in content["effects"]}
    assert set(found) == {"gravity", "drag"}
    assert abs(found["drag"]["coefficient"]["value"] / DRAG - 1) < 0.1
    assert content["gap"]["after"] < 1.3 * NOISE

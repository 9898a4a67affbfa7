"""A delay beside a force: to first order a lag does the same."""

import numpy as np

from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.run import closed_gap
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.searched import among

DT, FINE, COUNT, NOISE, LATE = 2e-3, 5, 3000, 0.05, 9
AXIS = """
name: axis
input: {name: force, unit: N}
output: {name: position, unit: mm}
free: {mechanism.mass: 0.03, mechanism.stiffness: 0.03, mechanism.damping: 0.03}
chain:
- mechanism: {mass: 0.00455, damping: 0.025, stiffness: 1.71}
"""
LIKELY = Asked(
    vocabulary=among(
        *("friction", "hysteretic-force", "backlash"),
        *("input-delay", "sensor-lag", "drive-lag"),
    )
)


def commands():
    rng, time = np.random.default_rng(25), np.arange(COUNT) * DT
    lines = zip(rng.uniform(0.2, 4, 12), rng.uniform(0, 6, 12), strict=True)
    sines = sum(4 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
    yield "random", sines * np.clip(time / 0.4, 0, 1)
    yield "sweep", 12 * np.sin(2 * np.pi * (0.4 + 0.7 * time) * time)
    yield "steps", np.repeat(rng.uniform(-18, 18, COUNT // 300), 300)


def test_a_command_that_is_late_is_no_lag_beside_friction(tmp_path):
    # The axis itself is the project's own, in fine steps; what counts is the choice.
    axis = Mechanism(mass=0.0045, damping=0.025, stiffness=1.7, hold="zero-order")
    dry = FrictionForce(coulomb=2.2, presliding_distance=0.06)
    rng, records = np.random.default_rng(26), []
    about = Channel("force", "N"), Channel("position", "mm"), "twin"
    for (name, u), use in zip(commands(), ["fit", "fit", "hold-out"], strict=True):
        acts = np.repeat(np.concatenate([np.zeros(LATE), u[:-LATE]]), FINE)
        y = axis.motion(acts, DT / FINE, (dry,)).position[::FINE]
        y += NOISE * rng.standard_normal(COUNT)
        records.append(Record(name, DT, u, y, *about, use))
    evidence = Evidence(
        "axis",
        tuple(records[:2]),
        (records[2],),
        input_hold="zero-order",
        noise_rms=NOISE,
        quantities=Quantities("force", "position"),
    )
    (tmp_path / "model.yaml").write_text(AXIS)
    base, _ = load_base(str(tmp_path / "model.yaml"), evidence)
    content = closed_gap(evidence, base, LIKELY).decision.content
    late = {item["name"]: item for item in content["effects"]}["input-delay"]
    delay = late["parameters"]["delay_s"]["value"]
    assert abs(delay / (LATE * DT) - 1) < 0.05

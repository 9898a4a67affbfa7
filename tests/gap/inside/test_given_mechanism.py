"""A mechanism that is given: its numbers are known, and what is beside it is found."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.run import closed_gap
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

DT, COUNT = 5e-4, 3000
MASS, DAMPING, SPRING = 0.4, 8.8, 19344.0  # kg, N s/m, N/m: 35 Hz, damped by .05
CUBIC = 0.08 * SPRING  # N/m/mm^2: at two millimetres the spring is a third stiffer
MAINS = ((50.0, 0.05), (150.0, 0.025))  # Hz, mm

LINEAR = f"""
name: isolator
input: {{name: force, unit: mN}}
output: {{name: position, unit: mm}}
chain:
  - mechanism: {{mass: {MASS}, damping: {DAMPING}, stiffness: {SPRING}}}
"""
EXACT = f"{LINEAR}  - stiffness: {{quadratic: 0.0, cubic: {CUBIC}}}\n"


def moved(u, time):
    """The device by a general solver, the force straight between samples."""

    def slope(t, state):
        x, v = state
        force = np.interp(t, time, u)
        return [v, (force - DAMPING * v - SPRING * x - CUBIC * x**3) / MASS]

    ends = (time[0], time[-1])
    given = {"method": "RK45", "rtol": 1e-8, "atol": 1e-10, "max_step": DT}
    return solve_ivp(slope, ends, [0.0, 0.0], t_eval=time, **given).y[0]


@pytest.fixture(scope="module")
def motions():
    time, found = np.arange(COUNT) * DT, []
    rng = np.random.default_rng(5)
    for _ in range(3):
        lines = zip(rng.uniform(5, 70, 12), rng.uniform(0, 6, 12), strict=True)
        u = sum(1600 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
        u *= np.clip(time / 0.05, 0, 1)
        found.append((u, moved(u, time)))
    return found


def evidence_of(motions, noise, tones=()):
    time = np.arange(COUNT) * DT
    rng, records = np.random.default_rng(6), []
    about = Channel("force", "mN"), Channel("position", "mm"), "twin"
    for k, (u, y) in enumerate(motions):
        beside = sum(a * np.sin(2 * np.pi * f * time + 2 * k) for f, a in tones)
        measured = y + beside + noise * rng.standard_normal(COUNT)
        use = "hold-out" if k == 2 else "fit"
        records.append(Record(f"run-{k}", DT, u, measured, *about, use))
    return Evidence(
        "isolator",
        tuple(records[:2]),
        (records[2],),
        input_hold="linear",
        noise_rms=noise,
        quantities=Quantities("force", "position"),
    )


def closed(model, evidence, path):
    path.write_text(model)
    base, _ = load_base(str(path), evidence)
    return closed_gap(evidence, base).decision.content


def test_what_steps_miss_of_an_exact_model_is_no_effect(motions, tmp_path):
    size = float(np.sqrt(np.mean(motions[0][1] ** 2)))
    content = closed(EXACT, evidence_of(motions, 1e-3 * size), tmp_path / "m.yaml")
    assert content["effects"] == []
    assert content["verdict"] == "no-gap"


def test_a_tone_is_found_beside_a_spring_that_hardens(motions, tmp_path):
    content = closed(LINEAR, evidence_of(motions, 0.01, MAINS), tmp_path / "m.yaml")
    assert content["verdict"] == "named"
    spring, tone = content["effects"]
    assert (spring["name"], spring["place"]) == ("stiffness-hardening", "inside")
    assert tone["name"] == "mains-pickup"
    sizes = tone["parameters"]["amplitudes"]["value"]
    assert sizes[::2] == pytest.approx([a for _, a in MAINS], rel=0.1)
    # The linear part was given and is as it was: nothing was refitted.
    assert "refitted" not in content["reason"]
    assert spring["parameters"]["cubic"]["value"] == pytest.approx(CUBIC, rel=0.05)

"""A mechanism that is given: its numbers are known, and what is beside it is found."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks.gain import Gain
from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.fitting.least_squares import fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.run import closed_gap
from hystbench.gap.thresholds import SCALE
from hystbench.record import Channel, Record
from tests.gap import made
from tests.gap.closing import closed_beside
from tests.gap.searched import among
from tests.gap.solved import motion

DT, COUNT = 5e-4, 1000
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


DRAG = 0.02  # mN s^2/mm^2: at half a metre a second as much as the damper
SHARE = 0.5  # of the input, that becomes a force


def moved(u, time, gain=1.0, drag=0.0):
    """The device by a general solver, the force straight between samples."""

    def slope(t, state):
        x, v = state
        force = gain * np.interp(t, time, u)
        inside = CUBIC * x**3 + drag * v * abs(v)
        return [v, (force - DAMPING * v - SPRING * x - inside) / MASS]

    return motion(slope, [0.0, 0.0], time, DT)


def moving(**given):
    """Three records of a device, random sums of sines that begin gently."""
    time, found = np.arange(COUNT) * DT, []
    rng = np.random.default_rng(5)
    for _ in range(3):
        lines = zip(rng.uniform(5, 70, 12), rng.uniform(0, 6, 12), strict=True)
        u = sum(1600 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
        u *= np.clip(time / 0.05, 0, 1)
        found.append((u, moved(u, time, **given)))
    return found


@pytest.fixture(scope="module")
def motions():
    return moving()


def evidence_of(motions, noise, tones=()):
    time = np.arange(COUNT) * DT
    rng, records = np.random.default_rng(6), []
    about = Channel("force", "mN"), Channel("position", "mm"), "twin"
    for k, (u, y) in enumerate(motions):
        beside = sum(a * np.sin(2 * np.pi * f * time + 2 * k) for f, a in tones)
        measured = y + beside + noise * rng.standard_normal(COUNT)
        use = "hold-out" if k == 2 else "fit"
        records.append(Record(f"run-{k}", DT, u, measured, *about, use))
    return made.evidence_of("isolator", records, "linear", noise, "force", "position")


FORCES = Asked(vocabulary=among("stiffness-hardening", "drag", "stop", "asymmetry"))
"""What is put in here inside, and what it may be taken for."""


def closed(model, evidence, path, asked=FORCES):
    path.write_text(model)
    return closed_beside(path, evidence, asked)


def test_what_steps_miss_of_an_exact_model_is_no_effect(motions, tmp_path):
    size = float(np.sqrt(np.mean(motions[0][1] ** 2)))
    evidence = evidence_of(motions, 1e-3 * size)
    content = closed(EXACT, evidence, tmp_path / "m.yaml", Asked())
    assert content["effects"] == []
    assert content["verdict"] == "no-gap"


def test_a_tone_is_found_beside_a_spring_that_hardens(motions, tmp_path):
    likely = Asked(vocabulary=among("stiffness-hardening", "drag", "mains-pickup"))
    evidence = evidence_of(motions, 0.01, MAINS)
    content = closed(LINEAR, evidence, tmp_path / "m.yaml", likely)
    assert content["verdict"] == "named"
    spring, tone = content["effects"]
    assert (spring["name"], spring["place"]) == ("stiffness-hardening", "inside")
    assert tone["name"] == "mains-pickup"
    sizes = tone["parameters"]["amplitudes"]["value"]
    assert sizes[::2] == pytest.approx([a for _, a in MAINS], rel=0.1)
    # The linear part was given and is as it was: nothing was refitted.
    assert "refitted" not in content["reason"]
    assert spring["parameters"]["cubic"]["value"] == pytest.approx(CUBIC, rel=0.05)


def test_a_mechanism_that_has_a_force_lacks_another_one(tmp_path):
    """The spring that hardens is given with its gain; the drag is not."""
    model = EXACT.replace(f"{SPRING}}}", f"{SPRING}, gain: {SHARE}}}")
    evidence = evidence_of(moving(gain=SHARE, drag=DRAG), 0.002)
    content = closed(model, evidence, tmp_path / "m.yaml")
    (drag,) = content["effects"]
    assert (drag["name"], drag["place"]) == ("drag", "inside")
    # In the unit that the given mechanism has its forces in.
    assert drag["parameters"]["coefficient"]["value"] == pytest.approx(DRAG, rel=0.05)


@pytest.mark.parametrize("noise", [0.003, 0.006])
def test_forces_that_are_a_little_off_are_no_effect(noise, tmp_path):
    """The device is all given, its spring and its drag by three parts of a hundred."""
    drag = f"  - drag: {{coefficient: {DRAG / 0.97}}}\n"
    model = EXACT.replace(f"{CUBIC}", f"{CUBIC * 0.97}") + drag
    evidence = evidence_of(moving(drag=DRAG), noise)
    assert closed(model, evidence, tmp_path / "m.yaml")["effects"] == []


def test_a_given_mechanism_is_its_own_host(motions, tmp_path):
    """It keeps its gain, and nothing is put beside its numbers."""
    path = tmp_path / "m.yaml"
    path.write_text(LINEAR.replace(f"{SPRING}}}", f"{SPRING}, gain: 1.0}}"))
    evidence = evidence_of(motions, 0.01)
    base, _ = load_base(str(path), evidence)
    model = closed_gap(evidence, base, FORCES).outcome.model
    mechanism, stiffness = model.chain
    assert replace(mechanism, hold="default") == base.chain[0]
    assert stiffness.cubic == pytest.approx(CUBIC, rel=0.05)


def test_a_lag_shorter_than_a_sample_is_found_beside_a_spring(motions, tmp_path):
    """A sensor that is late by .4 of a sampling interval; the mechanism is given."""
    lag, late = 0.4 * DT, []
    for u, y in motions:
        # First order, the output straight between samples.
        kept = np.exp(-DT / lag)
        behind = np.zeros_like(y)
        for k in range(1, len(y)):
            slope = (y[k] - y[k - 1]) / DT
            forced = y[k] - lag * slope
            behind[k] = forced + kept * (behind[k - 1] - y[k - 1] + lag * slope)
        late.append((u, behind))
    times = "input-delay", "sensor-lag"
    likely = Asked(vocabulary=among("stiffness-hardening", "drag", *times))
    content = closed(LINEAR, evidence_of(late, 0.002), tmp_path / "m.yaml", likely)
    by_place = {item["place"]: item for item in content["effects"]}
    spring, lagging = by_place.pop("inside"), *by_place.values()
    assert spring["name"] == "stiffness-hardening"
    # So short a lag may be anywhere, and a delay.
    assert lagging["name"] in ("sensor-lag", "drive-lag", "input-delay")
    (time,) = (item["value"] for item in lagging["parameters"].values())
    assert time == pytest.approx(lag, rel=0.05)


def test_no_force_is_tried_where_one_effect_of_a_chain_leaves_noise(
    motions, tmp_path, monkeypatch
):
    """The device is linear, as it is given, and its input acts three samples late."""
    late, law = [], ([1.0], [MASS, DAMPING, SPRING])
    for u, _ in motions:
        y = lsim(law, u, np.arange(COUNT) * DT)[1]
        late.append((u, np.concatenate([np.zeros(3), y[:-3]])))
    monkeypatch.setattr(
        "hystbench.gap.gap_search.named_inside", lambda *given: pytest.fail("tried")
    )
    likely = Asked(vocabulary=among("stiffness-hardening", "input-delay"))
    content = closed(LINEAR, evidence_of(late, 0.01), tmp_path / "m.yaml", likely)
    assert [item["name"] for item in content["effects"]] == ["input-delay"]


def test_a_number_at_the_end_of_its_range_moves_back():
    """A step of a slope that is cut off there would tell that nothing changes."""
    u = np.sin(2.1 * np.arange(800) * 0.01)
    y = lsim(([1.0], [1.0, 4.0, 900.0]), 50 * u, np.arange(800) * 0.01)[1]
    about = Channel("force", "N"), Channel("position", "m"), "twin", "fit"
    given = (Record("run", 0.01, 50 * u, y, *about),)
    block = Mechanism(mass=1.0, damping=4.0, stiffness=1000.0, hold="linear")
    free = (Free(0, "stiffness", low=600.0, high=1000.0),)
    state = ModelState((block,), given, ScoredSamples.of(given), free=free).settled()
    found = fitted(state, Score.plain(state.sample, 1e-12)).state
    assert found.chain[0].stiffness == pytest.approx(900.0, rel=1e-3)


@pytest.mark.parametrize("noise", [0.02, 0.2, 2.0])
def test_a_number_of_a_known_tolerance_is_where_the_score_with_its_charge_is_least(
    noise,
):
    """Of one gain, beside a search along it."""
    rng = np.random.default_rng(8)
    u = rng.standard_normal(400)
    y = 1.3 * u + noise * rng.standard_normal(400)
    about = Channel("force", "N"), Channel("force", "N"), "twin", "fit"
    given = tuple(Record(f"run-{k}", DT, u, y, *about) for k in range(2))
    free = (Free(0, "value", tolerance=0.1, given=1.0),)
    state = ModelState((Gain(value=1.0),), given, ScoredSamples.of(given), free=free)
    score = Score.plain(state.sample, 1e-6)
    gains = np.linspace(0.9, 1.5, 1201)
    values = [
        score.of(y2 - gain * u2) + ((gain - 1.0) / 0.1) ** 2
        for y2, u2 in [(state.measured, state.sample.take([u, u]))]
        for gain in gains
    ]
    found = fitted_to_the_end(state, score)
    assert found.score == pytest.approx(
        found.state.moved_charge + score.of(found.state.residual)
    )
    assert found.score < min(values) + SCALE  # by less no name is another one

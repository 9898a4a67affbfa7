"""An input that was stamped late by part of a sample, beside effects that hide it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.drive_lag import DriveLag
from hystbench.blocks.gain import Gain
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.bases.load import load_base
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.inside.timing import (
    better_timed,
    in_front,
    in_time_words,
    timed,
    timed_as_named,
    with_free_timing,
)
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 0.01, 1500, 2e-3
CHANNELS = Channel("force", "N"), Channel("position", "m")
MASS = Mechanism(mass=0.5, damping=1.5, stiffness=60.0)
BASE = IdentifiedModel("linear", *CHANNELS, (MASS,), ("mechanism.mass",))


def moved(later):
    """Records of a mass whose input comes later by so many samples."""
    rng, given = np.random.default_rng(2), []
    for k in range(2):
        t = DT * np.arange(COUNT)
        lines = rng.uniform(0.3, 6.0, 12)
        u = sum(
            np.sin(2 * np.pi * f * t + p) for f, p in zip(lines, lines, strict=True)
        )
        late = InputDelay.by(later * DT).simulate(u, u, DT)
        y = MASS.simulate(late, late, DT)
        y = y + NOISE * y.std() * rng.standard_normal(COUNT)
        given.append(Record(f"r{k}", DT, u, y, *CHANNELS, "measured", "fit"))
    noise = NOISE * min(float(record.y.std()) for record in given)
    free = tuple(Free(0, x) for x in ("mass", "damping", "stiffness"))
    records = tuple(given)
    state = ModelState((MASS,), records, ScoredSamples.of(records), free=free)
    return state, Floor(noise, "declared")


@pytest.mark.parametrize("later", [0.5, -0.4])
def test_a_timing_that_pays_is_put_before_the_base(later):
    state, floor = moved(later)
    found = better_timed(BASE, state, floor)
    assert found is not None
    delay, mass = found.chain
    assert (delay.delay_s - delay.lead_s) / DT == pytest.approx(later, abs=0.02)
    assert mass == MASS
    assert found.free == BASE.free


def test_a_base_in_time_stays():
    state, floor = moved(0.0)
    assert better_timed(BASE, state, floor) is None


def test_a_base_that_is_late_already_becomes_later():
    base = timed(timed(BASE, 0.5 * DT), 0.25 * DT)
    assert [block.name for block in base.chain] == ["input-delay", "mechanism"]
    assert base.chain[0].delay_s == pytest.approx(0.75 * DT)


def test_timing_is_free_by_a_sample_about_where_it_is():
    state, _ = moved(0.0)
    late = with_free_timing(with_free_timing(state))
    assert [x.parameter for x in late.free].count("delay_s") == 1
    own = late.free[0]
    at = late.chain[0].lead_s
    assert (own.low, own.high) == pytest.approx((at - DT, at + DT))
    np.testing.assert_allclose(late.residual, state.residual, atol=1e-9)


def test_a_delay_in_a_chain_is_timing_only_beside_an_effect_and_below_a_sample():
    state, _ = moved(0.0)
    delay = Added("input-delay", "drive", "", (0,), {}, 1.0)
    gain = Added("calibration-error", "sensor", "", (2,), {}, 1.0)

    def chain(later, *added):
        blocks = (InputDelay.by(later * DT), MASS, Gain(value=1.1))
        return ModelState(blocks, state.records, state.sample, added=added)

    found = timed_as_named(BASE, chain(0.4, delay, gain))
    assert found is not None
    assert found.chain[0].delay_s == pytest.approx(0.4 * DT)
    assert timed_as_named(BASE, chain(0.4, delay)) is None
    assert timed_as_named(BASE, chain(3.0, delay, gain)) is None
    early = timed(BASE, -0.7 * DT)  # what is named makes up for it
    found = timed_as_named(early, chain(0.5, delay, gain))
    assert found is not None
    assert found.chain[0].delay_s == pytest.approx(0.5 * DT)


def test_a_mass_is_tried_with_its_timing_in_place_of_a_zero():
    state, floor = moved(0.5)
    late = TransferFunction(numerator=(1.0,), denominator=(0.5, 1.5, 60.0))
    start = ModelState((late,), state.records, state.sample)
    score = Score.plain(state.sample, floor.square)
    kinds = Quantities("force", "position")
    plain, timing, *_ = hosts(start, kinds, True, score)
    assert any(x.parameter == "blend" for x in plain.fitted.state.free)
    assert all(x.parameter != "blend" for x in timing.fitted.state.free)
    assert timing.fitted.score < plain.fitted.score
    assert in_time_words(timing.fitted.state).endswith(
        "0.005 s late, 0.5 of a sampling interval"
    )
    assert in_time_words(plain.fitted.state) == ""
    # So is what was found in it, with a lag before the mass too.
    whole = plain.fitted.state
    lagged = in_front(DriveLag(time_constant_s=0.02), whole)
    carried = timing.carry(lagged)
    delay, lag, mass = carried.chain[:3]
    assert (type(delay), type(lag)) == (InputDelay, DriveLag)
    assert mass == replace(whole.chain[0], blend=0.0)
    assert all(x.parameter != "blend" for x in carried.free)
    assert len(carried.free) == len(whole.free)


def test_a_tank_whose_input_was_stamped_late_still_shows_its_outlet():
    """Half a sample late, its outflow was found right and left unnamed."""
    rng, made, fine = np.random.default_rng(4), [], 40
    channels = Channel("pump", "V"), Channel("level", "cm")
    for k in range(2):
        u = np.repeat(rng.uniform(1.0, 6.0, 40), 12)
        pump = np.repeat(u, fine)
        pump = np.concatenate([np.full(fine // 2, u[0]), pump])[: len(u) * fine]
        level, y = 5.0, np.empty(len(u))
        for i, volts in enumerate(pump.tolist()):
            if i % fine == 0:
                y[i // fine] = level
            level += 2.0 / fine * (0.16 * volts - 0.2 * math.sqrt(level))
        y += 2e-3 * np.std(y) * rng.standard_normal(len(y))
        made.append(Record(f"run-{k}", 2.0, u, y, *channels, "measured", "fit"))
    base, _ = load_base("linear", Evidence("tank", tuple(made), (), "zero-order"))
    kinds = Quantities("voltage", "level")
    likely = among("outflow", "overflow", "input-delay", "sensor-nonlinearity")
    found = search(
        "tank", made, base, "zero-order", quantities=kinds, vocabulary=likely
    ).content
    assert found["verdict"] == "named"
    assert [item["name"] for item in found["effects"]] == ["outflow"]
    assert found["effects"][0]["parameters"]["exponent"]["value"] == pytest.approx(
        0.5, abs=0.02
    )
    assert "takes its input 1 s late, 0.5 of a sampling interval" in found["reason"]

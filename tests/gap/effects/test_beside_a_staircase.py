"""Linear effects beside a transfer function whose input is a staircase.

The first of two linear blocks smooths the staircase. The second block would be half a
sample late if it took a staircase too. It takes straight lines, which miss little
here, as all times are far above the sampling interval. The truth is one transfer
function, exact for a staircase.
"""

import numpy as np
import pytest

from hystbench.blocks.sensor_lag import SensorLag
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect, without_effect
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.searched import among, search
from tests.gap.small import block

DT, COUNT, NOISE = 1e-3, 3000, 1e-3
COMMAND, POSITION = Channel("command", "1"), Channel("position", "1")
PLANT = TransferFunction(
    numerator=(1.0,), denominator=(1.3e-4, 6.8e-3, 1.0), hold="zero-order"
)
W = 2 * np.pi * 31.0


def answer(numerator, denominator):
    random = np.random.default_rng(4)
    whole = TransferFunction(
        numerator=tuple(np.polymul(PLANT.numerator, numerator)),
        denominator=tuple(np.polymul(PLANT.denominator, denominator)),
        hold="zero-order",
    )
    given = []
    for k in range(2):
        u = np.repeat(random.uniform(-1.0, 1.0, COUNT // 5), 5)
        y = whole.simulate(u, u, DT) + NOISE * random.standard_normal(COUNT)
        given.append(Record(f"run-{k}", DT, u, y, COMMAND, POSITION, "measured", "fit"))
    base = Model("stage", COMMAND, POSITION, (PLANT,))
    return search("stage", tuple(given), base, "zero-order").content


def named(content):
    (effect,) = content["effects"]
    found = effect["parameters"]
    return effect["name"], {name: item["value"] for name, item in found.items()}


def test_a_lag_has_its_time():
    content = answer((1.0,), (8e-3, 1.0))
    (name, found), (effect,) = named(content), content["effects"]
    # Before the plant or behind it, it does the same.
    both = {name, *effect["cannot_be_told_from"]}
    assert both == {"drive-lag", "sensor-lag"}
    assert found["time_constant_s"] == pytest.approx(8e-3, rel=0.01)


def test_a_mode_has_its_frequency_and_its_share():
    p, zeta = 0.15, 0.02
    down = np.array([1.0, 2 * zeta * W, W * W])
    up = (1 - p) * down + p * np.array([0.0, 0.0, W * W])
    content = answer(tuple(up), tuple(down))
    name, found = named(content)
    assert (content["verdict"], name) == ("named", "resonance")
    assert found["frequency_hz"] == pytest.approx(31.0, rel=1e-3)
    assert found["damping_ratio"] == pytest.approx(zeta, rel=0.05)
    assert found["participation"] == pytest.approx(p, rel=0.02)


def test_a_lag_that_goes_out_again_leaves_the_staircase():
    u = np.repeat(np.random.default_rng(1).uniform(-1.0, 1.0, 200), 5)
    given = (Record("run", DT, u, u, COMMAND, POSITION, "measured"),)
    start = ModelState((PLANT,), given, ScoredSamples.of(given), hold="zero-order")
    lags = effects()["drive-lag"].variants(start.simulation)
    variant = next(x for x in lags if x.start == 0)
    added = with_effect(start, variant, {"time_constant_s": 8e-3})
    assert [block.hold for block in added.chain] == ["zero-order", "linear"]
    assert without_effect(added, 0).chain == start.chain


def test_a_mode_stands_before_the_sensors_lag():
    lag = SensorLag(time_constant_s=1e-2, hold="linear")
    given = (Record("run", DT, np.ones(9), np.ones(9), COMMAND, POSITION, "measured"),)
    assert Simulation((PLANT, lag), given, "zero-order").behind_linear == 1
    assert Simulation((PLANT, lag), given, "linear").behind_linear == 0


def test_a_mode_stands_behind_the_lag_of_an_amplifier_and_its_gain():
    lag = SensorLag(time_constant_s=1e-2, hold="zero-order")
    given = (Record("run", DT, np.ones(9), np.ones(9), COMMAND, POSITION, "measured"),)
    gain, late = block("gain", value=2.0), block("input-delay", delay_s=1e-3)
    assert Simulation((gain, lag), given, "zero-order").behind_linear == 2
    assert Simulation((late, gain, lag), given, "zero-order").behind_linear == 3
    assert Simulation((gain, lag), given, "linear").behind_linear == 0


def test_a_creep_stands_behind_a_mass_with_the_forces_inside():
    """Before it, the half of a sample by which straight lines come late hid it."""
    mass = block("mechanism", mass=1.0, damping=2.0, stiffness=400.0, hold="zero-order")
    spring = block("stiffness", quadratic=0.0, cubic=1.0)
    given = (Record("run", DT, np.ones(9), np.ones(9), COMMAND, POSITION, "measured"),)
    assert Simulation((mass,), given, "zero-order").behind_linear == 1
    assert Simulation((mass,), given, "linear").behind_linear == 0
    assert Simulation((mass, spring), given, "zero-order").behind_linear == 2


def test_a_suspension_that_creeps_is_named_beside_a_given_mass():
    """A step of the force, as long as it lasts, and small ones in between."""
    random, tau = np.random.default_rng(3), 0.8
    mass = block("mechanism", mass=1.0, damping=15.0, stiffness=900.0)
    base = Model("suspension", COMMAND, POSITION, (mass,))
    records = []
    for name in ("a", "b"):
        u = np.repeat(random.uniform(-300.0, 300.0, 60), 25)
        x = base.with_hold("zero-order").simulate(u, DT)
        slow = block("sensor-lag", time_constant_s=tau).simulate(x, x, DT)
        y = x + 0.2 * slow + 1e-3 * random.standard_normal(len(u))
        records.append(Record(name, DT, u, y, COMMAND, POSITION, "measured"))
    only = among("creep", "drift", "hysteresis", "calibration-error")
    asked = {"hold": "zero-order", "vocabulary": only}
    found = search("suspension", records, base, **asked)
    (effect,) = found.content["effects"]
    assert effect["name"] == "creep"
    (time,) = np.atleast_1d(effect["parameters"]["time_constants_s"]["value"])
    assert time == pytest.approx(tau, rel=0.05)

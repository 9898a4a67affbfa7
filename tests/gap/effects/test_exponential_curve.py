"""A drive that grows by the same factor each step: asymmetry, by its own law."""

import numpy as np
import pytest

from hystbench.blocks.exponential_curve import ExponentialCurve
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import goes_both_ways
from hystbench.gap.effects.law import Passed
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 0.1, 800, 0.003
OPENING, FLOW = Channel("opening", "1"), Channel("flow", "1")
PIPE = TransferFunction(
    numerator=(1.0,), denominator=(0.75, 2.0, 1.0), hold="zero-order"
)
CURVES = among(
    *("asymmetry", "saturation", "sensor-nonlinearity", "dead-zone"),
    *("drive-saturation", "hysteresis"),
)


def records(curvature):
    random = np.random.default_rng(8)
    found = []
    for k in range(2):
        u = np.repeat(random.uniform(0.0, 1.0, COUNT // 40), 40)
        bent = np.expm1(curvature * u) / curvature  # by hand, not by the block
        y = PIPE.simulate(bent, bent, DT) + NOISE * random.standard_normal(COUNT)
        found.append(Record(f"run-{k}", DT, u, y, OPENING, FLOW, "measured", "fit"))
    return tuple(found)


@pytest.mark.parametrize("curvature", [2.0, -2.0])
def test_it_is_named_with_its_curvature(curvature):
    base = Model("pipe", OPENING, FLOW, (PIPE,))
    answer = search("valve", records(curvature), base, "zero-order", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    assert (effect["name"], effect["place"]) == ("asymmetry", "material")
    assert effect["blocks"] == ["exponential-curve"]
    found = effect["parameters"]["curvature"]
    assert found["value"] == pytest.approx(curvature, rel=0.03)
    assert abs(found["value"] - curvature) < 4 * found["standard_error"]


def test_a_drive_that_gives_more_one_way_has_two_slopes():
    base = Model("pipe", OPENING, FLOW, (PIPE,))
    random, given = np.random.default_rng(9), []
    for k in range(2):
        u = np.repeat(random.uniform(-1.0, 1.0, COUNT // 40), 40)
        bent = np.where(u > 0.0, 1.2 * u, 0.8 * u)
        y = PIPE.simulate(bent, bent, DT) + NOISE * random.standard_normal(COUNT)
        given.append(Record(f"run-{k}", DT, u, y, OPENING, FLOW, "measured", "fit"))
    answer = search("rod", tuple(given), base, "zero-order", vocabulary=CURVES)
    (effect,) = answer.content["effects"]
    assert (effect["name"], effect["blocks"]) == ("asymmetry", ["two-slopes"])
    found = effect["parameters"]["difference"]
    assert found["value"] == pytest.approx(0.2, abs=4 * found["standard_error"])
    assert found["value"] == pytest.approx(0.2, rel=0.05)


@pytest.mark.parametrize(("low", "offered"), [(-1.0, True), (0.0, False)])
def test_of_an_input_that_goes_one_way_two_slopes_are_a_gain(low, offered):
    """A gain that is a little off would be named an asymmetry."""
    u = np.linspace(low, 1.0, COUNT)
    given = (Record("run", DT, u, u, OPENING, FLOW, "measured", "fit"),)
    simulation = Simulation((PIPE,), given, "zero-order", "quick")
    forms = {item.form for item in effects()["asymmetry"].variants(simulation)}
    assert ("two slopes" in forms) == offered
    assert "exponential" in forms
    passed = Passed(1.0, 1.0, DT, DT, goes_both_ways([u]))
    around = {law.form for law in effects()["asymmetry"].around(passed)}
    assert ("two slopes" in around) == offered


def test_without_curvature_it_is_a_straight_line():
    z = np.linspace(-3.0, 3.0, 7)
    straight = ExponentialCurve(curvature=0.0).simulate(z, z, 1.0)
    nearly = ExponentialCurve(curvature=1e-9).simulate(z, z, 1.0)
    np.testing.assert_array_equal(straight, z)
    np.testing.assert_allclose(nearly, z, rtol=1e-8)

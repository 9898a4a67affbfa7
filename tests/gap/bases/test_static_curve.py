"""A linear base behind a static curve: of a drive with a dead zone."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases import linear as module
from hystbench.gap.bases.linear import (
    CURVE,
    found_with,
    identified_linear,
    linear_of,
)
from hystbench.gap.bases.static_curve import behind_a_curve
from hystbench.gap.records.evidence import Evidence
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.small import block

DT, ZONE, NOISE = 1.0, 8.0, 0.2


def dead(u):
    return np.sign(u) * np.maximum(np.abs(u) - ZONE, 0.0)


def evidence(inputs, behind):
    random = np.random.default_rng(3)
    records = [
        record(
            u, behind(u) + NOISE * random.standard_normal(len(u)), name=f"{k}", dt=DT
        )
        for k, u in enumerate(inputs)
    ]
    return Evidence("made", tuple(records), (), "zero-order")


def poles(model):
    every = (x for x in model.chain if isinstance(x, TransferFunction))
    return [np.roots(x.denominator) for x in every]


def sweeps():
    """A speed that is read at each setting, upwards and then downwards from zero."""
    way = np.linspace(0.0, 70.0, 200)
    return [np.concatenate([way, -way])]


def noises(count=2, size=30.0):
    """Sums of sines up to a tenth of the sampling rate."""
    random, t = np.random.default_rng(4), np.arange(800)
    frequencies = np.linspace(0.002, 0.1, 20)
    return [
        size
        / 4
        * np.sin(2 * np.pi * np.outer(t, frequencies) + random.uniform(0, 6, 20)).sum(
            axis=1
        )
        for _ in range(count)
    ]


@pytest.fixture(scope="module")
def swept():
    return evidence(sweeps(), lambda u: 2.0 * dead(u))


def test_a_sweep_through_a_dead_zone_asks_for_no_pole(swept):
    assert poles(linear_of(swept).model)  # which imitate it
    found = identified_linear(swept)
    assert not poles(found.model)
    assert found_with(found.model) == CURVE
    assert "behind a static curve" in found.note


def test_poles_behind_the_curve_are_those_of_the_device():
    lag = block(
        "transfer-function", numerator=(2.0,), denominator=(9.0, 1.0), hold="zero-order"
    )
    made = evidence(noises(), lambda u: lag.simulate(dead(u), dead(u), 1.0))
    found = identified_linear(made)
    (own,) = poles(found.model)
    assert own == pytest.approx([-1 / 9], rel=0.1)


def test_the_curve_has_the_inputs_mean_slope(swept):
    plain = linear_of(swept)
    first = behind_a_curve(swept, plain.model.chain, plain.fit_rms)
    assert first is not None
    u, z = (np.concatenate([x.u for x in own.fit]) for own in (swept, first))
    assert np.polyfit(u, z, 1)[0] == pytest.approx(1.0, abs=1e-6)
    expected = dead(u) / np.polyfit(u, dead(u), 1)[0]
    assert np.std(z - expected) < 0.05 * np.std(expected)  # eight bends


def test_a_slow_device_from_rest_has_no_further_pole():
    """A step of the curve's zero would be a transient of its own."""
    lag = block(
        "transfer-function",
        numerator=(2.0,),
        denominator=(150.0, 1.0),
        hold="zero-order",
    )
    made = evidence(noises(), lambda u: lag.simulate(dead(u), dead(u), 1.0))
    (own,) = poles(identified_linear(made).model)
    assert own == pytest.approx([-1 / 150], rel=0.1)


def test_of_a_square_a_line_is_no_part():
    """A base that is scaled by it would have a gain of chance."""
    made = evidence(noises(), lambda u: 5.0 * u**2)
    plain = linear_of(made)
    assert behind_a_curve(made, plain.model.chain, plain.fit_rms) is None


def test_a_linear_device_has_no_curve():
    lag = block(
        "transfer-function", numerator=(2.0,), denominator=(9.0, 1.0), hold="zero-order"
    )
    made = evidence(noises(), lambda u: lag.simulate(u, u, 1.0))
    plain = linear_of(made)
    assert behind_a_curve(made, plain.model.chain, plain.fit_rms) is None


@pytest.mark.parametrize(
    ("split", "taken"), [(np.inf, True), (0.03, True), (0.01, False)]
)
def test_a_curve_between_two_filters_is_no_curve_before_them(split, taken, monkeypatch):
    """Before them it leaves .04 where the one between leaves .01: it stands between."""
    model = module.IdentifiedModel(
        "linear", CURRENT, DISPLACEMENT, (block("gain", value=1.0),)
    )
    plain = module.Linear(model, "plain", 0.14, 0.2, 1.0, split)
    curved = module.Linear(model, "curved", 0.04, 0.04, 1.0)
    answers = iter([plain, curved])
    monkeypatch.setattr(module, "linear_of", lambda evidence: next(answers))
    beside = [("slew-limit", "behind a curve", "without", None)]
    monkeypatch.setattr(module, "_found_beside", lambda *_: beside)
    evidence = Evidence("rig", (record(np.zeros(9)),), ())
    found = module.identified_linear(evidence)
    assert found.note.startswith("curved" if taken else "plain")

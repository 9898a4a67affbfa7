"""Simulators of somebody's own, whose inside is not seen: a function, and a column.

The search on them is held against hidden cases of the challenge's plant, whose given
model stands behind a Python function, or has left its output beside the records.
"""

import os
from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.external import External
from hystbench.challenge.case import make_case
from hystbench.challenge.spec import CaseSpec
from hystbench.gap.bases.load import given_base, load_base
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Declined
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.run import write_next_experiment
from hystbench.gap.simulation.reshape import reshapings
from hystbench.gap.simulation.simulation import Simulation
from tests.gap.halved import first_halves
from tests.gap.made import CURRENT, record, sine
from tests.gap.searched import among, search
from tests.gap.small import block, hysteresis, measured, records

SEED = 1

FUNCTIONS = """
import numpy as np
from scipy.signal import lfilter

calls = []

def charging(u, dt):
    return 1.0 + 0.4 * u + 0.7 * dt * np.cumsum(u)

def lagging(u, dt):
    calls.append(len(u))
    return 3.0 + lfilter([0.2], [1.0, -0.8], u)

def bent(u, dt):
    return np.tanh(lagging(u, dt))

def slow(u, dt):
    pole = np.exp(-dt / 0.6)  # of the longest record 0.4
    return lfilter([1 - pole], [1.0, -pole], u)

def ringing(u, dt):
    w = 2 * np.pi * 5 * dt
    a = [1.0, -2 * np.exp(-0.01 * w) * np.cos(w), np.exp(-0.02 * w)]
    return lfilter([sum(a)], a, u)

def loose(u, dt):
    y, value = np.zeros(len(u)), 0.0
    for k, now in enumerate(u):
        value = max(now - 0.1, min(now + 0.1, value))
        y[k] = value
    return bent(y, dt)

def shy(u, dt):
    if abs(u[0]) > 0.1 or np.abs(u).max() > 0.9:
        raise ValueError("starts from rest, and not so far")
    return loose(u, dt)

def refuses(u, dt):
    if len(u) > 2000:
        raise ValueError("no more")
    return lagging(u, dt)
"""


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Write a module under a name of its own in every test."""

    def write(text):
        name = "unseen_" + tmp_path.name.replace("-", "_")
        (tmp_path / f"{name}.py").write_text(text)
        monkeypatch.syspath_prepend(tmp_path)
        return name

    return write


@pytest.fixture
def seen(module, tmp_path):
    """Hide effects, and the case's model in a function or in its output."""

    def hide(names, kind):
        case = make_case(
            CaseSpec(SEED, "single" if names else "none", names, "jiles-atherton", 20.0)
        )
        model = case.model.with_hold("band-limited")
        fit = first_halves(case)
        if kind == "column":
            fit = tuple(
                replace(item, simulated=model.simulate(item.u, item.dt)) for item in fit
            )
            base, _ = given_base(
                "column", Evidence("hidden", fit, (), simulated_column="s")
            )
            return fit, base
        case.model.save(tmp_path / "model.yaml")
        name = module(
            "from hystbench.model import load_model\n"
            f"MODEL = load_model({os.fspath(tmp_path / 'model.yaml')!r})\n"
            "def simulate(u, dt):\n"
            "    return MODEL.with_hold('band-limited').simulate(u, dt)\n"
        )
        base, _ = load_base(f"{name}:simulate", Evidence("hidden", fit, ()))
        return fit, base

    return hide


def test_a_loop_of_the_wrong_shape_is_no_effect(seen):
    fit, base = seen((), "column")
    content = search("hidden", fit, base).content
    assert (content["verdict"], content["effects"]) == ("no-gap", [])
    assert "not tried" not in content["reason"]  # there is no name to doubt
    assert {"drive-lag", "dead-zone"} <= set(content["not_tried"])


def test_a_curve_of_the_material_lies_behind_its_loop(seen):
    fit, base = seen(("saturation",), "function")
    curves = among(
        *("saturation", "asymmetry", "drive-saturation", "sensor-nonlinearity"),
        *("hysteresis-shape", "stiffness-hardening"),
    )
    content = search("hidden", fit, base, vocabulary=curves).content
    assert content["verdict"] == "named"
    (effect,) = content["effects"]
    assert (effect["name"], effect["place"]) == ("saturation", "material")
    assert content["not_tried"] == []


def test_beside_a_name_stands_what_a_stored_output_did_not_let_be_tried(tmp_path):
    """The drive's lag would do as well as the sensor's, but has to act before."""
    gain = block("gain", value=12.0)
    lagging = measured((gain, block("sensor-lag", time_constant_s=0.004)), 0.02)
    fit = tuple(replace(item, simulated=12.0 * item.u) for item in lagging)
    base, _ = given_base("column", Evidence("rig", fit, (), simulated_column="s"))
    decision = search("rig", fit, base, declared=0.02)
    assert decision.content["effects"][0]["name"] == "sensor-lag"
    assert "drive-lag" in decision.content["not_tried"]
    assert (
        "not tried, as the simulator cannot be run again: "
        in (decision.content["reason"])
    )
    told = write_next_experiment(decision, CURRENT, tmp_path / "next.csv")
    assert told.endswith("no effects that were tried need to be told apart")


@pytest.mark.parametrize("kind", ["lagging", "bent", "slow", "ringing", "charging"])
def test_a_simulator_that_forgets_or_is_linear_has_no_hysteresis(kind, module):
    chain = (External(function=f"{module(FUNCTIONS)}:{kind}"),)
    simulation = Simulation(chain, records())
    assert simulation.loop is None
    assert simulation.behind_hysteresis == 0
    assert reshapings(simulation, ScoredSamples.of(records(), 50)).shape[1] == 0
    assert Simulation((hysteresis(), *chain), records()).loop == 0


@pytest.mark.parametrize("kind", ["loose", "shy", "refuses"])
def test_a_simulator_that_remembers_may_be_of_a_wrong_shape(kind, module):
    """Or one that refuses to be asked; the way to ask begins where the records do."""
    chain = (External(function=f"{module(FUNCTIONS)}:{kind}"),)
    simulation = Simulation(chain, records())
    assert (simulation.loop, simulation.behind_hysteresis) == (0, 1)
    assert reshapings(simulation, ScoredSamples.of(records(), 50)).shape[1] > 0
    assert Simulation((block("gain", value=1.0), *chain), records()).loop == 1
    with pytest.raises(Declined, match="has a hysteresis already"):
        next(effects()["hysteresis"].variants(simulation))


def test_a_bias_of_the_field_is_looked_for_before_a_loop_that_is_not_seen(module):
    name = module(FUNCTIONS)
    base, _ = given_base(f"{name}:loose", Evidence("rig", records(), ()))
    given = tuple(
        replace(
            item,
            y=__import__(name).loose(2 * item.u + 0.25, item.dt)
            + 1e-3 * np.random.default_rng(k).standard_normal(len(item)),
        )
        for k, item in enumerate(records())
    )
    given = tuple(replace(item, u=2 * item.u) for item in given)
    likely = among(
        *("asymmetry", "saturation", "dead-zone", "hysteresis", "hysteresis-shape"),
        *("backlash", "calibration-error", "sensor-lag"),
    )
    content = search("rig", given, base, declared=1e-3, vocabulary=likely).content
    (effect,) = content["effects"]
    assert effect["name"] == "asymmetry"
    assert effect["parameters"]["bias"]["value"] == pytest.approx(0.25, abs=0.01)


def test_of_a_stored_output_it_is_not_known():
    made = record(sine(3.0), sine(3.0), simulated=2 * sine(3.0))
    base, _ = given_base("column", Evidence("made", (made,), (), simulated_column="s"))
    simulation = Simulation(base.chain, (made,))
    assert (simulation.loop, simulation.behind_hysteresis) == (0, 1)


def test_what_lies_behind_the_hysteresis_inside_is_spanned_too(module):
    """A curve of the output is no curve of the input where something delays it."""
    given = records()
    simulation = Simulation((External(function=f"{module(FUNCTIONS)}:loose"),), given)
    sample = ScoredSamples.of(given, 300)
    basis, _ = np.linalg.qr(reshapings(simulation, sample))
    curve = sample.take(tuple(np.sin(y) for y in simulation.output))
    rest = curve - basis @ (basis.T @ curve)
    assert np.std(rest) < 1e-2 * np.std(curve)


def test_a_function_is_called_once_for_the_same_samples(module):
    name = module(FUNCTIONS)
    simulator = External(function=f"{name}:lagging")
    u = sine(3.0, count=700)
    first = simulator.simulate(u, u, 1e-3)
    expected = first.copy()
    first[:] = 0.0  # what was given out is the caller's
    np.testing.assert_array_equal(simulator.simulate(u.copy(), u, 1e-3), expected)
    simulator.simulate(u, u, 2e-3)
    simulator.simulate(u + 1, u, 1e-3)
    calls = __import__(name).calls
    assert calls == [700] * 3
    lag = block("sensor-lag", time_constant_s=0.01)
    simulation = Simulation((simulator, lag), (record(u),))
    assert simulation.output[0].shape == (700,)
    assert len(calls) == 3

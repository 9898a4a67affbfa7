"""A chain on records: what is kept and reused equals a simulation from scratch."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.curve import finer
from hystbench.blocks.wrapping import Wrapped, WrappingBlock
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.small import MODE, block, chains, hysteresis, records, state_of

HOLDS = ("band-limited", "linear", "zero-order")


def from_scratch(chain):
    """What the model says, which knows nothing of scenes."""
    model = Model("whole", CURRENT, DISPLACEMENT, tuple(chain))
    return [model.simulate(one.u, one.dt) for one in records()]


def same(signals, others):
    for one, other in zip(signals, others, strict=True):
        size = np.abs(other).max()
        assert one == pytest.approx(other, abs=1e-11 * size)


@pytest.mark.parametrize("name", chains())
def test_stages_are_those_of_the_chain_cut_short(name):
    chain = chains()[name]
    simulation = Simulation(chain, records())
    same(simulation.at(0), [one.u for one in records()])
    for end in range(1, len(chain) + 1):
        same(simulation.at(end), from_scratch(chain[:end]))
    same(simulation.output, from_scratch(chain))


INSERTED = {
    "gain": block("gain", value=1.3, offset=0.1),
    "sensor-lag": block("sensor-lag", time_constant_s=3e-3),
    "backlash": block("backlash", half_width=0.2),
    "saturation": block("saturation", level=8.0),
}


@pytest.mark.parametrize("name", chains())
@pytest.mark.parametrize("inserted", INSERTED)
def test_a_tail_is_the_whole_changed_chain(name, inserted):
    chain = chains()[name]
    simulation = Simulation(chain, records())
    for place in range(len(chain) + 1):
        if place < len(chain) and isinstance(chain[place], WrappingBlock):
            continue  # nothing fits between a hysteresis and what wraps it
        blocks = (INSERTED[inserted], *chain[place:])
        same(simulation.tail(place, blocks), from_scratch((*chain[:place], *blocks)))


def test_a_wrapping_block_changes_the_chain_from_the_hysteresis_on():
    for form, before in (("growing-thresholds", ()), ("excess-field", ("drive-lag",))):
        drive = tuple(block(item, time_constant_s=2e-3) for item in before)
        chain = (*drive, hysteresis(), block("resonance", **MODE))
        around = block(
            "rate-dependent-hysteresis", coefficient=0.03, exponent=1.0, form=form
        )
        simulation = Simulation(chain, records())
        start = simulation.hysteresis
        blocks = (chain[start], around, *chain[start + 1 :])
        changed = (*chain[:start], *blocks)
        same(simulation.tail(start, blocks), from_scratch(changed))
        assert np.ptp(simulation.tail(start, blocks)[1] - simulation.output[1]) > 1e-3


@pytest.mark.parametrize("form", ["growing-thresholds", "excess-field"])
def test_what_wraps_a_hysteresis_is_tried_on_what_is_kept(form):
    """Whatever wraps it first: the outputs kept for one are no other's."""
    simulation = Simulation((hysteresis(), block("resonance", **MODE)), records())
    for coefficient in (0.02, 0.3, 0.02):
        around = block(
            "rate-dependent-hysteresis",
            coefficient=coefficient,
            exponent=0.5,
            form=form,
        )
        chain = (hysteresis(), around, block("resonance", **MODE))
        same(simulation.tail(0, chain), from_scratch(chain))
        # Another hysteresis, and signals that are not the simulation's own.
        other = replace(hysteresis(), weights=(0.5, 0.1, 0.2, 0.3))
        same(simulation.tail(0, (other, around)), from_scratch((other, around)))
        louder = tuple(1.5 * one.u for one in records())
        found = simulation.run((hysteresis(), around), louder)
        step = Wrapped(hysteresis(), around)
        pairs = zip(louder, records(), strict=True)
        wanted = [step.simulate(u, one.u, one.dt) for u, one in pairs]
        same(found, wanted)


def test_a_second_wrapping_block_goes_around_the_first():
    chain = chains()["wrapped"]
    simulation = Simulation(chain, records())
    assert simulation.hysteresis == 1
    assert simulation.behind_hysteresis == 3
    outer = block(
        "rate-dependent-hysteresis",
        coefficient=0.01,
        exponent=1.0,
        form="growing-thresholds",
    )
    blocks = (chain[1], chain[2], outer, chain[3])
    same(simulation.tail(1, blocks), from_scratch((chain[0], *blocks)))


@pytest.mark.parametrize("name", chains())
@pytest.mark.parametrize("hold", HOLDS)
def test_quick_with_its_correction_is_exact_for_the_chain_itself(name, hold):
    model = Model("whole", CURRENT, DISPLACEMENT, chains()[name]).with_hold(hold)
    state = state_of(model.chain, hold=hold)
    exact = Simulation(model.chain, records(), hold, "fine").output
    size = max(np.abs(y).max() for y in exact)
    residual = state.measured - state.sample.take(exact)
    assert state.residual == pytest.approx(residual, abs=1e-11 * size)


def test_plain_is_the_model_and_fine_steps_through_the_hysteresis_alone():
    model = Model("whole", CURRENT, DISPLACEMENT, chains()["hysteresis"])
    chain = model.with_hold("band-limited").chain
    same(Simulation(chain, records(), "band-limited").output, from_scratch(chain))
    wanted = []
    for one in records():
        u = finer(one.u, 8)
        wanted.append(model.simulate(u, one.dt / 8)[::8])
    same(Simulation(chain, records(), "band-limited", "fine").output, wanted)


def test_quick_is_not_exact_where_a_mode_takes_a_band_limited_signal():
    """Otherwise the test above would show nothing."""
    model = Model("whole", CURRENT, DISPLACEMENT, chains()["hysteresis and mode"])
    chain = model.with_hold("band-limited").chain
    quick, exact = (
        Simulation(chain, records(), steps=steps).output for steps in ("quick", "plain")
    )
    difference = np.abs(quick[1] - exact[1]).max()
    assert 1e-6 < difference < 0.05 * np.abs(exact[1]).max()


def test_a_staircase_is_smooth_behind_what_is_dynamic():
    model = Model("whole", CURRENT, DISPLACEMENT, chains()["wrapped"])
    simulation = Simulation(
        model.with_hold("zero-order").chain, records(), "zero-order"
    )
    assert simulation.hold_at(0) == "zero-order"
    assert [simulation.hold_at(place) for place in (1, 3, 4)] == ["linear"] * 3
    simulation = Simulation(
        model.with_hold("band-limited").chain, records(), "band-limited"
    )
    assert {simulation.hold_at(place) for place in range(5)} == {"band-limited"}


def test_what_effects_ask_of_a_scene():
    simulation = Simulation(chains()["gain"], records())
    assert simulation.hysteresis is None
    assert simulation.behind_hysteresis == 0
    assert simulation.step == 1 / 2000
    assert simulation.span == pytest.approx(1.5)
    assert simulation.shortest == pytest.approx(0.6)
    assert simulation.largest(0) == max(np.abs(one.u).max() for one in records())
    rates = [np.abs(np.diff(one.u) / one.dt).max() for one in records()]
    assert simulation.fastest() == pytest.approx(max(rates))


def place_of_mechanics(*chain):
    return Simulation(chain, records()).behind_material


def test_without_a_hysteresis_the_mechanics_stand_behind_every_curve():
    """What is linear may stand before a linear block, but not before a curve."""
    curve = block("asymmetry", coefficient=0.3)
    lag, gain = block("drive-lag", time_constant_s=2e-3), block("gain", value=2.0)
    sensor = block("sensor-nonlinearity", quadratic=0.1, cubic=0.0)
    assert place_of_mechanics(lag, gain) == 0
    assert place_of_mechanics(lag, curve, gain) == 2
    assert place_of_mechanics(block("drive-saturation", limit=1.0), lag) == 1
    assert place_of_mechanics(lag, sensor) == 0


def test_a_mode_that_is_not_linear_takes_longer_steps_where_models_are_compared():
    hardening = block("stiffness-hardening", coefficient=2e-3, **MODE)
    plain = Simulation((hysteresis(), hardening), records())
    for quick, exact in zip(
        replace(plain, steps="quick").output, plain.output, strict=True
    ):
        missed = np.abs(quick - exact).max() / np.ptp(exact)
        assert 0.0 < missed < 1e-3


@pytest.mark.parametrize("steps", ["quick", "fine"])
def test_a_mode_beside_others_takes_the_steps_that_it_takes_alone(steps):
    """Forces in a mode are simulated alike, whatever is added to its output."""
    mode = block("mechanism", mass=1e-3, damping=0.2, stiffness=4e3, hold="linear")
    force = block("stiffness", quadratic=0.0, cubic=5e7)
    modes = block(
        "other-modes", numerator=[2.0], denominator=[1.0, 3.0, 900.0], hold="linear"
    )

    def simulated(*chain):
        return Simulation(chain, records(), "linear", steps).output

    alone = simulated(mode, force)
    bare = [a - b for a, b in zip(simulated(mode, modes), simulated(mode), strict=True)]
    expected = [a + b for a, b in zip(alone, bare, strict=True)]
    same(simulated(mode, force, modes), expected)
    other = Simulation((mode, force), records(), "linear").output
    assert max(np.abs(a - b).max() for a, b in zip(alone, other, strict=True)) > 0.0


def test_models_of_a_chain_share_its_simulation():
    given = records()
    state = state_of((hysteresis(),), given)
    assert state.settled().simulation is state.simulation
    assert state.on(given[:1], state.sample.on([0]), slice(0, 3)).simulation is not (
        state.simulation
    )

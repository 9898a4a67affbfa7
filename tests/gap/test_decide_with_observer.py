"""A machine that a controller keeps from going astray, found beside an observer.

The plant is written here: a mass between two stops, small steps of symplectic Euler.
"""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from hystbench.gap import run, stages
from hystbench.gap.asked import Asked
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.decide_with_observer import FreeRun, with_observer
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.state import Free
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.observer import observer_for, with_observer_signal
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model, load_model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.made import evidence_of
from tests.gap.searched import among
from tests.gap.small import block, state_of

DT, FINE = 5e-4, 20
MASS, DAMPING, SPRING = 1e-5, 4e-4, 2.3  # N s2/mm, N s/mm, N/mm
GAP, CONTACT = 0.9, 15.0  # mm, N/mm
NOISE = 8.0  # mm/s
FORCE, VELOCITY = Channel("force", "N"), Channel("velocity", "mm/s")


def machine(reference, gain=4.0, rate_gain=0.004):
    """Force of a controller of position and speed, and the velocity that it makes."""
    h, fine = DT / FINE, np.repeat(reference, FINE)
    slope = np.gradient(fine, h)
    force, velocity = np.empty(len(fine)), np.empty(len(fine))
    q = v = 0.0
    for k, (wanted, rate) in enumerate(zip(fine.tolist(), slope.tolist(), strict=True)):
        f = gain * (wanted - q) + rate_gain * (rate - v)
        beyond = max(q - GAP, 0.0) + min(q + GAP, 0.0)
        force[k], velocity[k] = f, v
        v += h * (f - SPRING * q - CONTACT * beyond - DAMPING * v) / MASS
        q += h * v
    # What is slow against the sampling rate: its means over a sample.
    return tuple(x.reshape(-1, FINE).mean(axis=1) for x in (force, velocity))


def smooth(seed, count=1200):
    """A sum of sines that begins at rest."""
    rng, time = np.random.default_rng(seed), np.arange(count) * DT
    sines = sum(
        np.sin(2 * np.pi * f * time + rng.uniform(0, 6)) for f in rng.uniform(8, 90, 9)
    )
    return 0.55 * sines * np.minimum(time / 0.05, 1.0) ** 2


@pytest.fixture(scope="module")
def kept_in_place():
    rng, records = np.random.default_rng(5), []
    for seed, use in ((1, "fit"), (2, "fit"), (3, "hold-out")):
        u, v = machine(smooth(seed))
        y = v + NOISE * rng.standard_normal(len(v))
        about = FORCE, VELOCITY, "twin", use
        records.append(Record(f"run-{seed}", DT, u, y, *about))
    told = "band-limited", NOISE, "force", "velocity"
    return evidence_of("kept in place", records, *told)


def left(model, records):
    outputs = run_base(model, records, "band-limited")
    pairs = zip(records, outputs, strict=True)
    return np.sqrt(np.mean([np.mean((x.y - y) ** 2) for x, y in pairs]))


def true_model(damper=0.0):
    numbers = {"mass": MASS, "damping": DAMPING + damper, "stiffness": SPRING}
    mass = block("mechanism", output="velocity", **numbers)
    stop = block("stop", gap=GAP, contact_stiffness=CONTACT)
    return Model("true", FORCE, VELOCITY, (mass, stop))


def test_beside_an_observer_the_true_machine_leaves_noise_and_alone_it_does_not(
    kept_in_place,
):
    damper = observer_for(kept_in_place)
    own = with_observer_signal(kept_in_place, damper)
    assert left(true_model(), kept_in_place.fit) > 2 * NOISE
    assert left(true_model(damper), own.fit) < 1.1 * NOISE


@pytest.fixture(scope="module")
def decided(kept_in_place):
    asked = Asked(vocabulary=among("stop", "stiffness-hardening", "slider-with-gap"))
    return with_observer(kept_in_place.deciding, run._decide, asked, None)


def test_the_stop_is_named_with_its_numbers(kept_in_place, decided):
    _, shown = run.show(kept_in_place, decided[1])
    content, model = shown.content, shown.model
    assert content["verdict"] == "named"
    (effect,) = content["effects"]
    assert (effect["name"], effect["place"]) == ("stop", "inside")
    found = {name: x["value"] for name, x in effect["parameters"].items()}
    true = {"gap": GAP, "contact_stiffness": CONTACT}
    assert found == pytest.approx(true, rel=0.03)
    # The damper is in no number that a user gets.
    assert model.value("mechanism.damping") == pytest.approx(DAMPING, abs=1e-4)
    told = content["base_parameters"]["mechanism.damping"]["after"]
    assert told == pytest.approx(model.value("mechanism.damping"))
    assert content["gap"]["after"] < 1.2 * NOISE
    assert content["observer"]["sentence"] in content["reason"]
    assert content["observer"]["errors_grow"] > 2
    assert content["asked"]["without"] == list(decided[1].vocabulary.without)


def test_both_jobs_of_the_workflow_give_the_same(
    kept_in_place, decided, tmp_path, monkeypatch
):
    plain = replace(decided[1], damper=0.0)
    both = decided[0], replace(decided[1], plain=plain)
    monkeypatch.setattr(stages, "decide", lambda *args: both)
    first = true_model()
    stages.decide_in(tmp_path, kept_in_place.deciding, first, Asked())
    kept = stages._to_show_in(tmp_path, kept_in_place, decided[0].base)
    assert kept.first == decided[1].first
    assert (kept.damper, kept.plain.damper) == (decided[1].damper, 0.0)
    assert kept.plain.fitted.base.chain == plain.fitted.base.chain
    stages.show_in(tmp_path, kept_in_place, decided[0].base)
    _, shown = run.show(kept_in_place, decided[1])
    again = json.loads((tmp_path / "gap.json").read_text())
    assert again["gap"]["after"] == pytest.approx(shown.content["gap"]["after"])
    assert again["observer"] == shown.content["observer"]
    number = load_model(tmp_path / "model.yaml").value("mechanism.damping")
    assert number == pytest.approx(shown.model.value("mechanism.damping"))


def test_what_was_decided_without_it_stands_where_names_are_taken_back(
    kept_in_place, decided, monkeypatch
):
    plain = replace(decided[1], damper=0.0)

    def shown(given, evidence):
        taken = {"names": ["stop"]} if given.damper else None
        return run.Outcome(true_model(), {"withdrawn": taken}, [])

    monkeypatch.setattr(run, "show_on_hold_out", shown)
    _, outcome = run.show(kept_in_place, replace(decided[1], plain=plain))
    assert outcome.content["withdrawn"] is None
    # Without one to fall back on, what was taken back is told.
    _, outcome = run.show(kept_in_place, decided[1])
    assert outcome.content["withdrawn"]["names"] == ["stop"]


@pytest.mark.parametrize(
    ("verdict", "put_in", "identified", "tries"),
    [
        ("unnamed", (), True, True),
        ("named", (), True, False),
        ("no-gap", (), True, False),
        ("unnamed", ("stop",), True, False),
        ("unnamed", (), False, False),
    ],
)
def test_it_is_tried_where_nothing_is_named_beside_an_identified_base(
    kept_in_place, monkeypatch, verdict, put_in, identified, tries
):
    first = SimpleNamespace(content={"verdict": verdict}), None
    tried = []
    monkeypatch.setattr(run, "_decide", lambda *args: first)
    monkeypatch.setattr(run, "with_observer", lambda *args: tried.append(args))
    chain = (block("mechanism", mass=1.0, damping=1.0, stiffness=1.0),)
    kind = IdentifiedModel if identified else Model
    base = kind("base", FORCE, VELOCITY, chain, free=("mechanism.mass",))
    asked = Asked(vocabulary=Vocabulary.of(put_in=put_in))
    assert run.decide(kept_in_place, base, asked) is first
    assert bool(tried) == tries


@pytest.mark.parametrize("share", [0.999, 0.5])
def test_it_does_not_stand_where_a_free_run_takes_as_much_of_the_gap(
    kept_in_place, decided, monkeypatch, share
):
    """Names that a free run bears out were given up for one beside an observer."""
    told = {**decided[0].content, "fit": {"explained": 0.9}}
    other = replace(decided[0], content=told)
    plain = replace(decided[1], content={"fit": {"explained": share}}, damper=0.0)
    asked = Asked(vocabulary=among("stop"))
    found = with_observer(
        kept_in_place.deciding, lambda *_: (other, decided[1]), asked, plain
    )
    assert (found is None) == (share > 0.9)


def test_a_free_run_that_repeats_itself_speaks_against_a_model(kept_in_place):
    """Nothing grows in a mass that is damped much: what it leaves is its own error."""
    mass = block(
        "mechanism", mass=1e-5, damping=0.03, stiffness=SPRING, output="velocity"
    )
    rng, records = np.random.default_rng(2), []
    for one in kept_in_place.fit:
        noise = 0.01 * rng.standard_normal(len(one))
        records.append(replace(one, y=mass.simulate(one.u, one.u, one.dt) + noise))
    free = (Free(0, "damping"), Free(0, "stiffness"))

    def run_of(mass):
        state = state_of((mass,), tuple(records), free=free)
        return FreeRun.of(
            SimpleNamespace(state=state, floor=Floor(0.01, "stated")), 0.0
        )

    assert run_of(mass).may_be_grown_noise
    assert not run_of(replace(mass, stiffness=1.3 * SPRING)).may_be_grown_noise


def test_only_a_force_that_moves_something_is_observed(kept_in_place):
    for takes, gives in (("position", "force"), ("force", "acceleration")):
        other = replace(kept_in_place, quantities=Quantities(takes, gives))
        assert observer_for(other) is None


def test_a_velocity_is_taken_from_a_position():
    time, rate = np.arange(400) * DT, 2 * np.pi * 40
    swing = np.sin(rate * time)
    about = Channel("force", "N"), Channel("position", "mm"), "twin"
    one = Record("swing", DT, 3.0 * swing, swing, *about)
    given = evidence_of("swing", [one], "linear", None, "force", "position")
    (fit,) = with_observer_signal(given, 2.0).fit
    velocity = rate * np.cos(rate * time)
    assert fit.injected == pytest.approx(2.0 * velocity, abs=1e-2 * rate)
    assert observer_for(given) == pytest.approx(3.0 / rate, rel=0.01)
    np.testing.assert_array_equal(fit.driven, fit.u + fit.injected)
    thinned = fit.cut(slice(10, 90, 2))
    np.testing.assert_array_equal(thinned.injected, fit.injected[10:90:2])
    assert fit.digest != one.digest


def test_a_motion_that_is_counted_against_the_force_is_drawn_the_other_way(
    kept_in_place,
):
    turned = [replace(x, y=-x.y) for x in kept_in_place.fit]
    other = replace(kept_in_place, fit=tuple(turned))
    damper = observer_for(kept_in_place)
    assert observer_for(other) == pytest.approx(damper)
    both = (with_observer_signal(given, damper).fit for given in (kept_in_place, other))
    for mine, its in zip(*both, strict=True):
        np.testing.assert_allclose(mine.injected, its.injected)


def test_a_staircase_holds_the_mean_over_its_step(kept_in_place):
    held = replace(kept_in_place, input_hold="zero-order")
    (one, *_), (other, *_) = (
        with_observer_signal(kept_in_place, 2.0).fit,
        with_observer_signal(held, 2.0).fit,
    )
    between = (one.injected[:-1] + one.injected[1:]) / 2
    np.testing.assert_allclose(other.injected[:-1], between)

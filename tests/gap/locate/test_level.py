"""Level by level: classes of oscillators that are known, and a measured aircraft."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.locate import curves, locate
from hystbench.gap.locate.level import picture_of, take_levels
from hystbench.gap.locate.level_classes import CLASSES, beside_level
from hystbench.gap.locate.samples import take_samples
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.records.floor import noise_floor
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.schema import VIEW
from hystbench.model import load_model
from hystbench.record import Channel, Record
from hystbench.schema import check_against_schema
from tests.gap.oscillators import (
    DAMPING,
    DT,
    HERTZ,
    LEVELS,
    PERIOD,
    multisine,
    simulate,
)

AIRCRAFT = Path(__file__).parents[3].parent / "shared" / "data" / "f16-ground-vibration"
KINDS = {
    "linear": "none",
    "hardening": "hardening",
    "softening": "softening",
    "hysteresis": "micro-slip or hysteresis",
    "coulomb": "Coulomb friction",
    "clearance": "clearance",
    "before": "a static curve before or behind",
}
OUTPUTS = {"m": 1, "m/s": 2, "m/s^2": 3}


@pytest.fixture(scope="module")
def oscillators():
    return simulate()


def records(signals, unit="m", noise=1e-3, period=PERIOD, levels=LEVELS):
    """Records of one oscillator beside a simulation that is nothing."""
    rng = np.random.default_rng(0)
    found = []
    for k, level in enumerate(LEVELS):
        if level not in levels:
            continue
        u, y = signals[0, k], signals[OUTPUTS.get(unit, 1), k]
        y = y + noise * y.std() * rng.standard_normal(len(y))
        channels = Channel("force", "N"), Channel("output", unit)
        about = (f"level-{k}", DT, u.copy(), y, *channels, "measured", "fit", period)
        found.append(Compared(Record(*about), np.zeros(len(y))))
    return found


def moving(compared):
    return take_levels(take_samples(compared, noise_floor(compared)))


@pytest.fixture(scope="module")
def slipping(oscillators):
    """All views of the oscillator with a hysteretic spring."""
    compared = records(oscillators["hysteresis"])
    return locate(compared, noise_floor(compared))


@pytest.fixture(scope="module")
def hardening(oscillators):
    (mode,) = moving(records(oscillators["hardening"]))
    return mode


@pytest.mark.parametrize(
    ("kind", "unit"),
    [
        *((kind, "m/s^2") for kind in KINDS),
        *(("softening", unit) for unit in ("m", "V")),
        *((kind, "m") for kind in ("hardening", "clearance")),
    ],
)
def test_what_moves_tells_the_class(oscillators, kind, unit):
    (mode,) = moving(records(oscillators[kind], unit))
    assert mode.kind == KINDS[kind]
    assert CLASSES[mode.kind][0] in mode.sentence


@pytest.mark.parametrize(("left", "kind"), [(0.9, "hardening"), (0.1, "Coulomb")])
def test_a_stiffness_that_moves_more_than_the_damping_is_no_friction(
    hardening, left, kind
):
    """Of a stop that a sweep meets, the damping by power falls as well."""
    mode = hardening
    rate = mode.modes[0].power_damping * mode.modes[0].frequency
    fallen = [
        replace(
            x,
            power_damping=rate / x.frequency * left ** (k / 2),
            errors=np.full(4, 0.01),
        )
        for k, x in enumerate(mode.modes)
    ]
    found = replace(mode, modes=tuple(fallen))
    assert found.moved[:2] == (1, -1)
    assert found.kind.startswith(kind)


def test_a_spring_that_yields_more_than_the_damping_falls_is_softening(hardening):
    fallen = [
        replace(
            x,
            frequency=x.frequency * 0.9**k,
            power_damping=x.power_damping / 0.9**k * 0.95**k,
            errors=np.full(4, 0.01),
        )
        for k, x in enumerate([hardening.modes[0]] * len(hardening.modes))
    ]
    found = replace(hardening, modes=tuple(fallen))
    assert found.moved[:2] == (-1, -1)
    assert found.kind == "softening"


def test_levels_are_in_the_order_of_what_they_move(oscillators):
    """An input that is strong beside the mode moves it no farther."""
    compared = records(oscillators["hardening"])
    first = compared[0].record
    strong = 3 * LEVELS[0] * np.tile(multisine(low=30.0, high=60.0), 3)
    compared[0] = replace(compared[0], record=replace(first, u=first.u + strong))
    (mode,) = moving(compared)
    assert mode.inputs[0] > mode.inputs[1]
    assert len(mode.modes) == len(LEVELS)
    assert mode.kind == "hardening"
    assert "rises" in mode.sentence


@pytest.mark.parametrize("kind", ["linear", "hysteresis"])
def test_records_that_start_from_rest_and_noise_change_no_class(oscillators, kind):
    compared = records(oscillators[kind], "m/s", noise=0.05, period=None)
    (mode,) = moving(compared)
    assert mode.kind == KINDS[kind]


def test_numbers_of_a_linear_mode_are_right_within_their_errors(oscillators):
    (mode,) = moving(records(oscillators["linear"], noise=0.05))
    # A mass of one: a unit of force accelerates it by one.
    truth = np.array([HERTZ, DAMPING, DAMPING, 1.0])
    away = (mode.numbers / truth - 1) / mode.errors
    assert np.abs(away).max() < 4
    assert mode.errors[:, 0].max() < 0.01


def test_a_curved_spring_takes_no_power(hardening):
    """Its peak is wider than the damping makes it; power in is that of the damping."""
    third = hardening.modes[2]
    assert third.damping > 2 * DAMPING
    rate = third.power_damping * third.frequency
    assert abs(rate / (DAMPING * HERTZ) - 1) < 3 * third.errors[2]


def test_coulomb_friction_falls_with_the_motion(oscillators):
    """The equivalent damper of a force F in a motion v is sqrt(2 / pi) F / rms(v)."""
    signals = oscillators["coulomb"]
    (mode,) = moving(records(signals))
    speed = signals[2, :, PERIOD:].std(axis=1)
    added = np.sqrt(2 / np.pi) * 25.0 / speed / (2 * 2 * np.pi * HERTZ)
    assert mode.numbers[:, 2] == pytest.approx(DAMPING + added, rel=0.3)


@pytest.mark.parametrize(
    "compared",
    [
        lambda found: records(found["hardening"], levels=LEVELS[:2]),
        lambda found: [
            Compared(
                Record(
                    f"sine-{size}",
                    DT,
                    size * np.sin(2 * np.pi * 4 * DT * np.arange(PERIOD)),
                    size * np.cos(2 * np.pi * 4 * DT * np.arange(PERIOD)),
                    Channel("force", "N"),
                    Channel("output", "m"),
                    "measured",
                ),
                np.zeros(PERIOD),
            )
            for size in (1.0, 2.0, 3.0)
        ],
    ],
    ids=["two levels", "sines"],
)
def test_where_levels_show_nothing_there_is_no_view(oscillators, compared):
    found = compared(oscillators)
    assert moving(found) == ()
    found = locate(found, noise_floor(found))
    assert "level" not in {view.view for view in found}
    assert any("modes by level" in line for line in curves(found)["not_drawn"])


def test_levels_that_are_alike_are_one(oscillators):
    signals = oscillators["hardening"] * np.array([1.0, 1.05, 1.1, 1.15])[:, None]
    signals[0] *= (LEVELS[0] / np.array(LEVELS))[:, None]
    assert moving(records(signals)) == ()


def test_the_view_is_as_gap_json_has_it(slipping):
    (view,) = (item for item in slipping if item.view == "level")
    check_against_schema(view.to_mapping(), VIEW, "view")
    assert (view.start, view.end) == pytest.approx((LEVELS[0], LEVELS[-1]))
    assert view.p_value < 1e-6
    # The simulation is nothing: all of the motion near the mode is the gap.
    assert view.share_of_gap_power > 0.7
    assert "micro-slip" in view.sentence
    (picture,) = view.pictures
    json.dumps(asdict(picture), allow_nan=False)


def test_a_mode_that_stays_is_no_evidence(oscillators):
    compared = records(oscillators["linear"])
    views = locate(compared, noise_floor(compared))
    (view,) = (item for item in views if item.view == "level")
    assert view.p_value > 0.05
    assert beside_level(views, [("friction", "inside")]) == ""


def test_named_effects_are_held_against_how_modes_move(slipping):
    views = slipping
    told = beside_level(
        views, [("sensor-lag", "behind"), ("hysteretic-force", "inside")]
    )
    assert "micro-slip" in told
    assert told.endswith(": hysteretic-force can do so")
    for named in (("drag", "inside"), ("friction", "mechanics")):
        told = beside_level(views, [named])
        assert told.endswith(": no named effect can do so")
        assert beside_level(views, [named], little_left=True) == ""
    assert beside_level(views, []) == ""


def test_what_moves_a_mode_is_in_the_vocabulary():
    every = {name for _, names in CLASSES.values() for name in names}
    assert every <= {*effects()}
    assert [kind for kind, (_, names) in CLASSES.items() if not names] == ["none"]


def test_the_picture_has_axes_with_units(oscillators):
    """Frequency, damping and gain, each with the numbers of the mode and errors."""
    modes = moving(records(oscillators["hysteresis"]))
    picture = picture_of(modes, "N")
    axes = [(panel.x.unit, panel.y.name, panel.y.unit) for panel in picture.panels]
    assert axes == [
        ("N", "change of frequency", "%"),
        ("N", "damping ratio", "%"),
        ("N", "gain over the first", ""),
    ]
    frequency, damping, _ = (panel.series for panel in picture.panels)
    assert frequency[0].label.endswith("Hz: micro-slip or hysteresis")
    assert damping[0].y == pytest.approx(100 * modes[0].numbers[:, 2], rel=1e-5)
    errors = 100 * modes[0].errors[:, 2] * modes[0].numbers[:, 2]
    assert damping[0].error == pytest.approx(errors, rel=1e-5)


@pytest.mark.skipif(not AIRCRAFT.is_dir(), reason="the measurements are not here")
def test_the_bolted_joint_of_an_aircraft_slips():
    """Published: modes fall by .5 to 3 %, the damping of the first grows fourfold."""
    evidence = load_evidence(AIRCRAFT, "fit")
    base = load_model(AIRCRAFT / "modal-at-level-1.yaml")
    compared = [Compared(item, base.simulate(item.u, item.dt)) for item in evidence.fit]
    modes = moving(compared)
    assert {mode.kind for mode in modes} == {"micro-slip or hysteresis"}
    first = modes[0].numbers
    assert first[0, 0] == pytest.approx(7.3, abs=0.05)
    for mode in modes:
        change = mode.numbers[-1, 0] / mode.numbers[0, 0] - 1
        assert -0.03 < change < -0.005
    assert 3 < first[-1, 2] / first[0, 2] < 5

"""A linear base behind a drive that goes no faster than a rate."""

from functools import partial

import numpy as np
import pytest

from hystbench.gap import gap_search
from hystbench.gap.bases.linear import found_with
from hystbench.gap.bases.load import load_base
from hystbench.gap.bases.slow_drive import behind_a_slow_drive
from hystbench.gap.cache import Remembered, remembering
from hystbench.gap.records.evidence import Evidence
from hystbench.quantities import Quantities
from tests.gap.made import record, sine
from tests.gap.searched import among, search

DT, COUNT, RATE, LAG_S, NOISE = 1e-3, 1000, 20.0, 0.03, 0.002
FINE = 20
wave = partial(sine, count=COUNT, dt=DT)


def through(u, rate, falling=1.0):
    """What the drive and a lag make of an input, in twenty steps a sample."""
    now = out = 0.0
    found = []
    steps = np.interp(np.arange(FINE * len(u)) / FINE, np.arange(len(u)), u)
    for k, value in enumerate(steps.tolist()):
        if k % FINE == 0:
            found.append(out)
        now += max(min(value - now, rate * DT / FINE), -falling * rate * DT / FINE)
        out += (now - out) * -np.expm1(-DT / FINE / LAG_S)
    return 3.0 * np.array(found)


def device(rate, falling=1.0):
    random = np.random.default_rng(2)
    tones = wave(2.0) + 0.7 * wave(5.1) + 0.4 * wave(11.3)
    inputs = {"slow": wave(0.5), "fast": wave(8.0), "tones": 0.6 * tones}
    records = []
    for name, u in inputs.items():
        y = through(u, rate, falling) + NOISE * random.standard_normal(len(u))
        records.append(record(u, y, name=name, dt=DT))
    return Evidence("made", tuple(records), (), "linear")


@pytest.fixture(scope="module")
def limited():
    return device(RATE)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return Remembered(tmp_path_factory.mktemp("kept"), print)


@pytest.fixture(scope="module")
def loaded(limited, kept):
    """The base, with the note about it; it is kept."""
    with remembering(kept):
        return load_base("linear", limited)


def test_the_rate_is_that_of_the_drive(limited):
    found = behind_a_slow_drive(limited)
    assert found is not None
    slowed, drive = found
    assert (drive.rate, drive.falling) == (pytest.approx(RATE, rel=0.02), 0.0)
    steepest = max(np.abs(np.diff(x.u)).max() for x in slowed.fit)
    assert steepest <= drive.rate * DT * (1 + 1e-9)


def test_a_drive_may_fall_at_another_rate_than_it_rises():
    _, drive = behind_a_slow_drive(device(RATE, 1.6))
    assert drive.rate == pytest.approx(RATE, rel=0.02)
    assert drive.falling == pytest.approx(1.6 * RATE, rel=0.02)


def test_without_a_limit_there_is_none():
    assert behind_a_slow_drive(device(1e3)) is None


def test_the_base_is_what_is_behind_the_drive(loaded):
    model, note = loaded
    assert "behind a drive of" in note
    assert "without that limit" in note
    lag = model.chain[0]
    assert len(lag.denominator) == 2
    assert lag.denominator[0] / lag.denominator[1] == pytest.approx(LAG_S, rel=0.02)
    assert lag.numerator[-1] / lag.denominator[-1] == pytest.approx(3.0, rel=0.01)


def test_the_limit_is_named_and_no_force_looked_for(limited, loaded, monkeypatch):
    def look(*_):
        raise AssertionError("forces were looked for")

    monkeypatch.setattr(gap_search, "named_inside", look)
    base = loaded[0].with_hold("linear")
    found = search(
        *("made", limited.fit, base, "linear"),
        vocabulary=among("slew-limit", "drive-lag", "drive-saturation", "friction"),
        quantities=Quantities("force", "position"),
    )
    (effect,) = found.content["effects"]
    assert (found.content["verdict"], effect["name"]) == ("named", "slew-limit")
    rate = effect["parameters"]["rate"]["value"]
    assert rate == pytest.approx(RATE, rel=0.02)


def test_a_base_that_was_kept_is_found_beside_the_same(limited, loaded, kept):
    with remembering(kept):
        again, _ = load_base("linear", limited)
    assert kept.found
    assert found_with(loaded[0]) == found_with(again) == "slew-limit"

"""What the pictures draw, against what was put in."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.gap.floor import noise_floor
from hystbench.gap.locate import curves
from tests.gap.examples import DT, compare, gap_of, hysteretic, inputs, straight


def lists_of(value):
    if isinstance(value, dict):
        for one in value.values():
            yield from lists_of(one)
    elif isinstance(value, list):
        yield value
        for one in value:
            yield from lists_of(one)


def test_curves_are_small_and_are_json():
    compared, _ = gap_of("backlash", hysteretic)
    found = curves(compared, noise_floor(compared))
    text = json.dumps(found, allow_nan=False)
    assert len(text) < 60_000
    assert max(len(one) for one in lists_of(found)) <= 200
    assert set(found) == {
        "units",
        "response",
        "spectrum",
        "over_input",
        "over_rate",
        "slow",
        "records",
        "harmonics",
    }
    assert found["units"] == {"input": "A", "output": "um"}


def test_the_response_is_that_of_the_mode():
    compared, _ = gap_of("resonance", straight)
    response = curves(compared, noise_floor(compared))["response"]
    frequency = np.array(response["frequency"])
    s = 2j * np.pi * frequency
    wn = 2 * np.pi * 70
    truth = 0.9 + 0.1 * wn**2 / (s**2 + 0.08 * wn * s + wn**2)
    # Away from the peak, which a bin of the axis may not resolve.
    clear = (np.abs(frequency - 70) > 10) & (frequency < 150) & (frequency > 10)
    assert np.array(response["magnitude"])[clear] == pytest.approx(
        np.abs(truth)[clear], abs=0.05
    )
    assert np.array(response["phase"])[clear] == pytest.approx(
        np.degrees(np.angle(truth))[clear], abs=4
    )
    assert np.median(response["coherence"]) > 0.99


def test_the_floor_is_the_density_of_the_noise():
    compared, noise = gap_of("resonance", straight)
    spectrum = curves(compared, noise_floor(compared))["spectrum"]
    density = noise * np.sqrt(2 * DT)
    assert spectrum["floor"] == pytest.approx(
        [density] * len(spectrum["floor"]), rel=0.1
    )
    high = np.array(spectrum["frequency"]) > 500
    assert np.median(np.array(spectrum["residual"])[high]) == pytest.approx(
        density, rel=0.1
    )


def test_maps_show_friction_as_a_step_and_loop_area_is_four_times_it():
    t = np.arange(4000) * DT
    u = np.sin(2 * np.pi * 5 * t)
    y = 6 * u + 0.4 * np.sign(np.cos(2 * np.pi * 5 * t))
    compared = [compare("sine", u, y, 6 * u, 400)]
    found = curves(compared, noise_floor(compared))
    over = found["over_input"]
    middle = slice(5, -5)
    assert over["rising"][middle] == pytest.approx([0.4] * 30, abs=1e-6)
    assert over["falling"][middle] == pytest.approx([-0.4] * 30, abs=1e-6)
    # Higher while rising is the sense of a lead, not of a lag: negative.
    area = found["records"]["loop_area"][0]
    assert area == pytest.approx(-4 * 0.4, rel=0.02)


def test_slow_paths_follow_a_drift_and_shares_add_to_one():
    found = []
    for i, (name, u, period) in enumerate(inputs(4000)):
        t = np.arange(len(u)) * DT
        found.append(compare(name, u, 6 * u + i * t, 6 * u, period))
    drawn = curves(found, noise_floor(found))
    for i, slow in enumerate(drawn["slow"]):
        assert slow["residual"] == pytest.approx(
            i * np.array(slow["time"]), abs=i * DT + 1e-9
        )
    assert sum(drawn["records"]["share"]) == pytest.approx(1)


def test_even_distortion_lies_on_even_harmonics():
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    for power, kind in ((2, "even"), (3, "odd")):
        y = 6 * u + 0.1 * u**power
        compared = [compare("sine", u, y, 6 * u, 400)]
        harmonics = curves(compared, noise_floor(compared))["harmonics"]
        # sin^2 has its second harmonic alone; sin^3 a ninth of it in its third.
        expected = {"even": 1.0, "odd": 0.1}[kind]
        assert harmonics[kind] == pytest.approx(expected, abs=1e-6)
        assert sum(harmonics.values()) == pytest.approx(1)


def test_distortion_of_records_weighs_by_their_samples():
    long, short = (np.sin(2 * np.pi * np.arange(n) / 400) for n in (4000, 800))
    compared = [
        compare("even", long, 6 * long + 0.1 * long**2, 6 * long, 400),
        compare("odd", short, 6 * short + 0.1 * short**3, 6 * short, 400),
    ]
    harmonics = curves(compared, noise_floor(compared))["harmonics"]
    # Variances of sin^2 / 10, and of the third harmonic and all of sin^3 / 10.
    even, third, cube = 0.01 / 8, 0.025**2 / 2, 0.025**2 / 2 + 0.075**2 / 2
    whole = 4000 * even + 800 * cube
    assert harmonics["even"] == pytest.approx(4000 * even / whole)
    assert harmonics["odd"] == pytest.approx(800 * third / whole)


def test_no_record_is_refused():
    compared, _ = gap_of("friction", straight)
    with pytest.raises(InputError, match="at least one record"):
        curves([], noise_floor(compared))

"""What the pictures draw, against what was put in."""

from __future__ import annotations

import json

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.gap.floor import noise_floor
from hystbench.gap.locate import curves
from tests.gap.examples import (
    DT,
    compare,
    gap_of,
    hysteretic,
    inputs,
    plain_play,
    straight,
)


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
        "over_plane",
        "slow",
        "records",
        "harmonics",
        "distortion",
        "loops",
        "coherence",
        "levels",
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
    # Of ten periods the first is the way from rest; of two both count.
    whole = 3600 * even + 800 * cube
    assert harmonics["even"] == pytest.approx(3600 * even / whole)
    assert harmonics["odd"] == pytest.approx(800 * third / whole)


def test_lines_of_an_input_of_odd_and_even_lines_are_not_told_apart():
    """u^2 of lines 1 and 2 lies on 1, 2, 3 and 4: an odd line is no odd distortion."""
    angle = 2 * np.pi * np.arange(4000) / 400
    u = np.sin(angle) + np.sin(2 * angle)
    compared = [compare("two", u, 6 * u + 0.1 * u**2, 6 * u, 400)]
    found = curves(compared, noise_floor(compared))
    # u^2 = 1 + cos 1 - cos 2 / 2 - cos 3 - cos 4 / 2, the mean left out.
    assert found["harmonics"]["either"] == pytest.approx(1.25 / 2.5)
    assert found["harmonics"]["odd"] == found["harmonics"]["even"] == 0
    lines = found["distortion"]["lines"]
    assert lines["excited"]["frequency"] == pytest.approx([5, 10])
    assert lines["either"]["amplitude"][:2] == pytest.approx([0.1, 0.05], rel=1e-4)


def test_noise_on_a_measured_input_is_no_line_of_it():
    rng = np.random.default_rng(0)
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    y = 6 * u + 0.1 * u**2
    noisy = u + 0.02 * rng.standard_normal(4000)
    compared = [compare("sine", noisy, y, 6 * u, 400)]
    found = curves(compared, noise_floor(compared))
    assert found["distortion"]["lines"]["excited"]["frequency"] == [5]
    assert found["harmonics"]["even"] == pytest.approx(1)


def test_the_way_from_rest_is_no_distortion():
    """A play from rest starts in the middle of its loop; after that it is odd."""
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    compared = [compare("sine", u, 6 * plain_play(u, 0.4), 6 * u, 400)]
    harmonics = curves(compared, noise_floor(compared))["harmonics"]
    assert harmonics["even"] < 1e-9
    assert harmonics["odd"] > 0.01


def test_loop_areas_are_those_of_ellipses():
    """Pi a b sin(phase), at each sine's frequency, whatever the noise on top."""
    t = np.arange(4000) * DT
    rng = np.random.default_rng(0)
    compared, areas = [], []
    for hertz, size, measured, simulated in (
        (1, 1.0, 0.3, 0.2),
        (10, 0.5, 0.1, 0.4),
        (100, 0.8, 0.5, 0.0),
    ):
        angle = 2 * np.pi * hertz * t
        y, s = (4 * size * np.sin(angle - phase) for phase in (measured, simulated))
        y += 0.01 * rng.standard_normal(len(t))
        period = round(1 / hertz / DT)
        u = size * np.sin(angle)
        compared.append(compare(f"sine-{hertz}", u, y, s, period))
        areas.append(4 * np.pi * size**2 * np.sin([measured, simulated]))
    loops = curves(compared, noise_floor(compared))["loops"]
    assert loops["frequency"] == pytest.approx([1, 10, 100])
    assert loops["simulated"] == pytest.approx([s for _, s in areas], abs=1e-4)
    off = np.array(loops["measured"]) - [m for m, _ in areas]
    assert np.all(np.abs(off) < 4 * np.array(loops["error"]))
    # The noise of an area: 2 pi a / sqrt(2) times that of a Fourier coefficient.
    least = 2 * np.pi * np.array([1, 0.5, 0.8]) * 0.01 / np.sqrt(2 * 4000)
    assert np.all(np.array(loops["error"]) > 0.9 * least)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.7, 1.0])
def test_the_coherent_share_is_that_of_the_part_made_by_the_input(share):
    rng = np.random.default_rng(1)
    u, other = rng.standard_normal((2, 40_000))
    residual = np.sqrt(share) * u + np.sqrt(1 - share) * other
    compared = [compare("noise", u, 6 * u + residual, 6 * u)]
    found = curves(compared, noise_floor(compared, 1e-3))["coherence"]
    # 40,000 facts in groups of a few: their mean is sure to about a hundredth.
    assert found["share"] == pytest.approx(share, abs=0.03)
    above = np.mean(np.array(found["coherence"]) > np.array(found["chance"]))
    assert above < 0.12 if share == 0 else above > 0.2


def test_a_tone_beside_the_input_takes_its_own_share_of_coherence():
    """Two incoherent parts: a gain error and a tone where the input is silent."""
    t = np.arange(8000) * DT
    u = np.sin(2 * np.pi * 20 * t)
    tone = 0.2 * np.sin(2 * np.pi * 333.3 * t)
    compared = [compare("sine", u, 6.1 * u + tone, 6 * u)]
    found = curves(compared, noise_floor(compared, 1e-3))["coherence"]
    assert found["share"] == pytest.approx(0.1**2 / (0.1**2 + 0.2**2), abs=0.01)


def test_no_record_is_refused():
    compared, _ = gap_of("friction", straight)
    with pytest.raises(InputError, match="at least one record"):
        curves([], noise_floor(compared))

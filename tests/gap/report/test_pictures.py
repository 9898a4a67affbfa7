"""What the pictures of where the gap is draw, against what was put in."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from hystbench.gap.locate import curves as curves_of
from hystbench.gap.locate import locate
from hystbench.gap.locate.distortion import EITHER, EVEN, ODD, take_distortion
from hystbench.gap.locate.picture import (
    LEAST_SAMPLES,
    MAP_COLUMNS,
    over_plane,
    rate_edges,
)
from hystbench.gap.locate.samples import take_samples
from hystbench.gap.records.floor import noise_floor
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.report.where_pictures import LOOKS
from tests.gap.examples import (
    DT,
    compare,
    gap_of,
    hysteretic,
    inputs,
    plain_play,
    straight,
)
from tests.gap.made import record


def picture(compared, name, floor=None):
    curves = curves_of(locate(compared, noise_floor(compared, floor)))
    return next(one for one in curves["pictures"] if one["name"] == name)


def lines_of(panel):
    return {one["role"]: one for one in panel["series"]}


def lists_of(value):
    if isinstance(value, dict):
        for one in value.values():
            yield from lists_of(one)
    elif isinstance(value, list | tuple):
        yield value
        for one in value:
            yield from lists_of(one)


def test_curves_are_small_and_are_json():
    compared, _ = gap_of("backlash", hysteretic)
    found = curves_of(locate(compared, noise_floor(compared)))
    assert len(json.dumps(found, allow_nan=False)) < 60_000
    assert max(len(one) for one in lists_of(found)) <= 200
    names = {one["name"] for one in found["pictures"]}
    drawn = {"spectrum", "response", "distortion", "over-input", "over-plane"}
    assert names == drawn | {"slow", "records"}
    assert [line.split(",")[0] for line in found["not_drawn"]] == ["modes by level"]
    roles = [
        series["role"]
        for one in found["pictures"]
        for panel in one["panels"]
        for series in panel["series"]
    ]
    assert set(roles) <= set(LOOKS)


def test_the_response_is_that_of_the_mode():
    compared, _ = gap_of("resonance", straight)
    magnitude, phase, _ = picture(compared, "response")["panels"]
    found = lines_of(magnitude)["measurement"]
    frequency = np.array(found["x"])
    s = 2j * np.pi * frequency
    wn = 2 * np.pi * 70
    truth = 0.9 + 0.1 * wn**2 / (s**2 + 0.08 * wn * s + wn**2)
    # Away from the peak, which a bin of the axis may not resolve.
    clear = (np.abs(frequency - 70) > 10) & (frequency < 150) & (frequency > 10)
    assert np.array(found["y"])[clear] == pytest.approx(np.abs(truth)[clear], abs=0.05)
    turned = np.array(lines_of(phase)["measurement"]["y"])
    assert turned[clear] == pytest.approx(np.degrees(np.angle(truth))[clear], abs=4)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_gap_is_as_coherent_as_the_part_that_the_input_makes(share):
    rng = np.random.default_rng(1)
    u, other = rng.standard_normal((2, 40_000))
    residual = np.sqrt(share) * u + np.sqrt(1 - share) * other
    compared = [compare("noise", u, 6 * u + residual, 6 * u)]
    *_, coherence = picture(compared, "response", 1e-3)["panels"]
    found = np.array(coherence["series"][0]["y"][-50:])
    assert np.median(found) == pytest.approx(share, abs=0.05)


def test_the_floor_is_the_density_of_the_noise():
    compared, noise = gap_of("resonance", straight)
    (panel,) = picture(compared, "spectrum")["panels"]
    lines = lines_of(panel)
    density = noise * np.sqrt(2 * DT)
    assert lines["noise"]["y"] == pytest.approx(
        [density] * len(lines["noise"]["y"]), rel=0.1
    )
    high = np.array(lines["residual"]["x"]) > 500
    above = np.median(np.array(lines["residual"]["y"])[high])
    assert above == pytest.approx(density, rel=0.15)


def test_the_map_over_the_input_shows_friction_as_a_step():
    t = np.arange(4000) * DT
    u = np.sin(2 * np.pi * 5 * t)
    y = 6 * u + 0.4 * np.sign(np.cos(2 * np.pi * 5 * t))
    (panel,) = picture([compare("sine", u, y, 6 * u, 400)], "over-input")["panels"]
    lines = lines_of(panel)
    middle = slice(5, -5)
    assert lines["rising"]["y"][middle] == pytest.approx([0.4] * 30, abs=1e-6)
    assert lines["falling"]["y"][middle] == pytest.approx([-0.4] * 30, abs=1e-6)


def test_slow_paths_follow_a_drift_and_shares_add_to_one():
    found = []
    for i, (name, u, period) in enumerate(inputs(4000)):
        t = np.arange(len(u)) * DT
        found.append(compare(name, u, 6 * u + i * t, 6 * u, period))
    (slow,) = picture(found, "slow")["panels"]
    for i, series in enumerate(slow["series"]):
        at = np.array(series["x"]) - series["x"][0]
        rise = np.array(series["y"]) - series["y"][0]
        assert rise == pytest.approx(i * at, abs=1e-4)
    (bars,) = picture(found, "records")["panels"]
    assert sum(bars["bars"]["values"]) == pytest.approx(100)


def shares_of(compared):
    samples = take_samples(compared, noise_floor(compared))
    return take_distortion(samples).shares


def test_distortion_of_records_weighs_by_their_samples():
    long, short = (np.sin(2 * np.pi * np.arange(n) / 400) for n in (4000, 800))
    shares = shares_of(
        [
            compare("even", long, 6 * long + 0.1 * long**2, 6 * long, 400),
            compare("odd", short, 6 * short + 0.1 * short**3, 6 * short, 400),
        ]
    )
    # Variances of sin^2 / 10, and of the third harmonic and all of sin^3 / 10.
    even, third, cube = 0.01 / 8, 0.025**2 / 2, 0.025**2 / 2 + 0.075**2 / 2
    # Of ten periods the first is the way from rest; of two both count.
    whole = 3600 * even + 800 * cube
    assert shares[EVEN] == pytest.approx(3600 * even / whole)
    assert shares[ODD] == pytest.approx(800 * third / whole)
    assert shares.sum() == pytest.approx(1)


def test_lines_of_an_input_of_odd_and_even_lines_are_not_told_apart():
    """u^2 of lines 1 and 2 lies on 1, 2, 3 and 4: an odd line is no odd distortion."""
    angle = 2 * np.pi * np.arange(4000) / 400
    u = np.sin(angle) + np.sin(2 * angle)
    compared = [compare("two", u, 6 * u + 0.1 * u**2, 6 * u, 400)]
    shares = shares_of(compared)
    # u^2 = 1 + cos 1 - cos 2 / 2 - cos 3 - cos 4 / 2, the mean left out.
    assert shares[EITHER] == pytest.approx(1.25 / 2.5)
    assert shares[ODD] == shares[EVEN] == 0
    (panel,) = picture(compared, "distortion")["panels"]
    lines = lines_of(panel)
    assert lines["own lines"]["x"] == pytest.approx([5, 10])
    assert lines["other lines"]["y"][:2] == pytest.approx([0.1, 0.05], rel=1e-4)


def test_noise_on_a_measured_input_is_no_line_of_it():
    rng = np.random.default_rng(0)
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    noisy = u + 0.02 * rng.standard_normal(4000)
    compared = [compare("sine", noisy, 6 * u + 0.1 * u**2, 6 * u, 400)]
    assert shares_of(compared)[EVEN] == pytest.approx(1)


def test_the_way_from_rest_is_no_distortion():
    """A play from rest starts in the middle of its loop; after that it is odd."""
    u = np.sin(2 * np.pi * np.arange(4000) / 400)
    shares = shares_of([compare("sine", u, 6 * plain_play(u, 0.4), 6 * u, 400)])
    assert shares[EVEN] < 1e-9
    assert shares[ODD] > 0.01


def plane_of(residual):
    """The map where the measurement is off by a function of input and rate."""
    compared = []
    for name, u, _ in inputs():
        rate = np.gradient(u, DT)
        y = straight(u) + residual(u, rate)
        noise = 0.01 * np.random.default_rng(len(compared)).standard_normal(len(u))
        one = record(u, y + noise, name=name, dt=DT)
        compared.append(Compared(one, straight(u)))
    samples = take_samples(compared, noise_floor(compared, 0.01))
    return over_plane(samples), samples


def held(found):
    return int(re.search(r"hold (\d+) % of the gap", found.words)[1])


def centres(edges):
    return 0.5 * (np.array(edges[1:]) + np.array(edges[:-1]))


def test_cells_hold_the_mean_of_what_depends_on_both():
    """A product of amplitude and sign of the rate: zero over either alone."""
    found, _ = plane_of(lambda u, rate: 0.5 * u * np.sign(rate))
    cells = found.panels[0].cells
    values = np.array(cells.values, dtype=float)
    u, rate = centres(cells.columns), centres(cells.rows)
    wanted = 0.5 * np.outer(np.sign(rate), u)
    there = np.isfinite(values)
    assert there.mean() > 0.5
    width = cells.columns[1] - cells.columns[0]
    assert np.abs(values - wanted)[there].max() < 0.5 * 0.5 * width + 0.01
    assert held(found) > 90


def test_what_depends_on_neither_is_not_held():
    hum = iter(np.random.default_rng(3).standard_normal((50, 4000)))
    found, _ = plane_of(lambda u, rate: 0.3 * next(hum)[: len(u)])
    assert held(found) < 5


def test_edges_are_alike_for_both_signs_and_hold_equally_many():
    speed = np.random.default_rng(0).standard_normal(60_000) ** 3
    edges = rate_edges(speed)
    assert edges == pytest.approx(-edges[::-1])
    counts, _ = np.histogram(np.abs(speed), edges[len(edges) // 2 :])
    assert counts == pytest.approx(np.full(6, 10_000), abs=2)


def test_cells_of_few_samples_hold_nothing():
    found, samples = plane_of(lambda u, rate: 0.5 * u)
    cells, u, speed = found.panels[0].cells, samples.input, samples.speed
    for row, low in enumerate(cells.rows[:-1]):
        high = cells.rows[row + 1]
        for column in range(MAP_COLUMNS):
            left, right = cells.columns[column : column + 2]
            # What stands on an edge may be in either of two cells.
            wide = (u >= left) & (u <= right) & (speed >= low) & (speed <= high)
            tight = (u > left) & (u < right) & (speed > low) & (speed < high)
            if np.sum(wide) < LEAST_SAMPLES:
                assert cells.values[row][column] is None
            if np.sum(tight) >= LEAST_SAMPLES:
                assert cells.values[row][column] is not None


def test_an_input_that_never_moves_has_no_map():
    one = record(np.zeros(500), np.random.default_rng(0).standard_normal(500), dt=DT)
    compared = [Compared(one, np.zeros(500))]
    assert over_plane(take_samples(compared, noise_floor(compared, 0.5))) is None

"""Dropouts, spikes and error codes are found, and nothing that a signal does itself."""

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.inspection.check import check
from hystbench.inspection.lone import lone_samples
from tests.gap.made import record
from tests.inspection.made import loop, sine, write

COUNT = 4000
K = np.arange(COUNT)
RNG = np.random.default_rng(0)
NOISE = 0.01 * RNG.standard_normal(COUNT)
SLOW = np.sin(K / 40) + 0.4 * np.sin(K / 17)
NOTHING = {"input": [], "output": []}


def with_bad(values, **places):
    """Put values at places: ``at_700=45.0``."""
    spoilt = values.copy()
    for place, bad in places.items():
        bad = np.atleast_1d(bad)
        first = int(place.removeprefix("at_"))
        spoilt[first : first + len(bad)] = bad
    return spoilt


@pytest.mark.parametrize(
    ("bad", "found"),
    [
        ({"at_700": 45.0}, [(700, 701)]),
        ({"at_700": 45.0, "at_1510": [-60.0, 80.0]}, [(700, 701), (1510, 1512)]),
        ({"at_300": [9999.9] * 3}, [(300, 303)]),
        # What lies between two of them is sound.
        ({"at_700": 45.0, "at_704": -45.0}, [(700, 701), (704, 705)]),
        ({"at_700": 45.0, "at_705": 45.0}, [(700, 701), (705, 706)]),
        ({"at_700": 45.0, "at_707": 45.0}, [(700, 701), (707, 708)]),
        ({"at_700": 45.0, "at_708": 45.0}, [(700, 701), (708, 709)]),
        # Six in a row are a channel that is stuck.
        ({"at_700": [45.0] * 6}, []),
        # One of four is no farther off than the signal goes: it lies between others.
        ({"at_1400": [-30.0, 42.0, 17.0, 1.0, -8.0]}, [(1400, 1405)]),
    ],
)
def test_bad_samples_are_found_with_their_places(bad, found):
    y = with_bad(5 * SLOW + NOISE, **bad)
    assert lone_samples(record(SLOW, y)) == NOTHING | {"output": found}


def test_a_bad_sample_of_the_input_is_one_of_the_input():
    u = with_bad(SLOW + NOISE, at_900=30.0)
    assert lone_samples(record(u, SLOW)) == NOTHING | {"input": [(900, 901)]}


def test_dropouts_of_a_channel_that_is_coarsely_digitized_are_found():
    coarse = np.round(3 + SLOW, 1)
    y = with_bad(coarse, at_2000=0.0)
    assert lone_samples(record(SLOW, y)) == NOTHING | {"output": [(2000, 2001)]}


def test_a_coarse_input_excuses_no_bad_sample_of_the_output():
    y = with_bad(SLOW + NOISE, at_2000=30.0)
    found = lone_samples(record(np.round(SLOW, 1), y))
    assert found == NOTHING | {"output": [(2000, 2001)]}


@pytest.mark.parametrize(
    "y",
    [
        SLOW,
        RNG.standard_normal(COUNT),
        RNG.laplace(size=COUNT),
        np.abs(K % 200 - 100.0),
        (K % 200) / 100.0,
        1.0 * (K % 400 < 100),
        np.exp(-(K % 400) / 30.0),
        np.repeat(RNG.standard_normal(40), 100) + NOISE,
        np.round(SLOW * 20) / 20,
        np.sin(K / 1.1),
    ],
    ids=[
        *("smooth", "white", "spiky-noise", "triangle", "saw", "pulses", "decays"),
        *("stairs", "coarse", "fast"),
    ],
)
def test_what_a_signal_does_itself_is_none(y):
    assert lone_samples(record(SLOW + NOISE, y)) == NOTHING


def test_a_burst_is_none():
    y = SLOW + NOISE
    y[1000:1030] += 8 * np.sin(K[:30] * 2.0)
    assert lone_samples(record(SLOW, y)) == NOTHING


def test_what_answers_a_jump_of_the_input_is_none():
    # What passes changes only, as a capacitor does, gives a spike for each step.
    u = np.repeat([0.0, 1.0, 3.0, 2.0], COUNT // 4)
    y = 50 * np.diff(u, prepend=0.0) + NOISE
    assert lone_samples(record(u, y)) == NOTHING


def test_what_comes_often_belongs_to_the_signal():
    y = SLOW + NOISE
    y[50::60] += 40.0
    assert lone_samples(record(SLOW, y)) == NOTHING


def of_lone(found):
    return [item for item in found.findings if item.topic.startswith("lone")]


def records():
    made = {f"sine-{hz}": sine(hz) for hz in (5, 10, 20)}
    return {
        name: (u, loop(u) + 0.01 * RNG.standard_normal(len(u)))
        for name, u in made.items()
    }


def test_record_rows_and_the_line_for_it_are_told(tmp_path):
    made = records()
    made["sine-10"][1][[425, 426, 700]] = 0.0, 0.0, 99.9
    place = write(tmp_path, made, roles={"sine-5": "hold-out"})
    (told,) = of_lone(check(load_dataset(place), effects=False))
    # Row 1 is the header, so sample 425, from 0, stands in row 427.
    assert told.text.startswith("sine-10: displacement has lone samples, ")
    assert "in row 427 to 428 and row 702." in told.text
    assert "make such samples missing" in told.text
    assert told.paste == ("- {file: sine-10.csv, use: fit, missing: interpolate}",)


def test_a_record_that_is_mended_so_is_sound(tmp_path):
    made = records()
    y = made["sine-10"][1]
    y[700] = 99.9
    place = write(tmp_path, made)
    (told,) = of_lone(check(load_dataset(place), effects=False))
    file = tmp_path / "sine-10.csv"
    file.write_text(file.read_text().replace(",99.9\n", ",\n"))
    text = place.read_text().replace("- {file: sine-10.csv, use: fit}", told.paste[0])
    place.write_text(text)
    again = check(load_dataset(place), effects=False)
    assert not of_lone(again)
    assert [item.missing for item in again.facts] == [0, 1, 0]


def test_a_bad_sample_of_an_input_of_steps_is_told(tmp_path):
    made = records()
    u = np.repeat([0.0, 1.0, -1.0, 0.5], len(made["sine-5"][0]) // 4)
    y = 8.0 * u + 0.01 * RNG.standard_normal(len(u))
    u[350] = 20.0
    place = write(tmp_path, made | {"steps": (u, y)})
    (told,) = of_lone(check(load_dataset(place), effects=False))
    assert (told.record, told.topic) == ("steps", "lone input of steps")
    assert "row 352" in told.text


def test_an_error_code_that_comes_thrice_is_told_once(tmp_path):
    made = records()
    made["sine-10"][1][400:403] = 9999.9
    found = check(load_dataset(write(tmp_path, made)), effects=False).findings
    assert len([item for item in found if "9999" in item.text]) == 0
    assert len([item for item in found if item.record == "sine-10"]) == 1

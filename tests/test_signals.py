"""Signals are made of their definitions, and come back; a bad one is one line."""

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.signals import load_signal, make_signal

COMMON = {
    "unit": "A",
    "sampling_frequency_hz": 10_000,
    "duration_s": 2.0,
    "amplitude": 0.632,
    "gain": 1.264,
}


def test_the_same_seed_gives_the_same_signal():
    definition = {
        "random-sum-of-sines": {
            "band": [0, 0.02],
            "level": 0.5,
            "sines": 10,
            "trials": 10,
            "seed": 1,
        }
    }
    first, second = (make_signal("s", definition, COMMON).u for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_its_own_values_win_over_the_common_ones():
    signal = make_signal("s", {"sine": {"frequency_hz": 5, "amplitude": 3}}, COMMON)
    assert signal.u.max() == pytest.approx(3)
    assert (len(signal.u), signal.dt, signal.unit) == (20_000, 1e-4, "A")


def test_comes_back_from_its_file(tmp_path):
    signal = make_signal("s", {"sine": {"frequency_hz": 5}}, COMMON)
    signal.save(tmp_path / "s.npz")
    back = load_signal(tmp_path / "s.npz")
    np.testing.assert_array_equal(back.u, signal.u)
    assert (back.name, back.dt, back.unit) == ("s", 1e-4, "A")


@pytest.mark.parametrize(
    ("definition", "expected"),
    [
        ({"sin": {}}, "did you mean 'sine'?"),
        ({"sine": {"frequency": 4}}, "did you mean 'frequency_hz'?"),
        ({"sine": {}}, "misses the key 'frequency_hz'"),
        (
            {"sine": {"frequency_hz": "ten"}},
            "frequency_hz: 'ten'; expected a finite number",
        ),
        (
            {"sum-of-sines": {"frequencies_hz": [1], "amplitudes": [1, 2]}},
            "1 frequencies_hz but 2 amplitudes",
        ),
        (
            {
                "random-sum-of-sines": {
                    "band": [0, 1e-4],
                    "level": 1,
                    "sines": 10,
                    "trials": 1,
                    "seed": 0,
                }
            },
            "expected at least 10",
        ),
    ],
)
def test_a_bad_definition_is_told_in_one_line(definition, expected):
    with pytest.raises(InputError) as caught:
        make_signal("mine", definition, COMMON)
    assert expected in str(caught.value)
    assert "\n" not in str(caught.value)

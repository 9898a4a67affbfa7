"""The kind of an input, and which records are proposed for hold-out."""

import numpy as np
import pytest

from hystbench.inspection.entries import propose
from hystbench.inspection.input_summary import summary_of

DT = 1e-3
T = np.arange(4000) * DT
SINES = {f"sine-{hz}": np.sin(2 * np.pi * hz * T) for hz in (2, 5, 10, 20, 50)}
CHIRP = np.sin(2 * np.pi * (2 * T + 5 * T**2))
TRIANGLE = np.abs((T % 0.5) - 0.25)
NOISE = np.random.default_rng(0).standard_normal(4000)


def kinds(signals):
    return {name: summary_of(u, DT) for name, u in signals.items()}


def test_kinds_of_input():
    steps = np.repeat([0.0, 1.0, 0.5, -1.0], 1000)
    multi = np.sin(2 * np.pi * 3 * T) + np.sin(2 * np.pi * 7 * T)
    found = kinds(
        {
            "a": SINES["sine-5"],
            "b": CHIRP,
            "c": TRIANGLE,
            "d": NOISE,
            "e": steps,
            "f": multi,
        }
    )
    assert [item.kind for item in found.values()] == [
        "sine",
        "sweep",
        "ramps",
        "broadband",
        "steps",
        "sum of sines",
    ]


def test_a_band_holds_the_frequency():
    found = summary_of(SINES["sine-20"], DT)
    assert found.low_hz <= 20 <= found.high_hz < 22
    assert (found.low, found.high) == pytest.approx((-1, 1), abs=0.01)


def test_another_kind_is_held_out():
    held, why = propose(kinds({**SINES, "chirp": CHIRP}))
    assert held == ("chirp",)
    assert "another kind (sweep)" in why


def test_a_kind_that_reaches_beyond_the_others_is_not():
    held, _ = propose(kinds({**SINES, "chirp": 3 * CHIRP, "noise": 0.3 * NOISE}))
    assert held == ("noise",)


def test_of_one_kind_the_middle_of_the_rates_is_held_out():
    held, why = propose(kinds(SINES))
    assert held == ("sine-10",)
    assert "one kind (sine)" in why


def test_something_is_left_to_fit():
    held, _ = propose(kinds({"a": SINES["sine-2"], "b": CHIRP}))
    assert len(held) == 1


@pytest.mark.parametrize(
    ("kind", "u"),
    [
        ("ramps", np.interp(T, [0, 0.5, 1.5, 2.5, 4], [0, 1, -1, 0.4, -0.3])),
        ("ramps", np.round((1 + (T > 2)) * (np.abs(T % 0.5 - 0.25) - 0.125), 5)),
        ("ramps", np.interp(T, [0, 1, 2, 3, 4], [0, 1, 1, -1, -1])),
        ("sine", np.sin(2 * np.pi * 0.5 * T)),
        (
            "sum of sines",
            sum(np.sin(2 * np.pi * f * T + 7 * f**2) / f for f in range(1, 13)),
        ),
        ("sweep", np.sin(2 * np.pi * 0.5 * (np.exp(T) - 1))),
    ],
    ids=["one-triangle", "two-levels", "trapezoid", "slow", "tilted", "logarithmic"],
)
def test_kinds_that_are_alike_at_first_sight(kind, u):
    assert summary_of(u, DT).kind == kind

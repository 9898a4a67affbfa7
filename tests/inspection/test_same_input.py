"""Two records of one input: what differs between them is noise, or something unsaid."""

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.inspection import screen
from hystbench.inspection.check import check
from hystbench.inspection.page import page
from tests.inspection.made import COUNT, loop, write
from tests.inspection.test_check import NOISE, noisy


def wave(seed):
    """An input without a period."""
    rng = np.random.default_rng(seed)
    slow = np.convolve(rng.standard_normal(COUNT + 40), np.hanning(41), "valid")
    return 0.9 * slow / np.abs(slow).max()


def found_in(folder, *outputs, about=""):
    """Check two records of one input, and one of another."""
    made = {f"again-{k}": (wave(0), y) for k, y in enumerate(outputs)}
    made |= {"other": (wave(1), noisy(loop(wave(1)), 9))}
    place = write(folder, made, about=about, roles={"other": "hold-out"})
    return check(load_dataset(place), effects=False)


def told(found, topic):
    return [item for item in found.findings if item.topic == topic]


def test_their_difference_tells_the_noise(tmp_path):
    y = loop(wave(0))
    found = found_in(tmp_path, noisy(y, 1), noisy(y, 2))
    assert not told(found, "no noise")
    (one,) = told(found, "same input")
    assert one.kind == "missing"
    assert one.text.startswith("again-0 and again-1 have the same input")
    (line,) = one.paste
    assert float(line.removeprefix("noise_rms: ")) == pytest.approx(NOISE, rel=0.1)
    assert "no record repeats" not in "\n".join(screen.lines(found))


def test_a_zero_that_moved_between_them_is_no_noise(tmp_path):
    y = loop(wave(0))
    found = found_in(tmp_path, noisy(y, 1), 1.0 + noisy(y, 2))
    (line,) = told(found, "same input")[0].paste
    assert float(line.removeprefix("noise_rms: ")) == pytest.approx(NOISE, rel=0.1)


def test_with_a_declared_noise_nothing_is_missing(tmp_path):
    y = loop(wave(0))
    found = found_in(tmp_path, noisy(y, 1), noisy(y, 2), about=f"noise_rms: {NOISE}\n")
    assert not [item for item in found.findings if item.kind == "missing"]
    assert not told(found, "apart")


@pytest.mark.parametrize(
    "other", [lambda y: 1.05 * y, lambda y: y + 0.1, lambda y: y + wave(3)]
)
def test_outputs_that_differ_by_more_than_the_noise_are_told(tmp_path, other):
    y = loop(wave(0))
    about = f"noise_rms: {NOISE}\n"
    found = found_in(tmp_path, noisy(y, 1), noisy(other(y), 2), about=about)
    (one,) = told(found, "apart")
    assert one.kind == "note"
    assert one.text.startswith("again-1 has the input of again-0, but")


def test_of_three_each_later_one_is_held_against_the_first(tmp_path):
    y = loop(wave(0))
    outputs = noisy(y, 1), noisy(y, 2), noisy(y + 0.5, 3)
    found = found_in(tmp_path, *outputs, about=f"noise_rms: {NOISE}\n")
    assert [item.record for item in told(found, "apart")] == ["again-2"]


def test_a_loop_that_does_not_fit_is_no_base_to_judge_effects_on(tmp_path):
    """Half of the output's rms is left: no effects are listed, on screen or page."""
    lag = np.exp(-np.arange(COUNT) / 150) / 150
    made = {}
    for seed, name in enumerate(("one", "two", "held")):
        u = wave(seed)
        made[name] = u, noisy(10 * np.convolve(u, lag)[:COUNT], seed)
    about = f"noise_rms: {NOISE}\n"
    place = write(tmp_path, made, about=about, roles={"held": "hold-out"})
    found = check(load_dataset(place))
    assert not found.effects
    assert not found.base.fits
    said = screen.words_of(found)("headline")[0]
    assert "effects judged" not in said
    assert "does not fit" in said
    shown = "\n".join(screen.lines(found))
    for text in (shown, page(found)):
        assert "is not told, as the loop" in " ".join(text.split())
        assert "drive-lag" not in text


def test_a_loop_that_fits_is_counted_on(tmp_path):
    y = loop(wave(0))
    made = {"one": (wave(0), noisy(y, 1)), "held": (wave(1), loop(wave(1)))}
    place = write(tmp_path, made, roles={"held": "hold-out"})
    found = check(load_dataset(place))
    assert found.base.fits
    assert "effects judged" in screen.words_of(found)("headline")[0]

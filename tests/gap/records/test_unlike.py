"""Records with exchanged columns, another sign or another factor are found."""

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.records.unlike import unlike_the_others
from hystbench.inspection import screen
from hystbench.inspection.check import check
from tests.gap.made import record
from tests.inspection.made import DT, sine, write
from tests.inspection.stage import wave

LAG_S = 0.02
NOISE = 0.01


def lagged(u, gain=1.0, tau=LAG_S):
    """A lag of first order, step by step: so much of the rest goes in each."""
    y = np.zeros(len(u))
    for k in range(1, len(u)):
        y[k] = y[k - 1] + DT / tau * (gain * u[k - 1] - y[k - 1])
    return y


def noisy(y, seed):
    return y + NOISE * np.std(y) * np.random.default_rng(seed).standard_normal(len(y))


def signals(device=lagged, sizes=(1.0, 2.0, 1.5, 2.5)):
    inputs = [size * wave(k) for k, size in enumerate(sizes)]
    return [(u, noisy(device(u), 10 + k)) for k, u in enumerate(inputs)]


def made(pairs):
    return [record(u, y, name=f"r{k}") for k, (u, y) in enumerate(pairs)]


def spoilt(pairs, place, how):
    return [how(*each) if k == place else each for k, each in enumerate(pairs)]


@pytest.mark.parametrize("place", [0, 1, 3])
def test_exchanged_columns_are_told_of_that_record_alone(place):
    pairs = spoilt(signals(), place, lambda u, y: (y, u))
    (found,) = unlike_the_others(made(pairs))
    assert (found.name, found.exchanged, found.factor) == (f"r{place}", True, 1.0)
    assert found.mended <= 0.5 < found.left


def test_of_two_sines_exchanged_in_one_the_sound_one_is_not_accused():
    waves = [sine(hz, 2.0) for hz in (1, 5, 20)] + [wave(1)]
    pairs = [(u, noisy(lagged(u, 8.0), k)) for k, u in enumerate(waves)]
    pairs[1] = pairs[1][::-1]
    (found,) = unlike_the_others(made(pairs))
    assert (found.name, found.exchanged) == ("r1", True)


@pytest.mark.parametrize("factor", [-1.0, -3.0, 10.0, 0.1])
def test_a_factor_of_one_record_is_told_with_what_mends_it(factor):
    pairs = spoilt(signals(), 2, lambda u, y: (u, factor * y))
    (found,) = unlike_the_others(made(pairs))
    assert (found.name, found.exchanged) == ("r2", False)
    assert found.factor == pytest.approx(1 / factor, rel=0.05)


def test_sound_records_are_all_alike():
    assert unlike_the_others(made(signals())) == []


def test_channels_that_look_alike_are_not_accused():
    # Input and output are the same but for noise: exchanged they look the same too.
    assert unlike_the_others(made(signals(lambda u: u.copy()))) == []


def test_another_gain_at_another_amplitude_is_no_wrong_factor():
    # It saturates at .5: of the large record less than a half comes out.
    pairs = signals(lambda u: lagged(0.5 * np.tanh(2 * u)), (0.3, 0.4, 0.5, 3.0))
    assert unlike_the_others(made(pairs)) == []


@pytest.mark.parametrize("bias", [-3.0, 0.5])
def test_another_gain_about_another_mean_is_no_wrong_factor(bias):
    # The slope of a square is twice the bias: it has its sign, and a sixth of its size.
    inputs = [b + 0.3 * wave(k) for k, b in enumerate((3.0, 3.0, 3.0, bias))]
    # Each begins in balance.
    devices = [u[0] ** 2 + lagged(u**2 - u[0] ** 2) for u in inputs]
    pairs = [
        (u, noisy(y, k)) for k, (u, y) in enumerate(zip(inputs, devices, strict=True))
    ]
    assert unlike_the_others(made(pairs)) == []


def test_a_sign_is_told_of_records_about_one_mean():
    pairs = [(3.0 + u, y) for u, y in spoilt(signals(), 2, lambda u, y: (u, -y))]
    assert [found.name for found in unlike_the_others(made(pairs))] == ["r2"]


def test_a_record_that_stands_still_where_it_is_looked_at_hides_no_other():
    pairs = spoilt(signals(), 2, lambda u, y: (u, -y))
    still = np.zeros(len(pairs[0][0]))
    pairs += [(pairs[0][0], still), (still, pairs[1][1])]
    with np.errstate(all="raise"):
        found = unlike_the_others(made(pairs))
    assert [item.name for item in found] == ["r2"]


def test_two_records_do_not_tell_which_is_wrong():
    assert unlike_the_others(made(spoilt(signals()[:2], 0, lambda u, y: (u, -y)))) == []


def test_the_check_tells_it_and_accuses_no_other(tmp_path):
    waves = {f"sine-{hz}": sine(hz, 2.0) for hz in (1, 4, 16, 40)} | {"wave": wave(1)}
    records = {
        name: (u, noisy(lagged(u, 8.0), k)) for k, (name, u) in enumerate(waves.items())
    }
    records["sine-16"] = records["sine-16"][::-1]
    place = write(tmp_path, records, roles={"sine-4": "hold-out"})
    found = check(load_dataset(place), effects=False)
    (told,) = (item for item in found.findings if item.kind == "record")
    assert told.record == "sine-16"
    assert "Exchange the two columns in its file" in told.text
    assert not [item for item in found.findings if "trigger" in item.text]
    assert "but 1 record looks wrong" in " ".join(screen.lines(found))


def test_the_loop_of_the_check_is_fitted_without_it(tmp_path):
    pairs = {f"r{k}": each for k, each in enumerate(signals(lambda u: 8.0 * u))}
    sound = check(load_dataset(write(tmp_path / "a", pairs)), effects=False)
    pairs["r1"] = pairs["r1"][0], -pairs["r1"][1]
    mended = check(load_dataset(write(tmp_path / "b", pairs)), effects=False)
    assert mended.base.left == pytest.approx(sound.base.left, rel=0.3)


def test_the_gap_workflow_warns_of_it(tmp_path):
    records = {f"r{k}": (u, y) for k, (u, y) in enumerate(signals())}
    records["r2"] = records["r2"][::-1]
    place = write(tmp_path, records, roles={"r1": "hold-out"})
    (told,) = load_evidence(place).warnings
    assert told.startswith("r2: a linear model of the other records leaves ")
    assert "Exchange the two columns" in told

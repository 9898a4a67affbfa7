"""A linear base behind a dead time, which many poles would imitate."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.dead_time import behind_a_dead_time
from hystbench.gap.bases.linear import identified_linear
from hystbench.gap.records.evidence import Evidence
from tests.gap.made import record
from tests.gap.small import block

DT, NOISE = 1e-3, 0.01


def mode(frequency_hz, damping):
    w = 2 * np.pi * frequency_hz
    down = [1 / w**2, 2 * damping / w, 1.0]
    return block("transfer-function", numerator=[1.0], denominator=down)


def duct(samples, noise=NOISE, rates=(DT, DT)):
    """Two modes behind a dead time; the input is a smoothed noise."""
    rng, found = np.random.default_rng(6), []
    for k, dt in enumerate(rates):
        u = np.convolve(rng.standard_normal(1200), np.ones(3) / 3, "same")
        u[:60] = 0.0
        late = np.concatenate([np.zeros(samples), u])[: len(u)]
        modes = (mode(40, 0.03), mode(95, 0.02))
        y = sum(one.simulate(late, late, dt) for one in modes)
        y = y + noise * rng.standard_normal(len(u))
        found.append(record(u, y, name=f"{k}", dt=dt))
    return Evidence("duct", tuple(found), (), "linear")


@pytest.mark.parametrize("samples", [0, 1])
def test_a_device_that_answers_at_once_has_none(samples):
    assert behind_a_dead_time(duct(samples)) is None


def test_the_input_is_taken_as_late_as_it_is_answered():
    given = duct(25)
    freed, seconds = behind_a_dead_time(given)
    # A few samples of it are within what so many numbers tell.
    assert 0.8 * 25 * DT <= seconds <= 25 * DT
    late = round(seconds / DT)
    for before, after in zip(given.fit, freed.fit, strict=True):
        assert after.u[late + 50] == pytest.approx(before.u[50])
        np.testing.assert_array_equal(after.y, before.y)


def test_records_of_different_rates_tell_none():
    assert behind_a_dead_time(duct(25, rates=(DT, 2 * DT))) is None


def test_the_base_has_the_poles_of_the_device_and_not_those_of_the_dead_time():
    found = identified_linear(duct(25))
    assert found.model.found_with == "input-delay"
    assert "behind a dead time of" in found.note
    assert found.fit_rms < 1.3 * NOISE
    (ratio,) = (x for x in found.model.chain if isinstance(x, TransferFunction))
    poles = np.abs(np.roots(ratio.denominator)) / 2 / np.pi
    assert sorted(poles)[:4] == pytest.approx([40, 40, 95, 95], rel=0.03)

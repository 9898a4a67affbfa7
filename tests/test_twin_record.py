"""A twin measured: what the record's input has that the actuator does not see."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.signals import Signal
from hystbench.twin_record import record_of_twin

PLANT = Model.from_mapping(
    {
        "name": "plant",
        "input": {"name": "current", "unit": "A"},
        "output": {"name": "displacement", "unit": "um"},
        "chain": [{"gain": {"value": 20.0}}, {"sensor-noise": {"rms": 0.02}}],
    },
    "plant",
)
WAVE = np.sin(np.linspace(0, 20, 5000))
zeros = st.floats(-0.1, 0.1)
noises = st.floats(0, 0.1)
seeds = st.integers(0, 2**32 - 1)


def record(*, seed=1, zero=0.0, noise=0.0, name="sine", unit="A"):
    settings = {"seed": seed, "input_zero_error": zero, "input_noise": noise}
    return record_of_twin(Signal(name, 1e-4, WAVE, unit), PLANT, settings, "plant.yaml")


@given(seeds, zeros, noises)
def test_the_actuator_sees_neither_zero_error_nor_input_noise(seed, zero, noise):
    np.testing.assert_array_equal(
        record(seed=seed, zero=zero, noise=noise).y, record(seed=seed).y
    )


@given(seeds, zeros)
def test_without_noise_the_input_is_the_signal_and_its_zero_error(seed, zero):
    np.testing.assert_array_equal(record(seed=seed, zero=zero).u, WAVE + zero)


@given(zeros, noises)
def test_the_noise_has_its_rms_and_no_colour(zero, noise):
    one = record(zero=zero, noise=noise).u - WAVE - zero
    # n normal draws: their RMS is off by 1 / sqrt(2 n), and their correlation with
    # the draw before by 1 / sqrt(n), as standard deviations.
    assert np.sqrt(np.mean(one**2)) == pytest.approx(
        noise, rel=4 / np.sqrt(2 * len(WAVE)), abs=1e-12
    )
    if noise > 1e-9:
        assert abs(np.corrcoef(one[1:], one[:-1])[0, 1]) < 4 / np.sqrt(len(WAVE))


@given(seeds)
def test_each_noise_is_a_stream_of_its_own(seed):
    def drawn(found):
        return found.u - WAVE, found.y - 20 * WAVE

    every = [
        *drawn(record(seed=seed, noise=1.0)),
        *drawn(record(seed=seed, noise=1.0, name="other")),
        *drawn(record(seed=seed + 1, noise=1.0)),
    ]
    apart = np.abs(np.corrcoef(every) - np.eye(len(every)))
    # Fifteen pairs in each of many examples.
    assert apart.max() < 6 / np.sqrt(len(WAVE))


def test_another_unit_is_refused():
    with pytest.raises(InputError, match="'A'; expected 'V', the unit of signal sine"):
        record(unit="V")

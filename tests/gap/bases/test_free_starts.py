"""Records that begin in a motion which a linear base remembers for long."""

import json
from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.dead_zone import DeadZone
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.asked import Asked
from hystbench.gap.bases.free_starts import (
    begun_at_any_level,
    begun_freely,
    start_fades,
    with_free_starts,
)
from hystbench.gap.bases.linear import (
    IdentifiedModel,
    has_free_starts,
    identified_linear,
)
from hystbench.gap.bases.load import load_base
from hystbench.gap.cache import Remembered, remembering
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.first_state import begins_alike, with_free_start
from hystbench.gap.records.scored_samples import Compared, ScoredSamples
from hystbench.gap.run import closed_gap
from hystbench.gap.stages import BASE_FILE, decide_in, show_in
from hystbench.model import load_model
from hystbench.record import Channel, Record
from tests.gap.searched import among

DT = 0.01
CHANNELS = Channel("force", "N"), Channel("position", "mm")
NOISE = 1e-3
TAUS, FREQUENCIES = (9.0, 4.0), (6.0, 17.0)
"""Time constants in s and frequencies in rad/s of two modes."""
POLES = np.array([-1 / tau + 1j * w for tau, w in zip(TAUS, FREQUENCIES, strict=True)])
ONE = among("sensor-nonlinearity")
ARM = TransferFunction(
    numerator=(4.0, 1.0, 200.0),
    denominator=tuple(np.poly([*POLES, *POLES.conj()]).real),
    hold="linear",
)


def arm(seed, use="fit", begin=1500, count=1500):
    """A flexible arm that moved before the record begins."""
    rng = np.random.default_rng(seed)
    u = rng.standard_normal(begin + count)
    y = ARM.simulate(u, u, DT)[begin:] + NOISE * rng.standard_normal(count)
    return Record(f"r{seed}", DT, u[begin:], y, *CHANNELS, "measured", use)


def device(*records, hold_out=()):
    return Evidence("arm", records, hold_out, "linear")


@pytest.fixture(scope="module")
def cut():
    return device(arm(0), hold_out=(arm(1, "hold-out"),))


@pytest.fixture(scope="module")
def found(cut):
    return identified_linear(cut)


def test_poles_are_those_of_the_device_though_records_begin_anyhow(found):
    assert found.model.free_starts
    assert "begun anyhow" in found.note
    assert found.fit_rms == pytest.approx(NOISE, rel=0.1)
    ratio = found.model.chain[0]
    poles = np.roots(ratio.denominator)
    for pole in POLES:
        assert np.min(np.abs(poles - pole)) < 0.1 * abs(pole.real)


def test_records_that_begin_at_rest_have_no_other_start():
    rest = arm(0, begin=0)
    assert with_free_starts(device(rest), np.inf) is not None  # it moves at once
    assert not identified_linear(device(rest)).model.free_starts


def test_an_output_that_does_not_move_yet_begins_at_rest():
    """A dead zone in front of a motor takes the first of its input away."""
    u = np.sin(0.4 * DT * np.arange(1500))
    y = ARM.simulate(DeadZone(half_width=0.3).simulate(u, u, DT), u, DT)
    stuck = Record("motor", DT, u, y, *CHANNELS, "measured", "fit")
    assert begins_alike(stuck)
    assert with_free_start(stuck, POLES) is stuck
    assert with_free_starts(device(stuck), np.inf) is None


def test_what_hardly_fades_is_no_start(cut, found):
    """Poles at the frequency of a sine do what the sine does, whatever the device."""
    u = np.sin(FREQUENCIES[0] * DT * np.arange(3000) + 0.7)
    sine = Record("sine", DT, u, u + 0.2 * u**3, *CHANNELS, "measured", "fit")
    idle = replace(
        found.model,
        chain=(replace(ARM, numerator=(1e-9,), denominator=(1.0, 1e-6, 36.0)),),
    )
    assert begun_freely((sine,), idle)[0].start_poles
    assert not start_fades(idle, device(sine))
    assert start_fades(found.model, cut)


def test_a_score_leaves_out_any_first_state_and_nothing_else(cut):
    (record,) = cut.fit
    free = with_free_start(record, POLES)
    motion = np.real(3.0 * np.exp(POLES[0] * DT * np.arange(len(record))))
    moved = replace(free, y=free.y + motion)
    ends = [Compared(x, np.zeros(len(record))).residual for x in (free, moved)]
    np.testing.assert_allclose(*ends, atol=1e-9)
    sample = ScoredSamples.of((free,), 400)
    both = np.column_stack([motion, motion + free.u])
    of_motion, with_input = sample.take([both]).T
    np.testing.assert_allclose(of_motion, 0.0, atol=1e-9)
    assert np.std(with_input) == pytest.approx(np.std(free.u), rel=0.05)


@pytest.fixture(scope="module")
def known(cut, tmp_path_factory):
    """What is decided beside its base, in one process."""
    evidence = replace(cut, noise_rms=NOISE)
    cache = Remembered(tmp_path_factory.mktemp("kept"), print)
    with remembering(cache):
        base, _ = load_base("linear", evidence)
        again, _ = load_base("linear", evidence)
    assert cache.found
    assert has_free_starts(base)
    assert has_free_starts(again)
    return evidence, again, closed_gap(evidence, again, Asked(vocabulary=ONE))


def test_where_nothing_is_missing_none_is_named_and_the_start_is_told(known):
    content = known[-1].outcome.content
    assert content["verdict"] == "no-gap"
    assert content["gap"]["before"] == pytest.approx(NOISE, rel=0.1)
    assert any("another first state" in text for text in content["warnings"])


def test_the_two_jobs_of_the_workflow_begin_records_alike(known, tmp_path):
    evidence, base, closed = known
    decide_in(tmp_path, evidence, base, Asked(vocabulary=ONE))
    show_in(tmp_path, evidence, load_model(tmp_path / BASE_FILE))
    shown = json.loads((tmp_path / "gap.json").read_text())
    assert shown["gap"] == closed.outcome.content["gap"]


def test_where_an_integrator_stands_is_no_number_of_the_device():
    """A motor's place: each record goes on from where the device was left."""
    motor = TransferFunction(numerator=(1.0,), denominator=(0.05, 1.0, 1e-7))
    base = IdentifiedModel("linear", *CHANNELS, (motor,))
    rng = np.random.default_rng(2)
    u = np.convolve(rng.standard_normal(900), np.ones(40) / 40, "same")
    y = motor.simulate(u, u, DT)
    held = Record("held", DT, u, y + 7.0, *CHANNELS, "measured", "hold-out")
    (free,) = begun_at_any_level((held,), base, 9.0)
    assert len(free.start_poles) == 1
    left = Compared(free, y).residual
    np.testing.assert_allclose(left, 0.0, atol=1e-4)
    lag = replace(motor, denominator=(0.05, 1.0))
    assert begun_at_any_level((held,), replace(base, chain=(lag,)), 9.0) == (held,)

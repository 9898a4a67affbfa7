"""A record comes back from its file, and cannot be changed."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.record import Channel, Record, load_record
from hystbench.written import ENTRIES


def make(u, dt=0.01):
    u = np.asarray(u, dtype=float)
    channels = Channel("current", "A"), Channel("displacement", "um")
    return Record("r", dt, u, 2 * u, *channels, origin="twin")


def test_comes_back_from_its_file(tmp_path):
    record = make([1, 2, 3.5])
    record.save(tmp_path / "deep" / "r.npz")
    back = load_record(tmp_path / "deep" / "r.npz")
    np.testing.assert_array_equal(back.u, record.u)
    np.testing.assert_array_equal(back.y, record.y)
    assert (back.name, back.dt, back.input, back.output, back.origin, back.use) == (
        "r",
        0.01,
        record.input,
        record.output,
        "twin",
        "fit",
    )


def test_simulated_output_comes_back_with_it(tmp_path):
    replace(make([1, 2, 3]), simulated=np.array([1.5, 4, 6])).save(tmp_path / "r.npz")
    back = load_record(tmp_path / "r.npz")
    np.testing.assert_array_equal(back.simulated, [1.5, 4, 6])
    with pytest.raises(ValueError, match="read-only"):
        back.simulated[0] = 1
    make([1, 2]).save(tmp_path / "bare.npz")
    assert load_record(tmp_path / "bare.npz").simulated is None


def test_is_evidence_that_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        make([1, 2]).u[0] = 5


def test_rate_of_a_sine_is_its_angular_frequency():
    time = np.arange(100_000) / 10_000
    assert make(np.sin(2 * np.pi * 3 * time), 1e-4).rate == pytest.approx(
        2 * np.pi * 3, rel=1e-4
    )


def test_an_input_of_nothing_has_no_rate():
    assert make(np.zeros(100)).rate == 0.0


def test_rate_does_not_hang_on_scale():
    u = np.sin(np.arange(1000) / 50)
    assert make(1400 * u).rate == pytest.approx(make(u).rate, rel=1e-9)


def test_repr_tells_what_it_is():
    assert repr(make([1, 2])) == (
        "Record(r, 2 samples at 100 Hz, current (A) to displacement (um), twin, fit)"
    )


def test_another_file_is_refused_in_one_line(tmp_path):
    (tmp_path / "x.npz").write_text("no archive")
    with pytest.raises(InputError, match=r"x\.npz: not a record"):
        load_record(tmp_path / "x.npz")


def test_a_failure_leaves_the_old_file(tmp_path, monkeypatch):
    make([1, 2]).save(tmp_path / "r.npz")
    before = (tmp_path / "r.npz").read_bytes()

    def fail(*_, **__):
        raise OSError("disk full")

    monkeypatch.setattr(np, "savez", fail)
    with pytest.raises(OSError, match="disk full"):
        make([3, 4]).save(tmp_path / "r.npz")
    assert (tmp_path / "r.npz").read_bytes() == before
    assert {item.name for item in tmp_path.iterdir()} == {"r.npz", ENTRIES}


def test_a_part_of_a_record_keeps_what_belongs_to_its_samples():
    record = replace(
        make(np.arange(20)),
        simulated=np.arange(20.0) + 0.5,
        interpolated=np.arange(20) == 8,
        period_samples=5,
        lead=6,
    )
    every = record.cut(slice(None, None, 4))
    np.testing.assert_array_equal(every.u, [0, 4, 8, 12, 16])
    np.testing.assert_array_equal(every.simulated, [0.5, 4.5, 8.5, 12.5, 16.5])
    np.testing.assert_array_equal(every.counted, [False, False, False, True, True])
    assert (every.dt, every.lead, every.period_samples) == (0.04, 2, None)
    assert record.cut(slice(-3, None)).lead == 0
    assert record.cut(slice(5)).lead == 5


def test_what_is_left_out_of_a_score_makes_another_record_of_it():
    record = make(np.arange(20))
    assert replace(record, lead=6).digest != record.digest
    np.testing.assert_array_equal(replace(record, lead=6).counted, np.arange(20) >= 6)

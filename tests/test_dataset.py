"""dataset.yaml and its files are read as written; a bad one is one line."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.dataset import load_dataset, schema
from hystbench.record import load_record
from tests.conftest import csv_text
from tests.messages import message

TIME = np.arange(50) / 1000
U = np.sin(40 * TIME)
Y = np.cos(40 * TIME)
HEADER = """
name: bench
time: {column: time_s, unit: s}
input: {column: current_A, unit: A}
output: {column: displacement_um, unit: um}
"""


def test_reads_what_was_written(write_dataset):
    dataset = load_dataset(write_dataset({"slow.csv": csv_text(TIME, U, Y)}))
    record = dataset.read("slow")
    assert record.dt == pytest.approx(0.001, rel=1e-12)
    np.testing.assert_allclose(record.u, U, rtol=1e-8)
    np.testing.assert_allclose(record.y, Y, rtol=1e-8)
    assert (record.origin, record.use) == ("measured", "fit")
    assert (record.input.label, record.output.label) == (
        "current (A)",
        "displacement (um)",
    )


@pytest.mark.parametrize(
    ("column", "unit", "name"),
    [
        ("torque_Nm", "Nm", "torque"),
        ("torque_Nm", "N*m", "torque"),
        ("surge_m_s", "m/s", "surge"),
        ("surge_m_per_s", "m/s", "surge"),
        ("acceleration_ms2", "m/s^2", "acceleration"),
        ("acceleration_m_s2", "m/s^2", "acceleration"),
        ("acceleration_mps2", "m/s^2", "acceleration"),
        ("velocity_mms", "mm/s", "velocity"),
        ("surge_ms", "m/s", "surge"),
        ("arms", "m/s", "arms"),
        ("command [V]", "V", "command"),
        ("Weg (µm)", "um", "Weg"),
        ("motor_current", "A", "motor current"),
    ],
)
def test_a_name_lacks_its_unit_in_any_spelling(write_dataset, column, unit, name):
    text = csv_text(TIME, U, Y).replace("current_A", column)
    said = f"'{column}', unit: {unit}"
    about = HEADER.replace("current_A, unit: A", said)
    about += "records:\n  - {file: slow.csv}\n"
    dataset = load_dataset(write_dataset({"slow.csv": text}, about))
    assert dataset.read("slow").input.name == name


@given(
    count=st.integers(2, 40),
    dt=st.floats(1e-6, 10),
    start=st.floats(-5, 5),
    scale=st.floats(1e-3, 1e6),
)
def test_any_uniform_record_comes_back(tmp_path_factory, count, dt, start, scale):
    folder = tmp_path_factory.mktemp("data")
    time = start + dt * np.arange(count)
    u = scale * np.sin(np.arange(count))
    rows = [
        f"{t!r},{a!r},{-a!r}" for t, a in zip(time.tolist(), u.tolist(), strict=True)
    ]
    (folder / "r.csv").write_text(
        "time_s,current_A,displacement_um\n" + "\n".join(rows) + "\n"
    )
    (folder / "dataset.yaml").write_text(HEADER + "records: [{file: r.csv}]\n")
    record = load_dataset(folder).read("r")
    np.testing.assert_array_equal(record.u, u)
    np.testing.assert_array_equal(record.y, -u)
    assert record.dt == pytest.approx(dt, rel=1e-6)


def test_milliseconds_become_seconds(write_dataset):
    text = csv_text(TIME * 1000, U, Y)
    yaml_text = HEADER.replace("unit: s}", "unit: ms}") + "records: [{file: r.csv}]"
    record = load_dataset(write_dataset({"r.csv": text}, yaml_text)).read("r")
    assert record.dt == pytest.approx(0.001, rel=1e-9)


def test_unit_of_time_is_checked(write_dataset):
    yaml_text = HEADER.replace("unit: s}", "unit: V}") + "records: [{file: r.csv}]"
    path = write_dataset({"r.csv": csv_text(TIME, U, Y)}, yaml_text)
    assert "expected a unit of time" in message(lambda: load_dataset(path))


def test_identification_is_the_slowest_fit_record_unless_named(write_dataset):
    slow = csv_text(TIME, np.sin(40 * TIME), Y)
    fast = csv_text(TIME, np.sin(200 * TIME), Y)
    slowest = csv_text(TIME, np.sin(20 * TIME), Y)
    records = (
        "records: [{file: fast.csv}, {file: slow.csv}, "
        "{file: slowest.csv, use: hold-out}]\n"
    )
    files = {"slow.csv": slow, "fast.csv": fast, "slowest.csv": slowest}
    path = write_dataset(files, HEADER + records)
    assert load_dataset(path).identification == "slow"
    path.write_text(HEADER + "identification: fast\n" + records)
    assert load_dataset(path).identification == "fast"


def with_row(row: str) -> str:
    lines = csv_text(TIME, U, Y).splitlines()
    lines[10] = row
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (with_row("0.009,nan,1"), ["row 11", "'current_A'", "finite number"]),
        (with_row("0.009,inf,1"), ["row 11", "'current_A'", "finite number"]),
        (with_row("0.009,x,1"), ["row 11", "'x'"]),
        (with_row("0.009,,1"), ["row 11", "finite number"]),
        (with_row("0.009,1"), ["row 11", "finite number"]),
        (with_row("0.007,1,1"), ["row 11", "expected it to increase"]),
        (with_row("0.0096,1,1"), ["row 11", "uniform sampling"]),
        (
            csv_text(TIME, U, Y, "time_s,curent_A,displacement_um"),
            ["no column 'current_A'", "did you mean 'curent_A'?"],
        ),
        (csv_text(TIME, U * 0 + 3, Y), ["'current_A'", "constant"]),
        (csv_text(TIME, U * 1e200, Y), ["'current_A'", "e+199", "some unit"]),
        (
            csv_text(TIME, U, Y, "time_s,current_A,displacement_um").replace(
                "time_s", "current_A", 1
            ),
            ["'time_s'"],
        ),
        (
            "\n".join(
                line + "," + line.split(",")[1] for line in csv_text(TIME, U, Y).split()
            ),
            ["2 columns 'current_A'; expected one"],
        ),
        (csv_text(TIME, U, Y * 0), ["'displacement_um'", "constant"]),
        (csv_text(TIME[:1], U[:1], Y[:1]), ["at least 2 samples"]),
        ("time_s,current_A,displacement_um\n", ["at least 2 samples"]),
        ("", ["no column 'time_s'"]),
    ],
)
def test_a_bad_file_is_told_in_one_line(write_dataset, text, expected):
    dataset = load_dataset(write_dataset({"bad.csv": text}))
    said = message(lambda: dataset.read("bad"))
    for part in ["bad.csv", *expected]:
        assert part in said


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("name: bench", "nmae: bench"), "'name'"),
        (("input:", "imput:"), "did you mean 'input'?"),
        (("unit: A", "untis: A"), "input: unknown key 'untis'; did you mean 'unit'?"),
        (
            ("unit: A", "unit: A, noise_rms: 1"),
            "input: unknown key 'noise_rms'; it is a key of the file, not of 'input'",
        ),
        (("r.csv", "rr.csv"), "no file 'rr.csv'; did you mean 'r.csv'?"),
        (("use: fit", "use: hold"), "did you mean 'hold-out'?"),
        (("use: fit", "use: hold-out"), "at least one with 'use: fit'"),
        (("name: bench", "name: bench\nidentification: q"), "no record 'q'"),
        (("name: bench", "name: ../up"), "'../up'"),
        (("name: bench", "name: [bench"), "line"),
        (("column: displacement_um", "column: current_A"), "named twice"),
        (("[{file: r.csv, use: fit}]", "{r: {file: r.csv}}"), "expected a list"),
    ],
)
def test_a_bad_header_is_told_in_one_line(write_dataset, change, expected):
    yaml_text = HEADER + "records: [{file: r.csv, use: fit}]\n"
    path = write_dataset({"r.csv": csv_text(TIME, U, Y)}, yaml_text.replace(*change))
    said = message(lambda: load_dataset(path))
    assert expected in said
    assert "dataset.yaml" in said


def test_rounded_times_pass_and_a_stated_tolerance_counts(write_dataset):
    jitter = np.where(np.arange(50) % 2, 2e-5, 0)
    text = csv_text(TIME + jitter, U, Y)
    records = "records: [{file: r.csv}]\n"
    path = write_dataset({"r.csv": text}, HEADER + records)
    assert "uniform sampling" in message(lambda: load_dataset(path).read("r"))
    loose = HEADER.replace("unit: s}", "unit: s, tolerance: 0.05}")
    path.write_text(loose + records)
    assert load_dataset(path).read("r").dt == pytest.approx(0.001, rel=1e-3)


@pytest.mark.parametrize("off", [0.03, 0.3])
def test_the_line_that_admits_an_uneven_clock_is_told(write_dataset, off):
    """As told it is taken."""
    times = TIME + 0.001 * off * np.where(np.arange(len(TIME)) == 20, 1.0, 0.0)
    path = write_dataset({"a.csv": csv_text(times, U, Y)})
    said = message(lambda: load_dataset(path).read("a"))
    line = re.search("write '(time: .*?})'", said)[1]
    told = float(line.partition("tolerance: ")[2].rstrip("}"))
    assert off < told < 1.2 * off
    old = "time: {column: time_s, unit: s}"
    path.write_text(path.read_text().replace(old, line))
    assert len(load_dataset(path).read("a")) == len(TIME)


def test_of_times_that_no_tolerance_admits_interpolation_is_told(write_dataset):
    times = TIME + 0.0008 * (np.arange(len(TIME)) == 20)
    path = write_dataset({"a.csv": csv_text(times, U, Y)})
    said = message(lambda: load_dataset(path).read("a"))
    line = "time: {column: time_s, unit: s, uneven: interpolate}"
    assert f"write '{line}'" in said
    path.write_text(path.read_text().replace("time: {column: time_s, unit: s}", line))
    load_dataset(path).read("a")


def test_samples_at_uneven_times_are_interpolated_where_that_is_asked_for(
    write_dataset,
):
    rng = np.random.default_rng(2)
    steps = 0.001 * rng.choice([1.0, 1.0, 0.7, 1.4], 400)
    time = np.cumsum(steps)
    u, y = np.sin(40 * time), np.cos(40 * time)
    parts = (
        "{file: r.csv, rows: [1, 200]}",
        "{file: r.csv, name: b, rows: [201, 400]}",
    )
    records = f"records: [{', '.join(parts)}]\n"
    path = write_dataset({"r.csv": csv_text(time, u, y)}, HEADER + records)
    assert "uneven: interpolate" in message(lambda: load_dataset(path).read("r"))
    even = HEADER.replace("unit: s}", "unit: s, uneven: interpolate}")
    path.write_text(even + records)
    first, second = (load_dataset(path).read(name) for name in ("r", "b"))
    assert first.dt == second.dt == pytest.approx(0.001, rel=1e-6)
    assert first.interpolated is None
    np.testing.assert_allclose(first.u, np.sin(40 * (time[0] + first.time)), atol=4e-4)
    np.testing.assert_allclose(
        second.y, np.cos(40 * (time[200] + second.time)), atol=4e-4
    )


def test_text_that_is_not_utf_8_is_told(write_dataset):
    path = write_dataset({"r.csv": csv_text(TIME, U, Y)})
    path.write_bytes("name: prüf\n".encode("latin-1"))
    assert "expected text in UTF-8" in message(lambda: load_dataset(path))


def keys_of(schema):
    """Name all keys of a JSON Schema, at any depth."""
    for name, about in schema.get("properties", {}).items():
        yield name
        yield from keys_of(about)
    if "items" in schema:
        yield from keys_of(schema["items"])


def test_the_tutorial_names_every_key(root):
    text = (root / "docs" / "tutorial.md").read_text(encoding="utf-8")
    section = text.partition("## 2. A dataset.yaml")[2].partition("\n## ")[0]
    words = set(re.findall(r"\w+", section))
    assert len(found := set(keys_of(schema()))) > 10
    assert found <= words


def test_what_is_interpolated_is_marked_and_kept(write_dataset, tmp_path):
    u, y = U.copy(), Y.copy()
    u[7], y[[20, 21]] = np.nan, np.nan
    folder = write_dataset(
        {"slow.csv": csv_text(TIME, u, y)},
        HEADER + "records: [{file: slow.csv, missing: interpolate}]\n",
    )
    found = load_dataset(folder).read("slow")
    assert np.flatnonzero(found.interpolated).tolist() == [7, 20, 21]
    assert np.flatnonzero(~found.counted).tolist() == [7, 20, 21]
    assert found.u[7] == pytest.approx((U[6] + U[8]) / 2, rel=1e-7)
    found.save(tmp_path / "kept.npz")
    again = load_record(tmp_path / "kept.npz")
    np.testing.assert_array_equal(again.interpolated, found.interpolated)
    assert again.digest == found.digest
    assert replace(found, interpolated=None).digest != found.digest


def test_a_clock_that_misses_a_tick_leaves_samples_measured(write_dataset):
    time = TIME.copy()
    time[9] = np.nan
    folder = write_dataset(
        {"slow.csv": csv_text(time, U, Y)},
        HEADER + "records: [{file: slow.csv, missing: interpolate}]\n",
    )
    assert load_dataset(folder).read("slow").interpolated is None

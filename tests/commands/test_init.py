"""``hystbench init``: what it writes for files that it does not know beforehand."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from hystbench import cli
from hystbench.dataset import load_dataset
from tests.conftest import refused
from tests.inspection.made import DT, HEADER, loop, sine

FILES = Path(__file__).parents[1] / "formats" / "files"


@pytest.fixture
def run(monkeypatch, capsys, tmp_path):
    """Run a command in a folder of its own, with nobody at the terminal."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr("sys.argv", ["hystbench", *map(str, arguments)])
        status = cli.run()
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


def records(folder, header=HEADER, separator=",", decimal=".", encoding="utf-8"):
    """Write three sines and a chirp."""
    time = DT * np.arange(1200)
    inputs = {f"sine-{hz}": sine(hz) for hz in (5, 10, 20)}
    inputs["chirp"] = np.sin(2 * np.pi * (2 + 10 * time) * time)
    rng = np.random.default_rng(0)
    for name, u in inputs.items():
        y = loop(u) + 0.01 * rng.standard_normal(len(u))
        rows = [
            separator.join(f"{x:.9g}".replace(".", decimal) for x in row)
            for row in zip(time, u, y, strict=True)
        ]
        text = "\n".join([header, *rows]) + "\n"
        (folder / f"{name}.csv").write_text(text, encoding=encoding)
    return sorted(folder.glob("*.csv"))


def written(path="dataset.yaml"):
    return yaml.safe_load(Path(path).read_text(encoding="utf-8"))


def test_columns_units_periods_and_roles_are_found(run, tmp_path):
    status, said, _ = run("init", *records(tmp_path))
    assert status == 0
    about = written()
    assert about["time"] == {"column": "time_s", "unit": "s"}
    assert about["input"] == {"column": "current_A", "unit": "A"}
    assert about["output"] == {"column": "displacement_um", "unit": "um"}
    found = {Path(each["file"]).stem: each for each in about["records"]}
    periods = {name: each.get("period_samples") for name, each in found.items()}
    assert periods == {"chirp": None, "sine-10": 100, "sine-20": 50, "sine-5": 200}
    assert [name for name, each in found.items() if each["use"] == "hold-out"] == [
        "chirp"
    ]
    assert "hystbench check" in said
    dataset = load_dataset("dataset.yaml")
    assert len(dataset.read("chirp")) == 1200


def test_a_german_spreadsheet(run, tmp_path):
    files = records(
        tmp_path, "Zeit [s];Spulenstrom [mA];Weg [µm]", ";", ",", encoding="utf-16"
    )
    assert run("init", *files)[0] == 0
    about = written()
    assert about["input"] == {
        "column": "Spulenstrom [mA]",
        "unit": "mA",
        "name": "Spulenstrom",
    }
    assert about["output"]["unit"] == "um"
    record = load_dataset(".").read("sine-5")
    assert record.dt == pytest.approx(DT)
    np.testing.assert_allclose(record.u, sine(5), atol=1e-8)
    assert record.input.label == "Spulenstrom (mA)"


@pytest.mark.parametrize(
    "header", ["time_s,angle_deg,torque_Nm", "time_s,torque_Nm,angle_deg"]
)
def test_of_a_force_and_a_motion_the_force_is_the_input(run, tmp_path, header):
    """In whatever order they stand; it is said, and another may be asked for."""
    files = records(tmp_path, header)
    status, said, _ = run("init", *files)
    about = written()
    assert status == 0
    assert about["input"] == {"column": "torque_Nm", "unit": "Nm"}
    assert about["output"] == {"column": "angle_deg", "unit": "deg"}
    assert "the force is taken for the input" in said
    assert "'--input angle_deg' takes the other" in said


def test_columns_that_are_left_are_told(run, tmp_path):
    time = DT * np.arange(1200)
    table = np.column_stack([time, sine(5), loop(sine(5)), sine(3)])
    header = "time_s,voltage_V,displacement_cm,force_N"
    file = tmp_path / "a.csv"
    np.savetxt(file, table, "%.9g", ",", header=header, comments="")
    _, said, _ = run("init", file)
    about = written()
    chosen = {about[key]["column"] for key in ("input", "output")}
    (left,) = {"voltage_V", "displacement_cm", "force_N"} - chosen
    assert f"neither input nor output: '{left}'" in said


def test_a_slash_in_the_header_of_a_text_is_no_group(run, tmp_path):
    files = records(tmp_path, "time [s],voltage [V],speed [m/s]")
    assert run("init", *files)[0] == 0
    about = written()
    assert about["input"]["column"] == "voltage [V]"
    assert (about["output"]["column"], about["output"]["unit"]) == (
        "speed [m/s]",
        "m/s",
    )
    assert len(load_dataset(".").read("sine-5")) == 1200


def test_flags_say_what_files_do_not(run, tmp_path):
    files = records(tmp_path, "a,b,c")
    said = refused("init", *files)
    assert "say --input; expected one of b, c" in said
    assert not Path("dataset.yaml").exists()
    flags = ("--input", "b", "--input-unit", "A", "--output-unit", "um")
    flags += ("--hold-out", "sine-10", "--name", "rig", "--device", "piezoelectric")
    assert run("init", *files, *flags)[0] == 0
    about = written()
    assert (about["name"], about["time"]["column"]) == ("rig", "a")
    assert (about["input"]["column"], about["output"]["column"]) == ("b", "c")
    held = [each["file"] for each in about["records"] if each["use"] == "hold-out"]
    assert held == ["sine-10.csv"]
    assert about["device"] == {"kind": "piezoelectric"}
    assert load_dataset("dataset.yaml").device_kind == "piezoelectric"


def test_a_terminal_is_asked(run, tmp_path, monkeypatch):
    files = records(tmp_path, "a,b,c")
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    asked = []

    def prompt(question, **_):
        asked.append(question)
        return {"Which column is the input": "b"}.get(question, "um")

    monkeypatch.setattr("click.prompt", prompt)
    assert run("init", *files)[0] == 0
    assert asked == [
        "Which column is the input",
        "Unit of the input 'b' ('-' for none)",
        "Unit of the output 'c' ('-' for none)",
    ]
    assert written()["input"] == {"column": "b", "unit": "um"}


def test_a_file_of_yours_is_never_overwritten(run, tmp_path):
    files = records(tmp_path)
    Path("dataset.yaml").write_text("name: mine\n")
    said = refused("init", *files)
    assert "not written by hystbench" in said
    assert Path("dataset.yaml").read_text() == "name: mine\n"


def test_a_file_that_changed_is_told(run, tmp_path):
    run("init", *records(tmp_path))
    file = tmp_path / "sine-5.csv"
    file.write_text(file.read_text().replace("0.001,", "0.0010,", 1))
    said = refused("check", "dataset.yaml")
    assert "'sine-5.csv' is not the file that was described" in said


def test_missing_samples_are_interpolated_or_split_on_request(run, tmp_path):
    files = records(tmp_path)
    lines = (tmp_path / "sine-5.csv").read_text().splitlines()
    for row in (400, 401):
        lines[row - 1] = lines[row - 1].rpartition(",")[0] + ","
    (tmp_path / "sine-5.csv").write_text("\n".join(lines) + "\n")
    said = refused("init", *files)
    assert "2 of 1200 samples are missing, the first at row 400" in said
    assert "--missing" in said
    assert run("init", *files, "--missing", "interpolate")[0] == 0
    there = load_dataset(".").read("sine-5")
    assert len(there) == 1200
    # Rows 399 and 402 stand, samples 397 and 400; a third of the way lies 398.
    third = (2 * there.y[397] + there.y[400]) / 3
    assert there.y[398] == pytest.approx(third, rel=1e-9)
    status, said, _ = run("init", *files, "--missing", "split")
    assert status == 0
    assert "split into 2 pieces" in said
    dataset = load_dataset(".")
    pieces = [dataset.read(f"sine-5-{k}") for k in (1, 2)]
    assert [len(piece) for piece in pieces] == [398, 800]
    np.testing.assert_array_equal(pieces[1].y, there.y[400:])


def test_rounded_times_become_a_sampling_frequency(run, tmp_path):
    files = records(tmp_path)
    for file in files:
        head, *rows = file.read_text().splitlines()
        cells = [row.split(",") for row in rows]
        rounded = [f"{float(t):.2f},{u},{y}" for t, u, y in cells]
        file.write_text("\n".join([head, *rounded]) + "\n")
    status, said, _ = run("init", *files)
    assert status == 0
    assert "rounded to more than the sampling interval" in said
    about = written()
    assert "time" not in about
    rate = about["records"][0]["sampling_frequency_hz"]
    assert rate == pytest.approx(1000, rel=0.01)


@pytest.mark.parametrize("share", [0.012, 0.03, 0.1, 0.2])
def test_of_a_clock_that_jitters_the_tolerance_is_written(run, tmp_path, share):
    rng = np.random.default_rng(1)
    time = DT * (np.arange(1200) + share * rng.uniform(-1, 1, 1200))
    for hz in (5, 10):
        u = sine(hz)
        table = zip(time, u, loop(u), strict=True)
        rows = (f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in table)
        (tmp_path / f"run-{hz}.csv").write_text("\n".join([HEADER, *rows]) + "\n")
    status, said, error = run("init", *sorted(tmp_path.glob("*.csv")))
    assert (status, error) == (0, "")
    worst = np.abs(np.diff(time) / np.diff(time).mean() - 1).max()
    # A tenth is added, as another record may be somewhat worse.
    assert written()["time"]["tolerance"] == pytest.approx(1.1 * worst, abs=2e-3)
    assert "'tolerance' is written" in said
    load_dataset(tmp_path / "dataset.yaml").read("run-5")


def test_samples_at_uneven_times_are_interpolated_on_demand(run, tmp_path):
    rng = np.random.default_rng(1)
    time = np.cumsum(DT * rng.choice([1.0, 1.0, 1.0, 2.4], 1800))
    u = np.sin(2 * np.pi * 5 * time)
    rows = (f"{t:.9g},{a:.9g},{2 * a:.9g}" for t, a in zip(time, u, strict=True))
    file = tmp_path / "run.csv"
    file.write_text("\n".join([HEADER, *rows]) + "\n")
    status, _, error = run("init", file)
    assert status != 0
    assert "--uneven" in error
    status, said, error = run("init", file, "--uneven", "interpolate")
    assert (status, error) == (0, "")
    assert "interpolated to even times" in said
    assert written()["time"]["uneven"] == "interpolate"
    record = load_dataset(tmp_path / "dataset.yaml").read("run-1")
    assert record.dt == pytest.approx(DT)
    np.testing.assert_allclose(record.y, 2 * record.u, atol=1e-6)


def with_rows_lost(folder, lost, more=""):
    """Write two records, of the first of which stretches of rows are lost."""
    for hz in (5, 10):
        u = sine(hz)
        rows = zip(DT * np.arange(1200), u, loop(u), strict=True)
        lines = [f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in rows]
        if hz == 5:
            gone = {k for first, behind in lost for k in range(first, behind)}
            lines = [line for k, line in enumerate(lines) if k not in gone]
        (folder / f"run-{hz}.csv").write_text("\n".join([HEADER, *lines]) + "\n")
    return sorted(folder.glob("*.csv"))


def test_a_record_is_cut_where_rows_are_lost(run, tmp_path):
    files = with_rows_lost(tmp_path, [(400, 460), (700, 701), (710, 800)])
    status, said, error = run("init", *files)
    assert (status, error) == (0, "")
    found = [each for each in written()["records"] if each["file"] == "run-5.csv"]
    # Rows that are there: 400, then 700 - 460, then 9 that are too few, then 400.
    assert [each["rows"] for each in found] == [[1, 400], [401, 640], [650, 1049]]
    assert [each["name"] for each in found] == ["run-5-1", "run-5-2", "run-5-3"]
    # The header is a row too: after the 400th sample comes row 402.
    assert "run-5.csv: time jumps at row 402 and 2 more" in said
    assert "9 samples in pieces shorter than 20 are left out" in said
    dataset = load_dataset(tmp_path / "dataset.yaml")
    assert [len(dataset.read(name)) for name in ("run-5-1", "run-5-3")] == [400, 400]


def test_where_rows_are_lost_all_over_the_file_is_refused(run, tmp_path):
    files = with_rows_lost(tmp_path, [(k, k + 3) for k in range(10, 1190, 15)])
    error = refused("init", *files)
    assert "a step in time of 0.004 s" in error
    assert not Path("dataset.yaml").exists()


def test_another_sampling_rate_from_some_row_on_is_refused(run, tmp_path):
    files = with_rows_lost(tmp_path, [(k, k + 1) for k in range(401, 999, 2)])
    error = refused("init", *files)
    assert "run-5.csv: row 403: a step in time of 0.002 s" in error
    assert "expected uniform sampling" in error
    assert "give 'sampling_frequency_hz: " in error
    assert "(init: --sampling-frequency)" in error


def test_a_piece_of_one_time_is_left_out(run, tmp_path):
    files = with_rows_lost(tmp_path, [(30, 330)])
    head, *rows = files[1].read_text().splitlines()
    for k in range(1, 30):
        rows[k] = "," + rows[k].partition(",")[2]
    files[1].write_text("\n".join([head, *rows]) + "\n")
    given = ("--missing", "split", "--time", "time_s")
    status, said, error = run("init", *files, *given)
    assert (status, error) == (0, "")
    assert "into 1 piece;" in said
    assert "1 sample in pieces shorter than 20 is left out" in said
    (found,) = (x for x in written()["records"] if x["file"] == "run-5.csv")
    assert found["rows"] == [31, 900]


def test_rows_that_are_lost_and_cells_that_are_empty_are_both_cut(run, tmp_path):
    files = with_rows_lost(tmp_path, [(400, 460)])
    lines = files[1].read_text().splitlines()
    lines[201] = lines[201].rpartition(",")[0] + ","
    files[1].write_text("\n".join(lines) + "\n")
    assert run("init", *files, "--missing", "split")[0] == 0
    found = [each for each in written()["records"] if each["file"] == "run-5.csv"]
    assert [each["rows"] for each in found] == [[1, 200], [202, 400], [401, 1140]]


def test_no_column_of_time_needs_a_sampling_frequency(run, tmp_path):
    files = records(tmp_path, "t,u,y")
    for file in files:
        rows = [line.partition(",")[2] for line in file.read_text().splitlines()]
        file.write_text("\n".join(rows) + "\n")
    said = refused("init", *files)
    assert "say --sampling-frequency" in said
    assert run("init", *files, "--sampling-frequency", "1000")[0] == 0
    assert written()["sampling_frequency_hz"] == 1000
    assert load_dataset(".").read("chirp").dt == pytest.approx(DT)


def test_a_lone_record_is_cut_by_whole_periods(run, tmp_path):
    records(tmp_path)
    status, said, _ = run("init", tmp_path / "sine-20.csv")
    assert status == 0
    assert "one record alone" in said
    first, second = written()["records"]
    assert (first["use"], second["use"]) == ("fit", "hold-out")
    assert first["rows"] == [1, 800]
    assert second["rows"] == [801, 1200]
    assert (first["period_samples"], second["period_samples"]) == (50, 50)


@pytest.mark.parametrize(
    ("name", "package", "groups", "units"),
    [
        ("stranger.mat", "h5py", ["run01", "run02", "run03", "run04"], ("-", "-")),
        ("pytables.h5", "h5py", ["fast", "slow"], ("A", "um")),
        ("rig.tdms", "nptdms", ["slow", "fast"], ("A", "um")),
        ("octave-runs.mat", "scipy", ["runs(1)", "runs(2)"], ("-", "-")),
    ],
)
def test_groups_of_a_file_are_records(run, tmp_path, name, package, groups, units):
    pytest.importorskip(package, reason=f"{package} is not installed")
    shutil.copy(FILES / name, tmp_path)
    assert run("init", name)[0] == 0
    about = written()
    assert [each["group"] for each in about["records"]] == groups
    assert (about["input"]["unit"], about["output"]["unit"]) == units
    assert "time" not in about  # the files tell the rate
    dataset = load_dataset(".")
    for record in dataset.record_files:
        assert dataset.read(record).dt == pytest.approx(DT)


def test_nothing_usable_is_one_line(run, tmp_path):
    (tmp_path / "one.csv").write_text("t,u\n0,1\n1,2\n")
    said = refused("init", tmp_path / "one.csv")
    assert "no two columns of 20 samples or more" in said


def test_one_of_several_records_of_a_file_is_simulated_by_its_name(run, tmp_path):
    pytest.importorskip("h5py", reason="h5py is not installed")
    shutil.copy(FILES / "pytables.h5", tmp_path)
    run("init", "pytables.h5")
    Path("model.yaml").write_text(
        "name: m\ninput: {name: current, unit: A}\noutput: {name: stroke, unit: um}\n"
        "chain: [{gain: {value: 2}}]\n"
    )
    said = refused("simulate", "model.yaml", "pytables.h5", "--out", "y.csv")
    assert "holds pytables-fast, pytables-slow" in said
    assert run("load", "dataset.yaml", "pytables-slow", "--out", "r.npz")[0] == 0
    assert run("simulate", "model.yaml", "r.npz", "--out", "y.csv")[0] == 0
    table = np.loadtxt("y.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(table[:, 3], 2 * table[:, 1], rtol=1e-9)


def lone(folder, name="run.csv", stamps=None, noise=0.01, missing=()):
    """Write one sine; rows of ``missing`` samples have no output."""
    u = sine(20)[:1200]
    y = loop(u) + noise * np.random.default_rng(1).standard_normal(len(u))
    times = stamps or [f"{DT * k:.3f}" for k in range(len(u))]
    cells = ["" if k in missing else f"{x:.9g}" for k, x in enumerate(y)]
    rows = [f"{t},{v:.9g},{x}" for t, v, x in zip(times, u, cells, strict=True)]
    (folder / name).write_text("\n".join([HEADER, *rows]) + "\n")
    return folder / name


def names():
    """Names of the records of what was written, read as every command reads it."""
    return list(load_dataset(".").record_files)


def test_pieces_of_a_file_are_not_called_like_another_file(run, tmp_path):
    files = [lone(tmp_path, missing=(500,)), *records(tmp_path)[:1]]
    files[1] = files[1].rename(tmp_path / "run-1.csv")
    assert run("init", *files, "--missing", "split")[0] == 0
    assert names() == ["run-2", "run-3", "run-1"]


@pytest.mark.parametrize("told", ["nan", "inf", "0", "-5", "1e-320"])
def test_a_sampling_frequency_is_finite_and_above_0(run, tmp_path, monkeypatch, told):
    file = lone(tmp_path)
    rows = [line.partition(",")[2] for line in file.read_text().splitlines()]
    file.write_text("\n".join(rows) + "\n")
    said = refused("init", file, f"--sampling-frequency={told}")
    assert "--sampling-frequency" in said
    assert "expected a finite number of Hz above 0" in said
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    monkeypatch.setattr("click.prompt", lambda *_, **__: told)
    status, _, said = run("init", file)
    assert status == 2
    assert "expected a finite number of Hz above 0" in said


@pytest.mark.parametrize(
    ("flag", "value", "expected"),
    [
        ("--name", "bad/name", "name: 'bad/name'"),
        ("--device", "piezo", "piezoelectric"),
    ],
)
def test_what_no_command_takes_is_not_written(run, tmp_path, flag, value, expected):
    assert expected in refused("init", *records(tmp_path), flag, value)
    assert not Path("dataset.yaml").exists()


def test_a_file_whose_name_is_no_name_of_a_record(run, tmp_path):
    assert run("init", lone(tmp_path, "r{1}.csv"))[0] == 0
    assert names() == ["r-1-1", "r-1-2"]


def test_a_folder_that_is_not_there_yet(run, tmp_path):
    lone(tmp_path)
    assert run("init", "run.csv", "--out", "new/folder/dataset.yaml")[0] == 0
    dataset = load_dataset("new/folder")
    assert {each["file"] for each in dataset.about["records"]} == {"../../run.csv"}
    assert len(dataset.read("run-1")) == 800


def test_a_folder_that_is_a_link(run, tmp_path):
    lone(tmp_path)
    Path("deep/real").mkdir(parents=True)
    Path("link").symlink_to("deep/real")
    assert run("init", "run.csv", "--out", "link/dataset.yaml")[0] == 0
    assert len(load_dataset("link").read("run-1")) == 800


def test_a_lone_record_of_equal_periods_has_nothing_to_hold_out(run, tmp_path):
    status, out, said = run("init", lone(tmp_path, noise=0))
    assert status == 0
    assert "hystbench gap" not in out  # it would refuse
    warned = [line for line in said.splitlines() if "nothing is held out" in line]
    assert len(warned) == 1
    assert "add a record of another input" in warned[0]
    assert names() == ["run"]
    assert load_dataset(".").use("run") == "fit"
    assert run("check", "dataset.yaml")[0] == 0


def test_a_lone_record_is_cut_beside_missing_samples(run, tmp_path):
    file = lone(tmp_path, missing=range(795, 805))
    status, _, said = run("init", file, "--missing", "interpolate")
    assert (status, said) == (0, "")
    first, second = written()["records"]
    assert (first["rows"], second["rows"]) == ([1, 795], [806, 1200])
    assert [len(load_dataset(".").read(name)) for name in names()] == [795, 395]


def test_dates_and_times_are_seconds_from_the_first(run, tmp_path):
    stamps = [
        f"2024-02-28 23:59:{59 + k // 1000:02d}.{k % 1000:03d}"
        if k < 1000
        else f"2024-02-29 00:00:00.{k - 1000:03d}"
        for k in range(1200)
    ]
    file = lone(tmp_path, stamps=stamps)
    file.write_text(file.read_text().replace(HEADER, "Timestamp,current_A,stroke_um"))
    assert run("init", file)[0] == 0
    assert written()["time"] == {"column": "Timestamp", "unit": "s"}
    record = load_dataset(".").read("run-1")
    assert record.dt == pytest.approx(DT, rel=1e-9)
    assert len(record) == 800


@pytest.mark.parametrize(
    ("lost", "pieces"),
    [(12, ["run"]), (13, ["run-1", "run-2"])],  # 20 Hz at 1 kHz: 50 samples a period
)
def test_a_gap_of_the_input_is_bridged_up_to_a_quarter_of_its_period(
    run, tmp_path, lost, pieces
):
    file = lone(tmp_path)
    lines = file.read_text().splitlines()
    for k in range(601, 601 + lost):
        time, _, y = lines[k].split(",")
        lines[k] = f"{time},,{y}"
    file.write_text("\n".join(lines) + "\n")
    other = lone(tmp_path, "whole.csv", noise=0.02)
    status, said, _ = run(
        "init", file, other, "--missing", "interpolate", "--hold-out", "whole"
    )
    assert status == 0
    assert ("quarter of its fastest period" in said) == (len(pieces) == 2)
    assert names()[:-1] == pieces


def test_a_long_gap_of_the_output_alone_costs_its_samples_only(run, tmp_path):
    file = lone(tmp_path, missing=range(500, 700))
    other = lone(tmp_path, "whole.csv", noise=0.02)
    given = ("--missing", "interpolate", "--hold-out", "whole")
    assert run("init", file, other, *given)[0] == 0
    record = load_dataset(".").read("run")
    assert len(record) == 1200
    assert np.flatnonzero(~record.counted).tolist() == list(range(500, 700))


@pytest.mark.parametrize(
    ("first", "per_second", "unit", "rtol"),
    [(1709208000000, 1000, "ms", 1e-6), (45351.5, 1 / 86400, "day", 1e-3)],
)
def test_times_that_count_from_a_date(run, tmp_path, first, per_second, unit, rtol):
    stamps = [f"{first + DT * k * per_second:.12f}" for k in range(1200)]
    file = lone(tmp_path, stamps=stamps)
    file.write_text(file.read_text().replace("time_s", "Time"))
    status, said, _ = run("init", file)
    assert status == 0
    assert "from 2024-02-29 12:00:00.000 on (--time-unit)" in said
    assert written()["time"]["unit"] == unit
    assert load_dataset(".").read("run-1").dt == pytest.approx(DT, rel=rtol)


@pytest.mark.parametrize("header", ["t_s,Weg_mm,hub_um", "t_s,force_N,stroke_mm"])
def test_of_two_outputs_the_first_is_the_input_and_that_is_said(run, tmp_path, header):
    """Most write the input first; of a force and a motion the force is it."""
    files = records(tmp_path, header)
    _, one, two = header.split(",")
    status, said, _ = run("init", *files)
    assert status == 0
    assert written()["input"]["column"] == one
    assert f"note: input: {one!r}, output: {two!r}" in said
    assert f"'--input {two}' takes the other" in said
    status, said, _ = run("init", *files, "--input", two, "--out", "other.yaml")
    assert status == 0
    assert written("other.yaml")["input"]["column"] == two
    assert "takes the other" not in said


def test_of_two_outputs_the_input_is_asked_for_at_a_terminal(
    run, tmp_path, monkeypatch
):
    files = records(tmp_path, "t_s,Weg_mm,Kraft_N")
    asked = []

    def answer(question, **about):
        asked.append((question, about["default"]))
        return "Kraft_N"

    monkeypatch.setattr("click.prompt", answer)
    for stream in ("stdin", "stdout"):
        monkeypatch.setattr(f"sys.{stream}.isatty", lambda: True, raising=False)
    assert run("init", *files)[0] == 0
    assert asked == [("Which column is the input", "Kraft_N")]
    assert written()["input"]["column"] == "Kraft_N"


def test_a_kind_that_is_none_may_be_left_out(run, tmp_path):
    status, _, told = run("init", *records(tmp_path), "--device", "magnetorheological")
    assert status
    assert "'magnetorheological' is not one of" in told
    assert told.rstrip().endswith("; leave it out where none fits")

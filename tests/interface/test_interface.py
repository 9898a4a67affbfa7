"""``from hystbench import ...``: light to import, telling to look at."""

import json
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner

import hystbench
from hystbench.commands import gap as command
from hystbench.errors import InputError
from tests.gap.tiny import DT, SAMPLES, write_tiny


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    return write_tiny(tmp_path_factory.mktemp("tiny"))


@pytest.fixture(scope="module")
def dataset(tiny):
    return hystbench.load_dataset(tiny[0])


@pytest.fixture(scope="module")
def found(dataset, tiny):
    return hystbench.find_gap(dataset, hystbench.load_model(tiny[1]))


def test_importing_hystbench_imports_nothing_heavy():
    code = (
        "import sys; import hystbench; "
        "print(*(name for name in sys.modules if name.partition('.')[0] in "
        "('hystbench', 'numpy', 'scipy', 'pandas', 'matplotlib', 'click')))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.split() == ["hystbench"], done.stderr


def test_every_name_that_is_promised_is_there():
    for name in hystbench.__all__:
        assert getattr(hystbench, name)
    with pytest.raises(AttributeError, match="load_models"):
        _ = hystbench.load_models


def test_a_dataset_tells_records_rates_units_and_roles(dataset):
    first, *rows = repr(dataset).splitlines()
    assert first == "Dataset tiny: 4 records, current (A) to displacement (um)"
    assert [row.split()[:2] for row in rows] == [
        ["slow", "fit"],
        ["fast", "fit"],
        ["sweep", "fit"],
        ["unseen", "hold-out"],
    ]
    assert f"{SAMPLES} samples at {1 / DT:g} Hz, {SAMPLES * DT:g} s" in rows[0]


def test_a_record_is_had_by_its_name(dataset):
    assert dataset["fast"].name == "fast"
    assert [record.name for record in dataset] == list(dataset.record_files)
    with pytest.raises(InputError, match=r"no record 'fst'.*'fast'"):
        dataset["fst"]


def test_the_table_of_a_dataset_holds_its_samples(dataset):
    frame = dataset.to_frame()
    assert list(frame) == ["record", "use", "time_s", "current_A", "displacement_um"]
    slow = frame[frame["record"] == "slow"]
    np.testing.assert_array_equal(slow["displacement_um"], dataset["slow"].y)
    assert set(frame[frame["use"] == "hold-out"]["record"]) == {"unseen"}


def labels(figure):
    return {axes.get_xlabel() for axes in figure.axes} | {
        axes.get_ylabel() for axes in figure.axes
    }


def test_the_picture_of_a_dataset_has_units(dataset):
    figure = dataset.plot()
    assert len(figure.axes) == 3 * len(dataset)
    assert labels(figure) == {"time (s)", "current (A)", "displacement (µm)"}
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_a_gap_tells_its_verdict(found):
    first, *rest = repr(found).splitlines()
    assert first.endswith("The simulator lacks drive lag.")
    assert found.sentence == "The simulator lacks drive lag."
    size = found.content["gap"]
    assert f"{size['before']:.3g} to {size['after']:.3g} um rms" in rest[0]
    assert "drive-lag (drive), confidence" in rest[1]
    assert " s" in rest[1]


def test_the_model_that_came_out_runs(found, dataset):
    record = dataset["unseen"]
    left = record.y - found.model.simulate(record.u, record.dt)
    rms = float(np.sqrt(np.mean(left**2)))
    assert rms == pytest.approx(found.content["gap"]["after"], rel=1e-6)


def test_the_tables_of_a_gap(found):
    records = found.to_frame()
    assert list(records) == ["record", "before (um)", "after (um)"]
    assert records["before (um)"].iloc[0] == found.content["records"][0]["before"]
    effects = found.to_frame("effects")
    row = effects[effects["parameter"] == "time_constant_s"].iloc[0]
    assert (row["effect"], row["unit"]) == ("drive-lag", "s")
    assert row["value"] == found.effects[0].parameters["time_constant_s"]["value"]
    ranking = found.to_frame("ranking")
    assert ranking["name"].iloc[0] == "drive-lag"
    with pytest.raises(InputError, match=r"no table 'effect'.*'effects'"):
        found.to_frame("effect")


def test_the_picture_of_a_gap_has_units(found):
    figure = found.plot()
    assert labels(figure) == {
        "current (A)",
        "displacement (µm)",
        "time (s)",
        "residual (µm)",
    }


def test_a_saved_gap_is_what_the_command_writes(found, tiny, tmp_path):
    data, base = tiny
    found.save(tmp_path / "saved", report=False)
    words = [str(data), "--model", str(base), "--out", str(tmp_path / "written")]
    result = CliRunner().invoke(command.gap, [*words, "--no-report"])
    assert result.exit_code == 0, result.output

    def files(name):
        folder = tmp_path / name
        known = {
            str(path.relative_to(folder)): path.read_bytes()
            for path in folder.rglob("*")
            if path.is_file() and ".hystbench" not in path.parts
        }
        gap = json.loads(known.pop("gap.json"))
        gap.pop("command")  # where it was asked for, and from where
        return known, gap

    assert files("saved") == files("written")


def test_what_somebody_else_wrote_is_not_replaced(found, tmp_path):
    (tmp_path / "gap.json").write_text("mine")
    with pytest.raises(InputError, match="not written by hystbench"):
        found.save(tmp_path)
    assert (tmp_path / "gap.json").read_text() == "mine"


def test_what_of_a_dataset_is_hardly_meant_is_a_warning(tiny, tmp_path, monkeypatch):
    """The search itself is not run: the records are told of before."""
    data, base = tiny
    for file in data.iterdir():
        (tmp_path / file.name).write_text(file.read_text())
    (tmp_path / "fast.csv").write_text((data / "slow.csv").read_text())
    monkeypatch.setattr("hystbench.interface.gap.closed_gap", lambda *_, **__: None)
    with pytest.warns(UserWarning, match="equal"):
        hystbench.find_gap(tmp_path, base)

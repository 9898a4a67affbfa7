"""What cannot be used is refused in one line, before anything is written.

Bases that are functions or columns have tests of their own beside their module.
"""

import json
import shutil

import numpy as np
import pytest
import yaml

from hystbench.errors import InputError
from hystbench.files import write_text
from hystbench.gap.records.evidence import load_evidence
from hystbench.model import load_model
from hystbench.written import ENTRIES, TEMPORARY
from tests.gap.closing import close_gap
from tests.gap.made import record, write_folder
from tests.gap.searched import among

ABOUT = {
    "name": "rig",
    "time": {"column": "time_s", "unit": "s"},
    "input": {"column": "current_A", "unit": "A"},
    "output": {"column": "displacement_um", "unit": "um"},
}
USES = {"one": "fit", "two": "fit", "three": "hold-out"}
COUNT = 800
LATE = ("drive-lag", "sensor-lag", "input-delay")
"""What is tried where no test is about others: the lag that is put in, and its like."""


def tables():
    """A plain gain and a lag of one sample, in three records."""
    rng = np.random.default_rng(0)
    t = np.arange(COUNT) / 1000
    found = {}
    for k, name in enumerate(USES):
        u = (0.5 + 0.1 * k) * np.sin(2 * np.pi * (3 + 2 * k) * t)
        y = 12 * np.concatenate([[0], u[:-1]]) + 0.02 * rng.standard_normal(COUNT)
        found[name] = np.column_stack([t, u, y])
    return found


@pytest.fixture
def rig(tmp_path):
    """Write a dataset and a base, run the workflow on them."""

    def run(
        records=None,
        about=None,
        uses=None,
        model=None,
        report=False,
        real=None,
        likely=LATE,
    ):
        folder = tmp_path / "rig"
        folder.mkdir()
        for name, table in (records or tables()).items():
            np.savetxt(
                folder / f"{name}.csv",
                table,
                delimiter=",",
                fmt="%.9g",
                header="time_s,current_A,displacement_um",
                comments="",
            )
        said = {} if real is None else {"stands_still": real}
        entries = [
            {"file": f"{k}.csv", "use": v, **said} for k, v in (uses or USES).items()
        ]
        content = {**ABOUT, **(about or {}), "records": entries}
        (folder / "dataset.yaml").write_text(yaml.safe_dump(content))
        base = {
            "name": "simulator",
            "input": {"name": "current", "unit": "A"},
            "output": {"name": "displacement", "unit": "um"},
            "chain": [{"gain": {"value": 12.0}}],
            **(model or {}),
        }
        (tmp_path / "model.yaml").write_text(yaml.safe_dump(base))
        evidence = load_evidence(folder)
        place = tmp_path / "model.yaml"
        return close_gap(
            evidence,
            load_model(place),
            tmp_path / "out",
            place=str(place),
            report=report,
            vocabulary=among(*likely),
        )

    run.out = tmp_path / "out"
    return run


def refused(rig, *words, **given):
    """Run and expect one line with some words, and nothing written."""
    with pytest.raises(InputError) as caught:
        rig(**given)
    message = str(caught.value)
    assert "\n" not in message
    for word in words:
        assert word in message
    assert not rig.out.exists()


def changed(name, change):
    records = tables()
    change(records[name])
    return records


def shown(folder):
    """Texts of all files of a result, but the list of what was written."""
    return {
        str(item.relative_to(folder)): item.read_text()
        for item in folder.rglob("*")
        if item.is_file() and ENTRIES not in item.parts
    }


def test_what_is_right_is_written_whole(rig):
    """The same rig without a fault: what is refused below is refused for its fault."""
    rig()
    found = set(shown(rig.out))
    assert found == {"gap.json", "model.yaml", "curves.json", "holdout/three.csv"}
    content = json.loads((rig.out / "gap.json").read_text())
    assert content["verdict"] in ("named", "unnamed")


def test_an_effect_for_which_records_are_too_short_declines_by_name(rig):
    short = {name: table[:200] for name, table in tables().items()}
    rig(records=short, likely=("sensor-lag", "creep"))
    content = json.loads((rig.out / "gap.json").read_text())
    declined = {x["name"]: x["declined"] for x in content["ranking"] if "declined" in x}
    assert "too short" in declined["creep"]


@pytest.mark.parametrize("channel", ["input", "output"])
def test_units_that_do_not_match(rig, channel):
    about = {channel: {"name": "x", "unit": "V"}}
    unit = {"input": "A", "output": "um"}[channel]
    refused(rig, "model.yaml", channel, "unit", "'V'", repr(unit), model=about)


def test_no_record_is_held_out(rig):
    uses = dict.fromkeys(USES, "fit")
    refused(rig, "dataset.yaml", "use: hold-out", uses=uses)


def test_no_record_is_to_be_fitted(rig):
    uses = dict.fromkeys(USES, "hold-out")
    refused(rig, "dataset.yaml", "use: fit", uses=uses)


@pytest.mark.parametrize("name", USES)
def test_a_clipped_channel(rig, name):
    def clip(table):
        top = 0.6 * table[:, 2].max()
        np.minimum(table[:, 2], top, out=table[:, 2])

    refused(
        rig,
        f"{name}.csv",
        "displacement",
        "clipped",
        "row",
        records=changed(name, clip),
    )


def test_a_drive_that_saturates_is_named_once_the_dataset_says_that_it_is_real(rig):
    """Its output stands still at the limit, in steps of a coarse converter."""
    limit, step = 0.35, 0.05
    records = tables()
    for table in records.values():
        driven = np.clip(table[:, 1], -limit, limit)
        table[:, 2] = np.round(12 * driven / step) * step
    refused(rig, "one.csv", "clipped", "'stands_still: [output]'", records=records)
    shutil.rmtree(rig.out.parent / "rig")
    curves = ("drive-saturation", "saturation", "asymmetry", "dead-zone")
    closed = rig(records=records, real=["output"], likely=curves)
    (effect,) = closed.outcome.content["effects"]
    assert effect["name"] == "drive-saturation"
    assert effect["parameters"]["limit"]["value"] == pytest.approx(limit, rel=0.02)


@pytest.mark.parametrize("name", USES)
def test_a_stuck_channel(rig, name):
    def stick(table):
        table[300:500, 2] = table[299, 2]

    refused(rig, f"{name}.csv", "displacement", "row 301", records=changed(name, stick))


@pytest.mark.parametrize("name", USES)
def test_a_clipped_input(rig, name):
    def clip(table):
        top = 0.6 * table[:, 1].max()
        np.minimum(table[:, 1], top, out=table[:, 1])

    words = (f"{name}.csv", "current", "clipped", "row")
    refused(rig, *words, records=changed(name, clip))


def test_a_stuck_input(rig):
    def stick(table):
        table[300:500, 1] = table[299, 1]

    refused(rig, "one.csv", "current", "row 301", records=changed("one", stick))


@pytest.mark.parametrize(
    ("name", "count"), [("one", 190), ("two", 190), ("three", 155)]
)
def test_an_input_that_is_stuck_from_the_first_sample_on(rig, name, count):
    """Until it jumps into the middle of a motion, which the output was in all along."""

    def stick(table):
        table[:count, 1] = table[0, 1]

    words = (f"{name}.csv", "current", "row 2", f"{count} samples", "stuck")
    refused(rig, *words, records=changed(name, stick))


@pytest.mark.parametrize("name", USES)
@pytest.mark.parametrize("column", [1, 2])
def test_a_channel_that_never_moves_in_one_record(rig, name, column):
    def stick(table):
        table[:, column] = table[7, column]

    told = f"column {['time_s', 'current_A', 'displacement_um'][column]!r}: constant"
    refused(rig, f"{name}.csv", told, records=changed(name, stick))


def respond(u, frequency_hz, damping):
    """A mode, step by step as its differential equation says."""
    w, x, v, out = 2 * np.pi * frequency_hz, float(u[0]), 0.0, []
    for value in u.tolist():
        for _ in range(20):
            v += 5e-5 * (w * w * (value - x) - 2 * damping * w * v)
            x += 5e-5 * v
        out.append(x)
    return np.array(out)


@pytest.mark.parametrize("frequency_hz", [3.0, 10.0, 60.0])
@pytest.mark.parametrize("damping", [0.02, 0.3, 1.5])
@pytest.mark.parametrize("shape", ["steps", "ramps and holds", "ramps and drops"])
def test_an_input_that_rests_is_no_fault(tmp_path, shape, frequency_hz, damping):
    """Whatever the output does meanwhile: settles, rings or creeps."""
    t = np.arange(2000) / 1000
    ramp = np.clip(np.abs(np.mod(t, 1.0) - 0.5) * 10 - 1, 0, 1)
    drop = np.clip(np.mod(t, 1.0) * 2, 0, 1)
    u = {
        "steps": np.floor(t * 4) % 3,
        "ramps and holds": ramp,
        "ramps and drops": drop,
    }[shape]
    y = respond(u, frequency_hz, damping)
    sizes = dict(zip(USES, (1.0, 0.9, 0.8), strict=True))
    made = [
        record(sizes[k] * u, sizes[k] * y, name=k, use=use) for k, use in USES.items()
    ]
    load_evidence(write_folder(tmp_path / "rests", made))


@pytest.mark.parametrize("column", [1, 2])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_value_that_is_no_number(rig, column, value):
    def spoil(table):
        table[41, column] = value

    refused(rig, "two.csv", "row 43", "finite", records=changed("two", spoil))


def test_samples_that_are_missing(rig):
    records = tables()
    records["two"] = np.delete(records["two"], np.s_[100:103], axis=0)
    refused(rig, "two.csv", "row 102", "uniform", records=records)


def test_records_of_different_rates_are_no_fault(rig):
    records = tables()
    records["two"] = records["two"][::2]
    records["three"] = records["three"][::4]
    closed = rig(records=records)
    assert len({one.dt for one in closed.decision.state.records}) == 2
    assert (rig.out / "gap.json").is_file()


def test_a_fit_record_of_a_few_samples(rig):
    records = tables()
    records["one"] = records["one"][:9]
    refused(rig, "one", "samples", records=records)


SQUARES = 4 * [{"asymmetry": {"coefficient": 1e-6}}]
SQUARE = {"chain": [{"gain": {"value": 12.0}}, *SQUARES]}
"""A base whose output is beyond any number for an input of 1e29."""


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")
@pytest.mark.parametrize("name", USES)
def test_a_base_that_is_not_finite_on_a_record(rig, name):
    """A fit record or a hold-out record: the model, the time and the record."""

    def leap(table):
        table[501:, 1] *= 1e29

    refused(
        rig,
        f"simulator: the output is not finite from 0.501 s of {name} on",
        records=changed(name, leap),
        model=SQUARE,
    )


PAGE = "hystbench.gap.report.page.write_report"


@pytest.mark.parametrize("earlier", [False, True])
def test_a_page_that_fails_leaves_no_half_of_a_result(rig, monkeypatch, earlier):
    """What was there before stays as it was; where nothing was, nothing is."""

    def fail(folder):
        assert (folder / "gap.json").is_file()  # all else is there by then
        raise RuntimeError("no ink")

    if earlier:
        for name in ("gap.json", "report.html"):
            write_text(rig.out / name, "before")
        (rig.out / "notes.txt").write_text("before")
    before = shown(rig.out)
    monkeypatch.setattr(PAGE, fail)
    with pytest.raises(RuntimeError, match="no ink"):
        rig(report=True)
    assert rig.out.exists() is earlier
    assert shown(rig.out) == before
    assert not list(rig.out.parent.glob(f"{TEMPORARY}*"))


def test_nothing_of_an_earlier_result_stays_and_what_is_foreign_does(rig):
    old = ("holdout/gone.csv", "report.html", "gap.json")
    mine = ("notes.txt", "holdout/notes.txt", "stages/decision.json")
    for name in old:
        write_text(rig.out / name, "before")
    for name in mine:
        (rig.out / name).parent.mkdir(parents=True, exist_ok=True)
        (rig.out / name).write_text("before")
    rig()
    found = set(shown(rig.out))
    new = {"gap.json", "model.yaml", "curves.json", "holdout/three.csv"}
    assert found == new | set(mine)
    assert (rig.out / "gap.json").read_text() != "before"


def test_a_base_that_cannot_be_made(rig):
    refused(rig, "model.yaml", "gian", "gain", model={"chain": [{"gian": {}}]})

"""What a page of several devices shows of each."""

import csv
from dataclasses import asdict

import pytest

from hystbench.errors import InputError
from hystbench.gap.computing_time import write_seconds, write_took
from hystbench.gap.locate.picture import Axis, Panel, ViewPicture
from hystbench.gap.report.tables import write_gallery, write_host, write_table
from hystbench.gap.report.where_pictures import first_picture
from hystbench.gap.report.words import verdict_text
from hystbench.model import Model
from tests.gap.report.test_report import GAP, write_folder

NAMES = ("model", "residual", "where")
PICTURES = [f"{name}.{kind}" for name in NAMES for kind in ("svg", "png")]
#: SVG that a page can carry several of.
SMALL = 150_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = write_folder(tmp_path_factory.mktemp("gallery"))
    write_gallery(folder)
    return folder


@pytest.mark.parametrize("name", PICTURES)
def test_pictures_are_there_and_small(folder, name):
    content = (folder / name).read_bytes()
    if name.endswith("svg"):
        assert content.startswith(b"<?xml")
        assert len(content) < SMALL
    else:
        assert content.startswith(b"\x89PNG")


def test_modes_by_level_come_first_where_they_are_seen():
    panel = Panel(Axis("input", "N"), Axis("output", "m"))
    others = asdict(ViewPicture("spectrum", "a", (panel,)))
    levels = asdict(ViewPicture("levels", "b", (panel, panel)))
    for pictures, panels in (([others, levels], 2), ([others], 1)):
        drawn = first_picture({"pictures": pictures, "not_drawn": []})
        assert len(drawn.axes) == panels


def test_the_verdict_is_told_with_its_reason(folder):
    told = (folder / "verdict.md").read_text()
    assert told == (
        f"**The simulator lacks resonance and creep.**\n\n{GAP['reason']}\n"
    )


def test_where_there_is_no_gap_the_reason_is_in_the_sentence():
    gap = {"verdict": "no-gap", "reason": "it is the noise", "effects": []}
    gap |= {"withdrawn": None, "asked": None}
    assert verdict_text(gap) == "**There is no gap: it is the noise.**\n"


def test_sentences_of_several_stand_in_one_table(tmp_path):
    write_table(
        "sentences", [GAP, GAP | {"dataset": "other"}], tmp_path / "sentences.csv"
    )
    with (tmp_path / "sentences.csv").open(newline="") as stream:
        rows = list(csv.reader(stream))
    sentence = "The simulator lacks resonance and creep."
    assert rows[1:] == [["bench", sentence], ["other", sentence]]


def test_pictures_of_another_are_not_written_over(tmp_path):
    (write_folder(tmp_path) / "model.png").write_bytes(b"mine")
    with pytest.raises(InputError, match=r"model\.png: not written by hystbench"):
        write_gallery(tmp_path)
    assert (tmp_path / "model.png").read_bytes() == b"mine"


def test_tables_that_are_missing_are_one_line(tmp_path):
    with pytest.raises(InputError, match="no tables"):
        write_gallery(write_folder(tmp_path, with_tables=False))


def test_numbers_of_what_has_effects_inside_stand_beside_those_without(tmp_path):
    chain = [
        {"mechanism": {"mass": 2.0, "damping": 3.0, "stiffness": 0.0, "bias": 0.5}},
        {"friction-force": {"coulomb": 20.0, "presliding_distance": 1e-5}},
    ]
    channels = {"input": ("force", "N"), "output": ("position", "m")}
    about = {key: {"name": x, "unit": unit} for key, (x, unit) in channels.items()}
    model = Model.from_mapping({"name": "drive", **about, "chain": chain}, "drive")
    known = {"mechanism.mass": 4.0, "mechanism.damping": 9.0}
    after = {"mechanism.mass": 2.0, "mechanism.damping": 3.0}
    told = {
        "base_parameters": {
            k: {"before": x, "after": after[k]} for k, x in known.items()
        }
    }
    write_host(model, told, tmp_path / "host.csv")
    assert (tmp_path / "host.csv").read_text().splitlines() == [
        "block,parameter,fitted,without the effects,unit",
        "mechanism,mass,2,4,N s^2/m",
        "mechanism,damping,3,9,N s/m",
    ]


def test_seconds_of_the_jobs_of_a_device_are_added_up(tmp_path):
    tables = [tmp_path / f"{k}.csv" for k in range(3)]
    for table, name in zip(tables, ("one", "other", "one"), strict=True):
        write_took(name, table)
    took = [float(table.read_text().splitlines()[1].split(",")[1]) for table in tables]
    assert min(took) > 0.0
    write_seconds(tables, tmp_path / "seconds.csv")
    head, one, other = (tmp_path / "seconds.csv").read_text().splitlines()
    assert head == "dataset,cpu_seconds"
    assert one == f"one,{round(took[0] + took[2], 1)}"
    assert other == f"other,{took[1]}"

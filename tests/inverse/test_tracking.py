"""Tracking on the twin with inputs from several models."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from hystbench.inverse.told import left, table, verdict
from hystbench.inverse.tracking import (
    CODE,
    DRIVES,
    LINEAR,
    OWN,
    STROKE_SHARE,
    WITH,
    WITHOUT,
    Line,
    Reference,
    Tracked,
    by_inverse,
    by_line,
    references,
    track,
)
from hystbench.model import load_model
from hystbench.signals import Signal, highest_hz
from tests.blocks.examples import EXAMPLES
from tests.conftest import ROOT, run_hystbench
from tests.export.test_steps import chain_of, model_of

DT = 1e-4
TIME = np.arange(2000) * DT
TWIN = ROOT / "src" / "hystbench" / "plants" / "gma.yaml"


def signal(frequency):
    u = 0.632 * np.sin(2 * np.pi * frequency * TIME)
    return Signal(f"sine-{frequency:03d}hz", DT, u, "A")


def without_dynamics():
    """Give the twin's hysteresis alone: what a slow loop shows of it."""
    mapping = load_model(TWIN).to_mapping()
    mapping["chain"] = [item for item in mapping["chain"] if "gpi" in item]
    mapping.pop("provenance")
    return type(load_model(TWIN)).from_mapping(mapping, "here")


@pytest.fixture(scope="module")
def rows():
    plant, slow = load_model(TWIN), without_dynamics()
    line = Line.of(slow, signal(10))
    rest = plant.simulate(np.zeros(20), DT)[-1]
    wanted = references([signal(80)], {"sine-080hz": 80}, line, rest)
    ways = {
        LINEAR: by_line(line),
        WITHOUT: by_inverse(slow),
        WITH: by_inverse(plant),
        CODE: by_inverse(plant),
        OWN: by_inverse(plant),
    }
    return track(plant, 0.0, ways, wanted)


def test_each_inverse_is_better_than_the_one_that_knows_less(rows):
    for name in {row.reference.name for row in rows}:
        errors = {row.drive: row.rms for row in rows if row.reference.name == name}
        assert errors[OWN] < 0.005 < errors[WITHOUT] < errors[LINEAR]
        assert errors[WITH] == errors[OWN]


def test_references_begin_at_rest_and_have_the_share_of_the_stroke(rows):
    line = Line.of(without_dynamics(), signal(10))
    for row in rows:
        assert row.reference.y[0] == pytest.approx(rows[0].reference.y[0])
        assert row.stroke == pytest.approx(
            STROKE_SHARE * line.gain * 2 * 0.632, rel=0.01
        )


def test_a_zero_error_of_the_records_reaches_the_plant():
    plant = load_model(TWIN)
    line = Line.of(without_dynamics(), signal(10))
    wanted = [Reference("slow", 10.0, DT, 5 * np.sin(2 * np.pi * 10 * TIME))]
    ways = {WITH: by_inverse(plant), OWN: by_inverse(plant)}
    errors = {row.drive: row.rms for row in track(plant, -0.01, ways, wanted)}
    assert errors[OWN] < 0.005
    # About 0.01 A times the gain, of a stroke of 10 um.
    assert errors[WITH] == pytest.approx(0.01 * line.gain / 10, rel=0.5)


def made_up(name, hz, errors):
    y = np.sin(np.linspace(0, 20 * np.pi, 4001))
    reference = Reference(name, hz, DT, y)
    return [
        Tracked(reference, drive, y, y + 2 * error)
        for drive, error in zip(DRIVES, errors, strict=True)
    ]


def test_the_verdict_tells_what_misses_the_goal_and_what_gets_worse():
    rows = [
        *made_up("slow", 10, (0.08, 0.01, 0.05, 0.015, 0.016, 0.001)),
        *made_up("fast", 60, (0.2, 0.1, 0.07, 0.03, 0.03, 0.001)),
        *made_up("beyond", 200, (0.3, 0.3, 0.3, 0.3, 0.3, 0.001)),
    ]
    told = verdict(rows)
    assert "8.00 to 20.00 with a linear gain" in told
    assert "5.00 to 7.00 with that of the rate-dependent Prandtl-Ishlinskii" in told
    assert "1.50 to 3.00 with the gap's effects" in told
    assert "met on 1 of 2 references, and missed on fast (3.00 %)" in told
    assert "worse on slow (1.50 instead of 1.00 %)" in told
    assert "beyond" not in told
    assert "| beyond | 2.0 | 30.00 (30.0) |" in table(rows, "um")


def test_what_an_inverse_leaves_on_its_own_model_is_told_apart():
    """Of a gain of two, half the reference is the input: nothing is left to 100 Hz."""
    doubles = model_of("doubles", chain_of(("gain", {"value": 2.0})))
    slow, beyond = (made_up(*given, [0.0] * len(DRIVES)) for given in (
        ("slow", 10), ("beyond", 200),
    ))  # fmt: skip
    halved = [replace(row, u=0.5 * row.reference.y) for row in slow]
    assert "leaves 0.00 to 0.00 % on" in left([*halved, *beyond], doubles)
    # With the reference itself the model goes twice as far as it should.
    told = left(slow, doubles)
    rms = 100 * np.sqrt(np.mean(slow[0].reference.y ** 2)) / 2
    assert f"leaves {rms:.2f} to {rms:.2f} % on" in told


@pytest.mark.parametrize(
    ("definition", "wanted"),
    [
        ({"sine": {"frequency_hz": 40}}, 40.0),
        ({"chirp": {"from_hz": 1, "to_hz": 100}}, 100.0),
        ({"sum-of-sines": {"frequencies_hz": [5, 30], "amplitudes": [1, 1]}}, 30.0),
        (
            {
                "random-sum-of-sines": {
                    "band": [0.0, 0.02],
                    "level": 1.0,
                    "sines": 3,
                    "trials": 1,
                    "seed": 1,
                }
            },
            100.0,
        ),
    ],
)
def test_the_highest_frequency_is_in_the_definition(definition, wanted):
    common = {
        "duration_s": 1.0,
        "sampling_frequency_hz": 10000,
        "amplitude": 1.0,
        "gain": 1.0,
    }
    assert highest_hz("any", definition, common) == wanted


def test_the_command_writes_table_verdict_and_figure(tmp_path):
    slow, fast = tmp_path / "slow.npz", tmp_path / "sine-040hz.npz"
    signal(10).save(slow)
    signal(40).save(fast)
    without_dynamics().save(tmp_path / "base.yaml")
    out = tmp_path / "inverse"
    settings = '{"input_zero_error": 0.0, "highest_hz": {"sine-040hz": 40}}'
    numbers = EXAMPLES["rdgpi"] | {"order": 5.0}
    (tmp_path / "rdgpi.json").write_text(json.dumps({"parameters": numbers}))
    given = ("--slow", slow, "--plant", TWIN, "--base", tmp_path / "base.yaml")
    given += ("--rate-dependent", tmp_path / "rdgpi.json")
    done = run_hystbench(
        "job", "tracking", fast, *given, "--augmented", TWIN, "--settings", settings,
        "--out", out,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (out / "tracking.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert {row["drive"] for row in rows} == set(DRIVES)
    assert {row["reference"] for row in rows} == {
        "sine-040hz", "raster-5-lines-a-second", "raster-20-lines-a-second",
    }  # fmt: skip
    header, *shown = (out / "raster.csv").read_text().splitlines()
    assert header.split(",") == ["time_s", "reference", *DRIVES]
    assert len(shown) == 1000  # what there is behind the middle
    assert "3 references to 100 Hz" in (out / "verdict.md").read_text()

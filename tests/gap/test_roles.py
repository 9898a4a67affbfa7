"""Hold-out records decide nothing, and the generator is out of sight."""

import ast
import json
import os
import subprocess
import sys
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from hystbench.challenge.case import make_case
from hystbench.challenge.make import write_folder
from hystbench.challenge.spec import CaseSpec
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.thresholds import MOST
from hystbench.model import load_model
from hystbench.written import ENTRIES
from tests.gap.closing import close_gap
from tests.gap.searched import among

READ_LAST = (
    *("gap", "records", "ladder", "black_box", "shortfall", "reason", "warnings"),
)
"""Keys of gap.json that the hold-out records fill; their figure leads the reason."""


def short(item):
    """Keep a quarter of a record, to save time."""
    end = len(item) // 4
    u, y = item.u[:end].copy(), item.y[:end].copy()
    return replace(item, u=u, y=y, period_samples=None)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A case of records of several rates, as files."""
    there = tmp_path_factory.mktemp("roles")
    case = make_case(CaseSpec(1, "single", ("creep",), "gpi", 20.0))
    case = replace(case, records=tuple(map(short, case.records)))
    write_folder(case, there / "case")
    return there


def closed(folder, evidence, out):
    base = load_model(folder / "case" / "model.yaml")
    slow = among("creep", "drive-lag", "sensor-lag", "thermal-drift", "drift")
    close_gap(evidence, base, folder / out, report=False, vocabulary=slow)
    content = json.loads((folder / out / "gap.json").read_text())
    files = {
        str(item.relative_to(folder / out))
        for item in (folder / out).rglob("*")
        if item.is_file() and ENTRIES not in item.parts
    }
    return content, (folder / out / "model.yaml").read_bytes(), files


@pytest.fixture(scope="module")
def told(folder):
    return closed(folder, load_evidence(folder / "case" / "dataset"), "told")


@pytest.fixture(scope="module")
def spoilt(folder):
    """The same, the outputs of the hold-out files replaced by noise."""
    rng = np.random.default_rng(0)
    evidence = load_evidence(folder / "case" / "dataset")
    for record in evidence.hold_out:
        file = folder / "case" / "dataset" / f"{record.name}.csv"
        header, *rows = file.read_text().splitlines()
        noise = 30 * rng.standard_normal(len(rows))
        rows = [
            f"{row.rpartition(',')[0]},{value:.3f}"
            for row, value in zip(rows, noise, strict=True)
        ]
        file.write_text("\n".join([header, *rows]) + "\n")
    return closed(folder, load_evidence(folder / "case" / "dataset"), "spoilt")


def with_confidence_of(content, other):
    """Give the effects the confidence that they have in another answer.

    A law that the hold-out records do not bear out is no surer than even.
    """
    pairs = zip(content["effects"], other["effects"], strict=True)
    return content | {
        "effects": [now | {"confidence": was["confidence"]} for now, was in pairs]
    }


def test_noise_for_hold_out_outputs_changes_nothing_that_is_decided(told, spoilt):
    (content, model, _), (other, other_model, _) = told, spoilt
    decided, again = (
        {key: value for key, value in item.items() if key not in READ_LAST}
        for item in (content, with_confidence_of(other, content))
    )
    assert decided == again
    assert all(item["confidence"] <= MOST for item in other["effects"])
    assert {"verdict", "effects", "where", "ranking", "next_experiment"} <= set(decided)
    assert len({item["reason"].partition("; ")[2] for item in (content, other)}) == 1
    assert content["verdict"] == "named"
    assert content["effects"][0]["parameters"]
    assert model == other_model
    # What the hold-out records do show is another thing: they were read.
    assert content["gap"]["after"] < content["gap"]["before"]
    assert other["gap"]["before"] > 10 * content["gap"]["before"]


def test_records_of_several_rates_are_used_together(folder, told):
    evidence = load_evidence(folder / "case" / "dataset")
    assert len({record.dt for record in (*evidence.fit, *evidence.hold_out)}) > 2
    assert [item["name"] for item in told[0]["effects"]] == ["creep"]


def test_files_are_whole_and_the_hold_out_tables_say_before_and_after(folder, told):
    names = {record.name for record in load_evidence(folder / "case/dataset").hold_out}
    tables = {f"holdout/{name}.csv" for name in names}
    assert told[2] == {"gap.json", "model.yaml", "curves.json", *tables}
    for name in tables:
        header = (folder / "told" / name).read_text().splitlines()[0]
        assert header == "time_s,measured,before,after"
    augmented = load_model(folder / "told" / "model.yaml")
    table = np.loadtxt(folder / "told/holdout/chirp.csv", delimiter=",", skiprows=1)
    given = np.loadtxt(
        folder / "case/dataset/chirp.csv", delimiter=",", skiprows=1, usecols=1
    )
    after = augmented.simulate(given, table[1, 0])  # the file alone says it all
    assert table[:, 3] == pytest.approx(after, abs=1e-6)


def modules_of(folder):
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from (item.name for item in node.names)
            elif isinstance(node, ast.ImportFrom):
                yield node.module or ""
                yield from (f"{node.module}.{item.name}" for item in node.names)


def test_no_module_of_the_gap_imports_the_generator_at_any_depth(root):
    found = set(modules_of(root / "src" / "hystbench" / "gap"))
    assert "hystbench.gap.simulation.simulation" in found
    assert not [item for item in found if item.startswith("hystbench.challenge")]


def test_the_contract_keeps_the_gap_from_the_generator(root):
    """tests/challenge/test_writing.py breaks it and sees it fail."""
    tool = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["importlinter"]
    (wall,) = [
        item
        for item in tool["contracts"]
        if "hystbench.challenge" in item.get("protected_modules", ())
    ]
    assert wall["type"] == "protected"
    allowed = wall["allowed_importers"]
    assert allowed
    assert all(name.startswith("hystbench.commands.") for name in allowed)
    assert not any("gap" in name for name in allowed)


def test_a_run_of_the_gap_does_not_load_the_generator(root):
    code = (
        "import sys, hystbench.gap.run, hystbench.gap.effects as e; e.effects();"
        "print([m for m in sys.modules if m.startswith('hystbench.challenge')])"
    )
    found = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(root / "src")},
    )
    assert found.stdout.strip() == "[]"

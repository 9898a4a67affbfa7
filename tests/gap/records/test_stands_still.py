"""A record whose output stands still says where a dead zone ends."""

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.errors import InputError
from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.inside.one_coordinate import masses
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.run import closed_gap
from hystbench.inspection.check import check
from tests.gap.made import record
from tests.messages import message

DT, COUNT, SUBSTEPS = 0.01, 600, 10
ZONE_V, TAU_S, GAIN, NOISE = 0.25, 0.15, 4.0, 1e-3
RECORDS = {
    "one": (1.0, "fit"),
    "two": (0.7, "fit"),
    "low": (0.2, "fit"),
    "held": (0.9, "hold-out"),
    "still": (0.2, "hold-out"),
}
"""Of each the largest voltage, and its use."""


def motor(u):
    """Give the angle of a motor that stands below a voltage, by Euler's steps."""
    driven = np.sign(u) * np.maximum(np.abs(u) - ZONE_V, 0.0)
    speed = angle = 0.0
    found = []
    for value in driven.tolist():
        found.append(angle)
        for _ in range(SUBSTEPS):
            speed += DT / SUBSTEPS * (GAIN * value - speed) / TAU_S
            angle += DT / SUBSTEPS * speed
    return np.array(found)


def write_motor(folder, said=", stands_still: [output]", names=tuple(RECORDS)):
    """Write records of it; of those below its dead zone it is said that it stands."""
    lines = []
    for seed, (name, (size, use)) in enumerate(RECORDS.items()):
        if name not in names:
            continue
        random = np.random.default_rng(seed)
        u = size * np.repeat(random.uniform(-1, 1, COUNT // 30), 30)
        y = motor(u)
        stands = not y.any()
        if not stands:
            y += NOISE * random.standard_normal(COUNT)
        table = np.column_stack([DT * np.arange(COUNT), u, y])
        header = "time_s,voltage_V,angle_rad"
        file = folder / f"{name}.csv"
        np.savetxt(file, table, "%.9g", ",", header=header, comments="")
        lines.append(f"  - {{file: {name}.csv, use: {use}{said * stands}}}\n")
    (folder / "dataset.yaml").write_text(
        "name: motor\n"
        "time: {column: time_s, unit: s}\n"
        "input: {column: voltage_V, unit: V, hold: zero-order}\n"
        "output: {column: angle_rad, unit: rad}\n"
        f"records:\n{''.join(lines)}"
    )
    return folder / "dataset.yaml"


def test_a_search_runs_with_a_record_below_the_dead_zone(tmp_path):
    evidence = load_evidence(write_motor(tmp_path))
    base, _ = load_base("linear", evidence)
    content = closed_gap(evidence, base, Asked()).outcome.content
    assert content["verdict"] == "named"
    assert [item["name"] for item in content["effects"]] == ["dead-zone"]
    assert content["gap"]["after"] < 1.5 * NOISE


def test_a_mass_is_begun_beside_it_as_without_it():
    """It counts as the quietest record does, and not by the inverse of nothing."""
    random = np.random.default_rng(1)
    u = [size * np.repeat(random.uniform(-1, 1, 20), 30) for size in (1.0, 0.2)]
    made = tuple(record(x, motor(x), dt=DT) for x in u)
    assert not made[1].y.any()

    def first(records):
        state = next(masses(records, ("position",), "zero-order"))
        return state.chain[0].mass

    assert first(made) == pytest.approx(first(made[:1]), rel=0.5)


@pytest.mark.parametrize("model", ["", "linear"])
def test_a_check_runs_with_such_a_record(tmp_path, model):
    found = check(load_dataset(write_motor(tmp_path)), model=model)
    assert [item.high for item in found.facts if item.name == "low"] == [0.0]
    assert not [item for item in found.findings if item.kind in ("wrong", "record")]


def test_that_it_stands_is_to_be_said(tmp_path):
    dataset = load_dataset(write_motor(tmp_path, said=""))
    said = message(lambda: dataset.read("low"))
    for part in ("low.csv", "record low", "'angle_rad'", "'stands_still: [output]'"):
        assert part in said
    assert "of a step" not in said


def test_it_tells_nothing_without_a_record_in_which_it_moves(tmp_path):
    dataset = load_dataset(write_motor(tmp_path, names=("low", "held")))
    with pytest.raises(InputError, match="another record with 'use: fit' whose output"):
        dataset.read("low")


def test_the_record_to_identify_from_is_one_in_which_it_moves(tmp_path):
    """The record of the least rate may stand still."""
    dataset = load_dataset(write_motor(tmp_path))
    file = tmp_path / "low.csv"
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    rows[:, 1] = np.linspace(0.1, 0.11, COUNT)
    header = "time_s,voltage_V,angle_rad"
    np.savetxt(file, rows, "%.9g", ",", header=header, comments="")
    assert dataset.identification in ("one", "two")
    assert load_evidence(tmp_path).to_identify_from.name.startswith(("one", "two"))

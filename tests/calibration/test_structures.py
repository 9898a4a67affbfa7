"""Structures that were tried: what each makes, and the one rule over them."""

import csv

import pytest

from hystbench.calibration.structures import (
    STRUCTURES,
    find_structure,
    write_structures,
)
from hystbench.calibration.twin import UNKNOWNS
from hystbench.errors import InputError
from hystbench.published import FILTERS

START = {item.name: item.start for item in UNKNOWNS}


def blocks(name):
    structure = find_structure(name)
    values = START | {item.name: item.start for item in structure.more}
    free = {item.name: values[item.name] for item in structure.unknowns}
    return [block.name for block in structure.make(free).chain]


@pytest.mark.parametrize("name", [item.name for item in STRUCTURES])
def test_each_structure_makes_a_twin_of_what_is_free(name):
    assert "gpi" in blocks(name)


def test_diffusion_stands_where_the_lag_was():
    assert blocks("eddy-diffusion") == [
        "eddy-diffusion" if block == "transfer-function" else block
        for block in blocks("chosen")
    ]


def test_creep_is_mechanical_and_the_bias_comes_first():
    assert blocks("creep")[-3:] == ["creep", "calibration-error", "sensor-noise"]
    assert blocks("bias") == ["gain", *blocks("chosen")]


def test_an_unknown_structure_gets_the_nearest_name():
    with pytest.raises(InputError, match="creep"):
        find_structure("crep")


def test_the_table_has_the_least_score_first(tmp_path):
    ratios = dict.fromkeys(FILTERS, 0.5)  # beyond a factor of 2
    one = {"signal": "sine-010hz", "log10_ratio": ratios, "rms_error": -0.02}
    tried = [
        {"name": name, "meaning": "", "cost": 1, "score": score, "left_out": [one]}
        for name, score in (("worse", 3.0), ("better", 2.0))
    ]
    write_structures(tmp_path / "tried.csv", tried)
    with (tmp_path / "tried.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["structure"] for row in rows] == ["better", "worse"]
    assert float(rows[0]["left_out_worst_factor"]) == pytest.approx(10**0.5, abs=0.01)
    assert float(rows[0]["left_out_within_factor_2"]) == 0
    assert float(rows[0]["left_out_rms_percent"]) == 2

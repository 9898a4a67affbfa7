"""What could explain errors that stay far off: one thing changed at a time."""

import numpy as np
import pytest
import yaml

from hystbench.settings import read_settings
from hystbench.twins.hypotheses import (
    CHIRP,
    FAST,
    VOLTERRA_FACTORS,
    chirp_rows,
    volterra_rows,
)
from hystbench.twins.read import read_twins
from hystbench.twins.runs import draw_signals, measure_twin
from tests.conftest import SCHEMA, own_config, shorten

from .conftest import TWIN


@pytest.fixture(scope="module")
def job():
    config = own_config()
    config["signals"] = [CHIRP, *FAST]
    shorten(config, 0.2)
    config["excitations"][CHIRP]["chirp"]["duration_s"] = 0.2
    config["filters"]["order"] = 6
    return read_settings(config, SCHEMA).hypotheses_job


@pytest.fixture
def twin(tmp_path):
    content = yaml.safe_load(yaml.safe_dump(TWIN))
    mode = {"frequency_hz": 65.0, "damping_ratio": 0.05, "participation": -0.05}
    content["chain"].insert(2, {"resonance": mode})
    path = tmp_path / "small.yaml"
    path.write_text(yaml.safe_dump(content))
    return read_twins([path])[0]


def test_a_row_of_the_chirp_has_one_thing_changed(twin, job):
    rows = dict(chirp_rows(twin, job))
    usual = rows["nothing"]
    assert set(usual) == {"gpo", "backlash", "volterra", "delayed"}
    assert all(mse != usual for name, mse in rows.items() if name != "nothing")
    both = [rows[f"{sign}0.5 um on the displacement"]["gpo"] for sign in "+-"]
    assert both[0] != both[1]


def test_the_start_up_and_the_rest_make_the_whole(twin, job):
    rows = {(told, part): mse for told, part, mse in volterra_rows(twin, job)}
    assert len(rows) == 2 * len(VOLTERRA_FACTORS)
    named = {name: job["signals"][name] for name in FAST}
    records = measure_twin(twin, draw_signals(named, 0).values(), job["measure"], 0)
    whole = rows["step sizes times 1", "whole record"]
    late = rows["step sizes times 1", "after 0.1 s"]
    for name, record in records.items():
        # The squared error of the first 0.1 s cannot be negative.
        assert whole[name] * len(record) >= late[name] * (len(record) - 1000)
        assert np.isfinite(late[name])

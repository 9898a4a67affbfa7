"""Rivals answer in the format of the contest; who knows what."""

import grimp
import numpy as np
import pytest

from hystbench.challenge.case import make_case
from hystbench.challenge.make import write_folder
from hystbench.challenge.spec import CaseSpec
from hystbench.entrants.rivals import RIVALS, naive
from hystbench.entrants.rivals.base import Answer, read, write
from hystbench.files import read_json
from hystbench.gap.schema import SCHEMA
from hystbench.plain_fits import Task, effects, fit
from hystbench.schema import check_against_schema

LEFT_OUT = {"group": 2}
"""A case does not change with the group that the next score leaves out."""
SPEC = CaseSpec(150_001, "single", ("thermal-drift",), "gpi", 20.0, **LEFT_OUT)


@pytest.fixture(scope="module")
def case():
    return make_case(SPEC)


@pytest.fixture(scope="module")
def folder(case, tmp_path_factory):
    place = tmp_path_factory.mktemp("case")
    write_folder(case, place)
    return place


def solved(name, folder, out):
    given = read(folder / "dataset", folder / "model.yaml")
    write(given, RIVALS[name]().answer(given), out)
    gap = read_json(out / "gap.json")
    check_against_schema(gap, SCHEMA, "gap.json")
    return gap


@pytest.fixture
def few_effects(monkeypatch):
    """Fit a handful of effects alone: all of them take a minute."""
    few = ("thermal-drift", "drive-lag", "saturation", "calibration-error", "drift")
    assert set(few) < set(effects())
    monkeypatch.setattr(naive, "effects", lambda: few)


@pytest.mark.usefixtures("few_effects")
def test_the_naive_ranker_names_a_strong_effect(folder, tmp_path):
    gap = solved("naive", folder, tmp_path)
    assert gap["verdict"] == "named"
    assert gap["effects"][0]["name"] == "thermal-drift"
    assert gap["gap"]["after"] < 0.5 * gap["gap"]["before"]


@pytest.mark.usefixtures("few_effects")
def test_the_naive_ranker_goes_on_with_what_is_left(tmp_path):
    hidden = ("drive-lag", "drift")
    spec = CaseSpec(150_005, "pair", hidden, "gpi", 20.0, **LEFT_OUT)
    write_folder(make_case(spec), tmp_path)
    gap = solved("naive", tmp_path, tmp_path / "out")
    names = [item["name"] for item in gap["effects"]]
    assert set(hidden) <= set(names)
    assert len(set(names)) == len(names) <= naive.MOST_EFFECTS
    # the drift of a record that was not fitted is not known: what the lag did is gone
    assert gap["gap"]["after"] < gap["gap"]["before"]


def test_what_an_effect_explains_is_taken_off(folder):
    given = read(folder / "dataset", folder / "model.yaml")
    task = Task(given.model, given.fit)
    for name in ("calibration-error", "drift", "hysteresis-shape"):
        found = fit(task, name)
        left = naive.without(task, found)
        error = found.output - task.measured
        np.testing.assert_allclose(left.base - left.measured, error, atol=1e-9)
        assert found.mean_square == pytest.approx(np.mean(error**2))
        assert task.records[0].y is not left.records[0].y


def test_the_random_namer_says_the_same_each_time(folder, tmp_path):
    first = solved("random", folder, tmp_path / "a")
    assert solved("random", folder, tmp_path / "b") == first
    assert first["gap"]["after"] == first["gap"]["before"]


@pytest.mark.parametrize("beyond", [np.nan, np.inf, 1e200])
def test_a_rival_that_runs_away_has_closed_nothing(folder, tmp_path, beyond):
    given = read(folder / "dataset", folder / "model.yaml")

    def predict(record):
        return np.where(record.time > 0.1, beyond, 0.0)

    write(given, Answer(predict), tmp_path)
    gap = read_json(tmp_path / "gap.json")
    check_against_schema(gap, SCHEMA, "gap.json")
    assert (gap["gap"]["after"], gap["gap"]["explained"]) == (None, 0.0)


def test_no_rival_knows_the_plant_the_truth_or_the_solver():
    graph = grimp.build_graph(
        "hystbench", cache_dir=None, exclude_type_checking_imports=True
    )
    for command in ("rival", "jobs.blind_solve"):
        known = graph.find_upstream_modules(f"hystbench.commands.{command}")
        assert not [
            m for m in known if m.startswith(("hystbench.challenge", "hystbench.gap"))
        ]
    for module in graph.find_descendants("hystbench.entrants"):
        known = graph.find_upstream_modules(module)
        assert not [
            m for m in known if m.startswith(("hystbench.challenge", "hystbench.gap"))
        ]

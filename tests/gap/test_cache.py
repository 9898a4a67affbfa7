"""What a search computed is looked up by the next one, and nothing else is."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

from hystbench.blocks import registry
from hystbench.gap import cache as module
from hystbench.gap.bases.load import load_base
from hystbench.gap.cache import Remembered, remembered, remembering
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.serialize import remembered_of
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.evidence import load_evidence
from hystbench.model import load_model
from tests.gap.tiny import write_tiny

FEW = ("creep", "drive-lag", "sensor-lag", "saturation")


def silent(line):
    raise AssertionError(line)


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    data, base = write_tiny(tmp_path_factory.mktemp("tiny"))
    return load_evidence(data), load_model(base)


def searched(given, store, offered=FEW):
    """Rank some effects; give what each did, as text."""
    evidence, base = given
    with remembering(store):
        state, floor = start_state(
            evidence.fit, base, evidence.input_hold, evidence.noise_rms, offered
        )
        ranking = rank(state, make_score(state, floor))
    return [
        (x.effect, x.form, x.score, x.gain, x.gain_on_folds, x.state and x.state.chain)
        for x in ranking
    ]


@pytest.fixture(scope="module")
def full(given, tmp_path_factory):
    """A folder with the results of a search, and what the search gave."""
    folder = tmp_path_factory.mktemp("searches")
    return folder, searched(given, Remembered(folder, silent))


def test_another_search_computes_nothing_and_gives_the_same(given, full):
    folder, found = full
    again = Remembered(folder, silent)
    assert searched(given, again) == found
    assert (again.made, again.found > 0) == (0, True)
    assert searched(given, None) == found


def test_without_an_effect_the_others_are_looked_up(given, full):
    folder, _ = full
    store = Remembered(folder, silent)
    ranking = searched(given, store, tuple(x for x in FEW if x != "drive-lag"))
    assert "drive-lag" not in {row[0] for row in ranking}
    assert store.found >= len(FEW) - 1


def test_other_records_are_searched_anew(given, full):
    folder, _ = full
    evidence, base = given
    first, *rest = evidence.fit
    u = first.u.copy()
    u[0] += 1e-9  # a search on every second sample reads it too
    store = Remembered(folder, silent)
    searched((replace(evidence, fit=(replace(first, u=u), *rest)), base), store)
    assert store.found == 0


def test_another_hystbench_searches_anew(given, full, monkeypatch):
    folder, _ = full
    monkeypatch.setattr(module, "code_digest", lambda: "another")
    store = Remembered(folder, silent)
    searched(given, store, FEW[:1])
    assert store.found == 0


def test_an_identified_base_is_looked_up(given, tmp_path, monkeypatch):
    evidence, _ = given
    with remembering(Remembered(tmp_path, silent)):
        first = load_base("gpi", evidence)
    monkeypatch.setattr("hystbench.gap.bases.load.identified_gpi", None)
    with remembering(Remembered(tmp_path, silent)):
        assert load_base("gpi", evidence) == first


def one(store, key, value):
    with remembering(store):
        return remembered(lambda: [key], lambda: value, lambda x: x, lambda x: x)


def test_a_file_that_cannot_be_read_is_replaced(tmp_path):
    one(Remembered(tmp_path, silent), "a", 1)
    (file,) = tmp_path.glob("*.json")
    file.write_text("{")
    assert one(Remembered(tmp_path, silent), "a", 2) == 2
    assert json.loads(file.read_text()) == [2]


def test_the_folder_stays_within_its_bound(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "BOUND", 500)
    for k in range(10):
        one(Remembered(tmp_path, silent), str(k), "x" * 100)
    sizes = [file.stat().st_size for file in tmp_path.glob("*.json")]
    assert sum(sizes) <= 500
    assert one(Remembered(tmp_path, silent), "9", "new") == "x" * 100


def test_where_nothing_can_be_written_it_is_said_once(tmp_path):
    (tmp_path / "file").write_text("")
    said = []
    store = Remembered(tmp_path / "file" / "folder", said.append)
    assert [one(store, "a", 1), one(store, "b", 2)] == [1, 2]
    (line,) = said
    assert "results are not kept" in line


SIMULATORS = {
    "external": {"function": "rig:run"},
    "command": {"command": "./rig"},
    "fmu": {"file": "rig.fmu"},
    "onnx": {"file": "rig.onnx"},
}


@pytest.mark.parametrize("kind", SIMULATORS)
def test_what_a_strangers_simulator_gives_is_never_looked_up(kind, tmp_path):
    """Its file may hold something else the next time; its name is all that is known."""
    block = registry()[kind].from_mapping(SIMULATORS[kind])
    store, made = Remembered(tmp_path, silent), []
    with remembering(store):
        for n in range(2):
            given = remembered_of(
                SimpleNamespace(chain=(block,)),
                lambda: ["word"],
                lambda n=n: made.append(n) or n,
            )
            assert given == n
    assert made == [0, 1]

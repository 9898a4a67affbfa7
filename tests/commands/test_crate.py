"""Results are packed for an archive: a crate lists what it holds, and no more."""

import json
import sys

import pytest

from hystbench import cli
from hystbench.files import write_json, write_text
from tests.conftest import ROOT

PROFILE = "https://w3id.org/workflowhub/workflow-ro-crate/1.0"


@pytest.fixture
def results(tmp_path):
    """Two files of hystbench's, one of somebody's, and one that somebody changed."""
    folder = tmp_path / "results"
    write_json(folder / "gap" / "device" / "gap.json", {"verdict": "named"})
    write_text(folder / "summary.csv", "model,mse\ngpo,0.1\n")
    write_text(folder / "changed.csv", "model,mse\ngpo,0.1\n")
    (folder / "changed.csv").write_text("model,mse\ngpo,0.0\n")
    (folder / "own notes.txt").write_text("mine")
    return folder


@pytest.fixture
def pack(results, monkeypatch, capsys):
    def run(out):
        own = ("--config", str(ROOT / "config.yaml"), "--project", str(ROOT))
        words = ["hystbench", "crate", str(results), "--out", str(out), *own]
        monkeypatch.setattr(sys, "argv", words)
        return cli.run(), capsys.readouterr()

    return run


def files_in(folder):
    return {str(x.relative_to(folder)) for x in folder.rglob("*") if x.is_file()}


def is_file(entity):
    return "File" in entity["@type"]


def with_rocrate():
    pytest.importorskip("rocrate", reason="rocrate is not installed")


def test_the_crate_lists_what_it_holds(pack, tmp_path):
    with_rocrate()
    out = tmp_path / "crate"
    status, said = pack(out)
    assert status == 0
    assert said.out.endswith("; 2 that hystbench did not write stay out\n")
    content = json.loads((out / "ro-crate-metadata.json").read_text())
    entities = {each["@id"]: each for each in content["@graph"]}
    files = {name for name, each in entities.items() if is_file(each)}
    assert files_in(out) == {*files, "ro-crate-metadata.json"}
    made = {"results/gap/device/gap.json", "results/summary.csv"}
    assert {name for name in files if name.startswith("results/")} == made
    listed = {each["@id"] for each in entities["./"]["hasPart"]}
    assert listed == files
    for name in files - {"workflow/Snakefile"}:
        assert int(entities[name]["contentSize"]) == (out / name).stat().st_size
    for name in ("config.yaml", "CITATION.cff", "workflow/Snakefile"):
        assert (out / name).read_bytes() == (ROOT / name).read_bytes()
    (run,) = (x for x in content["@graph"] if x["@type"] == "CreateAction")
    assert {each["@id"] for each in run["result"]} == made
    # nothing can tell that the results were made with them
    assert entities["config.yaml"]["name"] == "Settings as given"


def test_it_is_a_crate_of_a_workflow(pack, tmp_path):
    """As the profile asks: https://about.workflowhub.eu/Workflow-RO-Crate."""
    with_rocrate()
    out = tmp_path / "crate"
    pack(out)
    content = json.loads((out / "ro-crate-metadata.json").read_text())
    entities = {each["@id"]: each for each in content["@graph"]}
    descriptor, root = entities["ro-crate-metadata.json"], entities["./"]
    assert descriptor["about"] == {"@id": "./"}
    conforms = {each["@id"] for each in descriptor["conformsTo"]}
    assert conforms == {"https://w3id.org/ro/crate/1.1", PROFILE}
    assert root["@type"] == "Dataset"
    assert {"name", "description", "datePublished"} < set(root)
    assert root["license"] == {"@id": "https://spdx.org/licenses/MIT"}
    (author,) = root["author"]
    assert entities[author["@id"]]["name"] == "The hystbench developers"
    workflow = entities[root["mainEntity"]["@id"]]
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow"} <= {
        *workflow["@type"]
    }
    language = entities[workflow["programmingLanguage"]["@id"]]
    assert language["name"] == "Snakemake"
    versions = {
        entities[each["@id"]]["name"]: entities[each["@id"]]["version"]
        for each in workflow["softwareRequirements"]
    }
    assert versions["Python"] == sys.version.split()[0]
    assert {"hystbench", "numpy", "scipy", "snakemake"} < set(versions)


def test_nothing_is_written_over(pack, tmp_path):
    with_rocrate()
    out = tmp_path / "crate"
    out.mkdir()
    (out / "mine").write_text("mine")
    status, said = pack(out)
    assert status == 2
    told = f"hystbench: {out}: there already; expected the name of a new folder\n"
    assert said.err == told
    assert files_in(out) == {"mine"}


def test_without_the_library_one_line_says_what_to_install(pack, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rocrate", None)
    monkeypatch.delitem(sys.modules, "rocrate.rocrate", raising=False)
    status, said = pack(tmp_path / "crate")
    assert status == 2
    (line,) = said.err.splitlines()
    assert "pip install 'hystbench[crate]'" in line
    assert not (tmp_path / "crate").exists()


def test_a_folder_without_results_is_refused(pack, results, tmp_path):
    with_rocrate()
    for name in ("gap/device/gap.json", "summary.csv"):
        (results / name).unlink()
    status, said = pack(tmp_path / "crate")
    assert status == 2
    assert said.err == f"hystbench: {results}: no file in it that hystbench wrote\n"

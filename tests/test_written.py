"""What is removed or replaced is hystbench's own, folder by folder."""

import os

import pytest
from click.testing import CliRunner

from hystbench.command_files import check_replaceable
from hystbench.commands.clean import clean
from hystbench.errors import InputError
from hystbench.files import write_text
from hystbench.written import TEMPORARY, claim_logs, entry_of, is_ours, remove


@pytest.fixture
def results(tmp_path):
    """Results as the workflow leaves them, and files of somebody else among them."""
    folder = tmp_path / "results"
    for name in ("a.csv", "deep/b.json", "deep/c.json", "gone/d.json"):
        write_text(folder / name, name)
    claim_logs(folder / "logs", [])
    (folder / "logs" / "rule").mkdir()
    (folder / "logs" / "rule" / "x.log").write_text("told")
    (folder / "deep" / ".snakemake_timestamp").touch()
    (folder / "gone" / "d.json").unlink()  # as Snakemake does
    growing = folder / "deep" / f"{TEMPORARY}x"  # as a killed run leaves it
    growing.mkdir()
    (growing / "b.json").write_text("hal")
    return folder


def test_all_that_is_ours_goes(results):
    result = CliRunner().invoke(clean, [str(results)])
    assert (result.exit_code, result.output) == (0, "")
    assert not results.exists()


def test_what_is_not_ours_stays_and_is_told(results, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "e.csv").write_text("mine")
    (results / "link").symlink_to(tmp_path / "elsewhere")
    (results / "linked.csv").symlink_to(tmp_path / "elsewhere" / "e.csv")
    (results / "deep" / "b.json").write_text("edited")
    (results / "logs" / "notes.txt").write_text("mine")
    (results / "mine").mkdir()
    (results / "mine" / "x.log").write_text("mine")
    result = CliRunner().invoke(clean, [str(results)])
    assert "so it stays: " in result.output
    assert "and 2 more" in result.output
    left = {
        str(path.relative_to(results))
        for path in results.rglob("*")
        if (path.is_symlink() or not path.is_dir()) and ".hystbench" not in path.parts
    }
    names = {"link", "linked.csv", "deep/b.json", "logs/notes.txt", "mine/x.log"}
    assert left == names
    assert (tmp_path / "elsewhere" / "e.csv").read_text() == "mine"


def test_results_behind_a_link_go_and_the_link_stays(results, tmp_path):
    (tmp_path / "link").symlink_to(results)
    assert CliRunner().invoke(clean, [str(tmp_path / "link")]).exit_code == 0
    assert list(results.iterdir()) == []


def test_a_folder_that_is_to_go_holds_nothing_of_somebody_elses(results, tmp_path):
    outputs = [str(results / "a.csv"), str(results / "deep"), str(results / "new")]
    check_replaceable(outputs, [])
    (results / "deep" / "notes.csv").write_text("mine")
    with pytest.raises(InputError, match=r"deep/notes\.csv: not written by hystbench"):
        check_replaceable(outputs, [])
    (results / "deep" / "notes.csv").unlink()
    (results / "deep" / "link").symlink_to(tmp_path)
    with pytest.raises(InputError, match="deep/link: a link"):
        check_replaceable(outputs, [])


@pytest.mark.parametrize("how", ["itself", "symlink_to", "hardlink_to"])
def test_an_input_that_hystbench_wrote_does_not_go(results, tmp_path, how):
    source = results / "deep" / "b.json"
    if how != "itself":
        getattr(tmp_path / "input.json", how)(source)
        source = tmp_path / "input.json"
    with pytest.raises(InputError, match=r"deep/b\.json: an input"):
        check_replaceable([str(results / "deep")], [str(source)])


def test_a_log_of_somebody_elses_is_refused(tmp_path):
    logs = tmp_path / "logs"
    logs.mkdir()
    (logs / "x.log").write_text("mine")
    with pytest.raises(InputError, match=r"x\.log: no log of this workflow"):
        claim_logs(logs, [str(logs / "x.log")])
    claim_logs(logs, [str(logs / "y.log")])
    (logs / "y.log").write_text("told")
    claim_logs(logs, [str(logs / "y.log")])
    (logs / "z.log").symlink_to(tmp_path / "mine.txt")
    with pytest.raises(InputError, match=r"z\.log: no log"):
        claim_logs(logs, [str(logs / "z.log")])


def test_only_an_ordinary_file_is_ours(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "text")
    assert is_ours(path)
    path.rename(tmp_path / "b.txt")
    assert not is_ours(tmp_path / "b.txt")
    path.symlink_to("b.txt")
    assert not is_ours(path)
    assert not remove(path)
    assert path.is_symlink()
    path.unlink()
    os.mkfifo(path)
    assert not is_ours(path)
    with pytest.raises(InputError, match="no ordinary file"):
        write_text(path, "text")


def test_what_is_removed_leaves_no_entry(tmp_path):
    write_text(tmp_path / "a.txt", "text")
    assert remove(tmp_path / "a.txt")
    assert not entry_of(tmp_path / "a.txt").parent.exists()

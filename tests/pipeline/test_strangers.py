"""Files of somebody else in results/: no job starts that would remove them."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time

from click.testing import CliRunner

from hystbench.commands.clean import clean
from hystbench.files import write_text
from tests.conftest import ROOT
from tests.test_layouts import content, table

CELLS = "results/compare/cells.csv"


def refused(workflow, *arguments) -> str:
    """Give the one line of a run that was refused, in which nothing was changed."""
    before = content(workflow.folder / "results")
    line = workflow.refused(*arguments)
    assert content(workflow.folder / "results") == before
    return line


def test_what_was_edited_or_is_no_file_of_ours_is_refused_first(workflow):
    """All that the job would replace is looked at, and its log too."""
    folder = workflow.folder
    mine = folder / "results/compare/verdict.md"
    ours = mine.read_text()
    mine.write_text("mine")
    told = refused(workflow, "-f", CELLS)
    assert "results/compare/verdict.md: changed since hystbench wrote it" in told
    mine.write_text(ours)
    log = folder / "results/logs/tables.log"
    log.unlink()
    (folder / "notes.txt").write_text("mine")
    log.symlink_to(folder / "notes.txt")
    told = refused(workflow, "-f", CELLS)
    assert "results/logs/tables.log: no log of this workflow" in told
    assert (folder / "notes.txt").read_text() == "mine"
    log.unlink()
    # A file that is in nobody's way stays, and the job runs.
    (folder / "results/compare/notes.txt").write_text("mine")
    assert workflow.run("-f", CELLS) == {"tables": 1}
    assert (folder / "results/compare/notes.txt").read_text() == "mine"


def test_results_of_an_older_hystbench_are_refused(workflow):
    for entries in list(workflow.folder.rglob(".hystbench")):
        shutil.rmtree(entries)
    told = refused(workflow, "-f", CELLS)
    assert "not written by hystbench, or by one that kept no list" in told


def test_a_dataset_in_results_is_no_source(workflow):
    place = workflow.folder / "results/datasets/mine"
    write_text(place / "a.csv", table(1.0))
    write_text(
        place / "dataset.yaml",
        "name: mine\n"
        "time: {column: time_s, unit: s}\n"
        "input: {column: current_A, unit: A}\n"
        "output: {column: displacement_um, unit: um}\n"
        "records: [{file: a.csv}]\n",
    )
    (workflow.folder / "linked").symlink_to(place)
    told = refused(workflow, "--config", "source=linked/dataset.yaml")
    assert "source: linked/dataset.yaml lies in results/" in told


def test_a_run_that_was_cut_off_goes_on(workflow):
    """Killed while it works, with no time to tidy up: the next run is not barred.

    Snakemake and its jobs are programs that import what they use, as a user's are.
    """
    folder = workflow.folder
    cells = [f"results/filters/sine-100hz/{name}.json" for name in ("gpo", "delayed")]
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    words += ["--cores", "1"]
    silent = {"cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    cut_off = subprocess.Popen([*words, "--forcerun", "filter", "--", *cells], **silent)
    files = [folder / cell for cell in cells]
    stamps = [file.stat().st_mtime_ns for file in files]
    end = time.monotonic() + 120
    while all(
        file.exists() and file.stat().st_mtime_ns == stamp
        for file, stamp in zip(files, stamps, strict=True)
    ):
        assert time.monotonic() < end
        time.sleep(0.01)
    cut_off.send_signal(signal.SIGINT)
    cut_off.wait(timeout=120)
    subprocess.run([*words, "--rerun-incomplete", *cells], **silent, check=True)
    assert all(file.is_file() for file in files)
    assert workflow.would_run(*cells) == {}


def test_clean_takes_results_and_leaves_the_rest(workflow):
    results = workflow.folder / "results"
    (results / "filters" / "notes.txt").write_text("mine")
    result = CliRunner().invoke(clean, [str(results)])
    assert result.exit_code == 0
    assert set(content(results)) == {"filters/notes.txt"}

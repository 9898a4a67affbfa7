"""Run the real workflow on a small config in a folder of its own."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pkgutil
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from multiprocessing.reduction import DupFd
from pathlib import Path

import pytest
import yaml

from hystbench.commands import jobs as commands_of_jobs
from hystbench.written import ENTRIES
from tests.conftest import ROOT, own_config, run_hystbench, shorten

from . import programs


def small_config() -> dict:
    """The project's config, cut down to seconds."""
    config = own_config()
    config["signals"] = ["sine-100hz", "sine-200hz"]
    shorten(config, 0.2)
    config["excitations"]["sine-001hz"] = {"sine": {"frequency_hz": 1, "duration_s": 1}}
    config["identification"] |= {"starts": 1, "max_iterations": 5}
    config["filters"]["order"] = 6
    config["rdgpi"] |= {"fit_signals": ["sine-100hz"], "starts": 1}
    config["order_sweep"] |= {"signal": "sine-050hz", "orders": [1, 3]}
    config["pressure"] |= {"twins": []}
    config["constants"] |= {"twins": []}
    return config


@dataclass
class Workflow:
    """A folder in which the project's workflow runs."""

    folder: Path
    #: Where packages lie that are found before those of the environment.
    packages: Path | None = None

    def configure(self, config: dict) -> None:
        (self.folder / "config.yaml").write_text(yaml.safe_dump(config))

    def snakemake(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        words = ["--snakefile", str(ROOT / "Snakefile"), "--cores", "2", *arguments]
        return forked(words, self.folder, self.packages)

    def run(self, *arguments: str) -> dict[str, int]:
        """Run to the end and count the jobs of each rule."""
        result = self.snakemake(*arguments)
        assert result.returncode == 0, result.stdout + result.stderr
        return jobs(result.stderr + result.stdout)

    def refused(self, *arguments: str) -> str:
        """Give the one line of hystbench's by which a run is refused."""
        result = self.snakemake(*arguments)
        said = result.stdout + result.stderr
        assert result.returncode != 0, said
        assert "Traceback" not in said
        (line,) = (x for x in said.splitlines() if x.startswith("hystbench: "))
        return line

    def run_here(self, *targets: str) -> int:
        """Run the jobs that Snakemake would start, in its order; count them.

        They run in this process, one after the other: programs of their own would
        spend most of the time on imports.
        """
        asked = ("--dry-run", "--printshellcmds", "--cores", "1", *targets)
        printed = self.snakemake(*asked)
        commands = re.findall(r"^Shell command: (.*)$", printed.stdout, re.MULTILINE)
        assert commands, printed.stdout + printed.stderr
        for command in commands:
            program, *words = shlex.split(command.partition(" 2> ")[0])
            assert program == "hystbench", command
            done = run_hystbench(*words, cwd=self.folder)
            assert done.returncode == 0, command + done.stderr
        return len(commands)

    def would_run(self, *arguments: str) -> dict[str, int]:
        return self.run("--dry-run", *arguments)

    def files(self) -> dict[str, bytes]:
        """Content of each file of results, logs and the list of them aside."""
        results = self.folder / "results"
        return {
            str(path.relative_to(results)): path.read_bytes()
            for path in sorted(results.rglob("*"))
            if path.is_file() and not {"logs", ENTRIES} & {*path.parts}
        }


#: What a run and its jobs import: it takes most of one that has little to do.
IMPORTED = (
    *("snakemake.cli", "snakemake.report.html_reporter", "smart_open", "yte"),
    *("snakemake.executors.dryrun", "snakemake.executors.local"),
    *("pandas", "grimp", "pulp", "jsonschema", "docutils.core"),
    *("hystbench.settings", "hystbench.settings_checks", "hystbench.figures"),
    *("hystbench.model", "hystbench.gap.vocabulary", "hystbench.gap.bases.kinds"),
    *("hystbench.challenge.contest.plan", "hystbench.commands.rival"),
    *("hystbench.cli", "matplotlib.backends.backend_svg", "scipy.optimize"),
    *(
        f"{commands_of_jobs.__name__}.{module.name}"
        for module in pkgutil.iter_modules(commands_of_jobs.__path__)
    ),
)
# As the command line does; here libraries are imported before it.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
FORKING = multiprocessing.get_context("forkserver")
FORKING.set_forkserver_preload(list(IMPORTED))
#: Names the packages to find first in jobs.
PACKAGES = "HYSTBENCH_TEST_PACKAGES"


def forked(
    words: list[str], folder: Path, packages: Path | None
) -> subprocess.CompletedProcess[str]:
    """Run ``python -m snakemake`` in a process that has imported it."""
    with (
        tempfile.TemporaryFile("w+") as out,
        tempfile.TemporaryFile("w+") as err,
    ):
        streams = (DupFd(out.fileno()), DupFd(err.fileno()))
        own = {**os.environ, "BASH_ENV": str(started_programs())}
        given = (words, folder, packages, own, *streams)
        process = FORKING.Process(target=begin, args=given)
        process.start()
        process.join()
        printed = [stream.seek(0) or stream.read() for stream in (out, err)]
    return subprocess.CompletedProcess(words, process.exitcode, *printed)


@cache
def started_programs() -> Path:
    return programs.started(FORKING, find_what_a_job_is_to_find)


def find_what_a_job_is_to_find() -> None:
    if PACKAGES in os.environ:
        find_first(Path(os.environ[PACKAGES]))


def begin(
    words: list[str],
    folder: Path,
    packages: Path | None,
    environment: dict[str, str],
    out,
    err,
):
    """Take the place, the words and the streams of a program that was just started."""
    from snakemake.cli import main

    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    if packages is not None:
        find_first(packages)
    for number, stream in ((1, out), (2, err)):
        os.dup2(stream.detach(), number)
    sys.path.insert(0, str(folder))
    sys.argv = ["snakemake", *words]
    main()


def find_first(packages: Path) -> None:
    """Find packages of a folder before others, here and in the jobs of this process."""
    sys.path.insert(0, str(packages))
    os.environ[PACKAGES] = str(packages)
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, (str(packages), before)))
    shadowed = {place.name for place in packages.iterdir()}
    for name in list(sys.modules):
        if name.partition(".")[0] in shadowed:
            del sys.modules[name]  # imported from elsewhere, before the fork


def jobs(printed: str) -> dict[str, int]:
    """Count jobs by rule from Snakemake's table of them."""
    table = re.search(r"^job +count\n-+ +-+\n(.*?)^total +\d+$", printed, re.M | re.S)
    if table is None:
        return {}
    rows = [line.split() for line in table[1].splitlines()]
    return {name: int(count) for name, count in rows if name != "all"}


def made_once(tmp_path_factory, make: Callable[[Path], object]) -> Path:
    """Make a folder in one of the processes that run the tests; the others wait."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        folder = tmp_path_factory.mktemp("first")
        make(folder)
        return folder
    # As deep as the folders of each process.
    shared = tmp_path_factory.getbasetemp().parent / "shared"
    folder, ended = shared / "first", shared / "ended"
    try:
        folder.mkdir(parents=True)
    except FileExistsError:
        while not ended.exists():
            time.sleep(0.1)
        return folder
    try:
        make(folder)
    finally:
        ended.touch()
    return folder


@pytest.fixture(scope="session")
def finished(tmp_path_factory) -> Workflow:
    """A folder in which the small config has run; tests copy it before they write."""

    def make(folder: Path) -> None:
        workflow = Workflow(folder)
        workflow.configure(small_config())
        workflow.run()

    first = made_once(tmp_path_factory, make)
    folder = tmp_path_factory.mktemp("workflow")
    shutil.copytree(first, folder, symlinks=True, dirs_exist_ok=True)
    return Workflow(folder)


@pytest.fixture
def workflow(finished, tmp_path_factory) -> Workflow:
    """A copy of the finished folder that a test may change."""
    # As deep as the original: rules name source files relative to the folder.
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(finished.folder, folder, symlinks=True, dirs_exist_ok=True)
    return Workflow(folder)


@pytest.fixture
def config() -> dict:
    return copy.deepcopy(small_config())

"""The benchmark of imports measures every command and every job there is."""

from importlib.util import find_spec

from benchmarks.imports import imported

from hystbench.cli import COMMANDS
from hystbench.group import job_lines


def test_commands_and_jobs_are_measured():
    lines = imported()
    assert set(lines) == {*COMMANDS, *(f"job {name}" for name in job_lines())}
    for line in lines.values():
        assert find_spec(line.removeprefix("import ")) is not None

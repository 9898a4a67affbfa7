"""Every command and job is there, is imported late, and tells errors in one line."""

import errno
import sys

import pytest

from hystbench import group as group_module
from hystbench.cli import COMMANDS, run
from hystbench.group import group, job_lines
from tests.conftest import start_hystbench


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_there_and_has_help(name):
    command = group(COMMANDS).get_command(None, name)
    assert command.name == name
    assert command.help


@pytest.mark.parametrize("name", job_lines())
def test_every_job_is_there_and_has_help(name):
    jobs = group(COMMANDS).get_command(None, "job")
    command = jobs.get_command(None, name)
    assert command.name == name
    assert command.help
    assert job_lines()[name]


def test_what_a_command_imports_is_not_looked_through_for_cycles(monkeypatch):
    """It is set apart once, as what is set apart is never freed."""
    frozen = []
    monkeypatch.setattr(group_module.gc, "get_freeze_count", lambda: len(frozen))
    monkeypatch.setattr(
        group_module.gc,
        "freeze",
        lambda: frozen.append("hystbench.commands.check" in sys.modules),
    )
    for _ in range(2):
        group(COMMANDS).get_command(None, "check")
    assert frozen == [True]


def test_help_lists_the_commands_and_imports_none_of_them():
    result = start_hystbench("--help")
    assert result.returncode == 0
    for name in COMMANDS:
        assert name in result.stdout
    # jobs are the workflow's: listed where one asks for them, and only there
    assert "blind-make" not in result.stdout
    assert "blind-make" in start_hystbench("job", "-h").stdout


@pytest.mark.parametrize("arguments", [(), ("gap",), ("job",), ("job", "filter")])
def test_h_is_help_everywhere(arguments):
    # In processes of their own: click keeps the help option of a command that another
    # test has called without its group, and then has no -h.
    short = start_hystbench(*arguments, "-h")
    assert short.returncode == 0
    assert short.stdout == start_hystbench(*arguments, "--help").stdout
    assert short.stdout.startswith("Usage: hystbench")


@pytest.mark.parametrize(
    ("words", "wanted"),
    [("hystbench in", ["init", "invert"]), ("hystbench job twin", None)],
)
def test_the_shell_completes_a_command(monkeypatch, words, wanted):
    if wanted is None:
        wanted = [name for name in job_lines() if name.startswith("twin")]
    monkeypatch.setenv("_HYSTBENCH_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    found = [line.partition(",")[2] for line in start_hystbench().stdout.splitlines()]
    assert found == wanted


def test_help_needs_no_numpy(root):
    import subprocess

    code = (
        "import sys, hystbench.cli\n"
        "sys.argv = ['hystbench', '--help']\n"
        "assert hystbench.cli.run() == 0\n"
        "assert 'numpy' not in sys.modules"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["chek"], "hystbench: no command 'chek'; did you mean 'check'?"),
        (["job", "filtr"], "hystbench: no job 'filtr'; did you mean 'filter'?"),
        (["load", ".", "x", "--out", "y.npz"], "dataset.yaml"),
    ],
)
def test_a_users_mistake_is_one_line_and_status_2(tmp_path, arguments, expected):
    result = start_hystbench(*arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert expected in result.stderr
    assert result.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def raising(monkeypatch, error):
    """Let every command end with an error."""

    def called(lines):
        def command(prog_name):
            raise error

        return command

    monkeypatch.setattr(group_module, "group", called)


def test_what_the_system_refuses_is_one_line(monkeypatch, capsys):
    error = NotADirectoryError(errno.ENOTDIR, "Not a directory", "taken/x")
    raising(monkeypatch, error)
    assert run() == 2
    assert capsys.readouterr().err == "hystbench: taken/x: Not a directory\n"


def test_an_error_of_our_own_is_not_told_as_the_users(monkeypatch):
    raising(monkeypatch, OSError("no file has to do with it"))
    with pytest.raises(OSError, match="no file"):
        run()

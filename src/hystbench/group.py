"""The group of all commands, each imported when it is called."""

import ast
import gc
import importlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.resources import files
from typing import Any

import click
from click.shell_completion import CompletionItem

from hystbench import __version__
from hystbench.errors import InputError, refuse_unknown

COMMANDS = "hystbench.commands"
JOBS = f"{COMMANDS}.jobs"


@contextmanager
def _one_line() -> Iterator[None]:
    """Turn what Click says of wrong options, in four lines, into one."""
    try:
        yield
    except click.exceptions.NoArgsIsHelpError:
        raise
    except click.UsageError as error:
        command = error.ctx.info_name if error.ctx is not None else None
        said = " ".join(error.format_message().split())
        raise InputError(f"{command}: {said}" if command else said) from error


class LazyGroup(click.Group):
    """A group that imports a command when it is called.

    Parameters
    ----------
    name : str
    package : str
        Where the commands are, each in a module of its name.
    lines : mapping of str to str
        Each command and the line that ``--help`` shows for it.
    """

    def __init__(
        self, name: str, package: str, lines: Mapping[str, str], **extra: Any
    ) -> None:
        super().__init__(name=name, **extra)
        self.package = package
        self.lines = lines

    def make_context(
        self, info_name: str | None, args: list[str], *rest: Any, **extra: Any
    ) -> click.Context:
        """Read the options of the group; a mistake in them is one line."""
        with _one_line():
            return super().make_context(info_name, args, *rest, **extra)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; a mistake in its options is one line."""
        with _one_line():
            return super().invoke(ctx)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Name the commands."""
        return list(self.lines)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; an unknown name gets the nearest one."""
        if cmd_name == "job" and self.package == COMMANDS:
            about = "Run a job of the workflow."
            return LazyGroup("job", JOBS, job_lines(), help=about)
        refuse_unknown(cmd_name, self.lines, f"no {self.noun} {cmd_name!r}")
        module = cmd_name.replace("-", "_")
        command: click.Command = getattr(
            importlib.import_module(f"{self.package}.{module}"), module
        )
        # What was imported stays: to look through it for cycles takes a while.
        if not gc.get_freeze_count():
            gc.freeze()
        return command

    @property
    def noun(self) -> str:
        """What a member of the group is called."""
        return "command" if self.package == COMMANDS else "job"

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """List the commands without importing them."""
        with formatter.section(f"{self.noun.title()}s"):
            formatter.write_dl(list(self.lines.items()))

    def shell_complete(
        self, ctx: click.Context, incomplete: str
    ) -> list[CompletionItem]:
        """Complete the name of a command, or an option, without importing any."""
        found = [
            CompletionItem(name, help=line)
            for name, line in self.lines.items()
            if name.startswith(incomplete)
        ]
        return found + click.Command.shell_complete(self, ctx, incomplete)


def job_lines() -> dict[str, str]:
    """Read the names of the jobs, and what their files say of them, off the files."""
    lines = {}
    for file in sorted(files(JOBS).iterdir(), key=lambda file: file.name):
        name, _, suffix = file.name.partition(".")
        if suffix == "py" and name != "__init__":
            told = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
            line = told.splitlines()[0].partition(": ")[2]
            lines[name.replace("_", "-")] = line[:1].upper() + line[1:]
    return lines


def group(lines: Mapping[str, str]) -> click.Group:
    """Make the group of the commands, and of the jobs below it."""
    made = LazyGroup(
        "hystbench",
        COMMANDS,
        lines,
        help="Benchmark rate-dependent hysteresis models of smart actuators.",
        epilog="'hystbench job -h' lists what the rules of the workflow call.",
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    whole: click.Group = click.version_option(__version__)(made)
    return whole

"""The group of all commands, each imported when it is called."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import click

from hystbench import __version__
from hystbench.errors import InputError, nearest


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
    lines : mapping of str to str
        Each command and the line that ``--help`` shows for it.
    """

    def __init__(self, lines: Mapping[str, str]) -> None:
        super().__init__(
            name="hystbench",
            help="Benchmark rate-dependent hysteresis models of smart actuators.",
        )
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
        """Name the commands in the order of the workflow."""
        return list(self.lines)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; an unknown name gets the nearest one."""
        if cmd_name not in self.lines:
            raise InputError(
                f"no command {cmd_name!r}; {nearest(cmd_name, self.lines)}"
            )
        module = cmd_name.replace("-", "_")
        command: click.Command = getattr(
            importlib.import_module(f"hystbench.commands.{module}"), module
        )
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.lines.items()))


def group(lines: Mapping[str, str]) -> click.Group:
    """Make the group of the commands."""
    made: click.Group = click.version_option(__version__)(LazyGroup(lines))
    return made

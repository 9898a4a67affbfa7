"""Options that several commands share."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import click

from hystbench import written
from hystbench.errors import InputError

Command = TypeVar("Command", bound=Callable[..., Any])


class _Place(click.Path):
    """A path that counts as an input or an output of its command."""

    def convert(
        self,
        value: str | os.PathLike[str],
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> Any:
        """Check the path, and hold it against the other paths of the command."""
        path = super().convert(value, param, ctx)
        if ctx is not None and __name__ not in ctx.meta:
            ctx.meta[__name__] = True
            ctx.with_resource(written.one_run())
        try:
            self.take(Path(os.fsdecode(path)))
        except InputError:
            if ctx is not None:
                ctx.close()
            raise
        return path

    def take(self, path: Path) -> None:
        """Tell what the path is for."""
        raise NotImplementedError


class InputPlace(_Place):
    """A file, or a dataset's folder, that a command reads and must not write over."""

    def take(self, path: Path) -> None:
        """Hold a file safe; what a folder holds is held safe as it is read."""
        if not path.is_dir():
            written.reads(path)


class OutputFile(_Place):
    """A file that a command writes: refused before any work where it may not."""

    def take(self, path: Path) -> None:
        """Refuse a place that is not free, or that is an input of the command."""
        written.writes(path)


class OutputFolder(_Place):
    """A folder that a command writes into."""

    def take(self, path: Path) -> None:
        """Refuse a folder that cannot be written into."""
        written.check_writable(path)


def limits(command: Command) -> Command:
    """Add the limits of the next experiment: ``limit_low``, ``_high``, ``_rate``."""
    told = "Largest rate of its input, per second; else that of the records."
    command = click.option("--limit-rate", type=float, help=told)(command)
    return _both_limits(command, "next experiment")


def input_limits(command: Command) -> Command:
    """Add the limits of an actuator's input: ``limit_low`` and ``limit_high``."""
    return _both_limits(command, "actuator")


def _both_limits(command: Command, whose: str) -> Command:
    for name, told in (("high", "Highest"), ("low", "Lowest")):
        told = f"{told} input of the {whose}."
        command = click.option(f"--limit-{name}", type=float, help=told)(command)
    return command


def vocabulary(command: Command) -> Command:
    """Add the effects that a search leaves out and puts in: ``without``, ``with_``."""
    command = click.option(
        "--with",
        "with_",
        multiple=True,
        metavar="EFFECT",
        help="An effect that you put in: it is fitted from the start, and is no "
        "finding.",
    )(command)
    return click.option(
        "--without",
        multiple=True,
        metavar="EFFECT",
        help="An effect that the search must not name; may stand there several times.",
    )(command)


def calls(command: Command) -> Command:
    """Add what holds for a simulator that is a function: ``calls``, ``keep_calls``."""
    command = click.option(
        "--keep-calls/--no-keep-calls",
        default=True,
        help="Whether outputs of a slow function are kept in the user's cache folder, "
        "so that another run need not call it again.",
    )(command)
    return click.option(
        "--calls",
        type=click.IntRange(min=1),
        help="Calls of a function that are made at most; the search then ends.",
    )(command)


@contextmanager
def counted_calls(
    bound: int | None, keep: bool, say: Callable[[str], None]
) -> Iterator[None]:
    """Let calls of simulators within the block be counted, bounded and kept."""
    from hystbench.blocks.calls import Calls, counted  # late: NumPy
    from hystbench.blocks.kept_outputs import KeptOutputs, folder_of_user

    kept = KeptOutputs(folder_of_user(), say) if keep else None
    with counted(Calls(bound=bound, kept=kept, say=say)):
        yield


def kept_calls(command: Command) -> Command:
    """Let a job of the workflow use what other jobs called a slow function for."""

    @wraps(command)
    def run(*arguments: Any, **named: Any) -> Any:
        with counted_calls(None, True, lambda line: click.echo(line, err=True)):
            return command(*arguments, **named)

    return cast(Command, run)


def asked_limits(
    limit_low: float | None, limit_high: float | None, limit_rate: float | None
) -> dict[str, float]:
    """Give the limits that were asked for, by name.

    Raises
    ------
    InputError
        If one is no finite number, or nothing lies between them.
    """
    given = {"low": limit_low, "high": limit_high, "rate": limit_rate}
    asked = {name: value for name, value in given.items() if value is not None}
    for name, value in asked.items():
        if not math.isfinite(value) or (name == "rate" and value <= 0):
            least = " above 0" if name == "rate" else ""
            raise InputError(f"--limit-{name}: {value:g}; expected a number{least}")
    if limit_low is not None and limit_high is not None and limit_low >= limit_high:
        raise InputError(
            f"--limit-low {limit_low:g} and --limit-high {limit_high:g}; expected the "
            "lower one first"
        )
    return asked


def both_limits(
    limit_low: float | None, limit_high: float | None, beside: str
) -> tuple[float, float]:
    """Give both limits of an input.

    Raises
    ------
    InputError
        If one was not asked for.
    """
    if limit_low is None or limit_high is None:
        missing = "low" if limit_low is None else "high"
        raise InputError(f"--limit-{missing}: expected it beside {beside}")
    return limit_low, limit_high


@contextmanager
def refused_of(*places: Path) -> Iterator[None]:
    """Let a refusal within the block name the files; that of an option names itself."""
    try:
        yield
    except InputError as error:
        if str(error).startswith("--"):
            raise
        named = "".join(f"{place}: " for place in places)
        raise InputError(f"{named}{error}") from None


def warn(lines: Iterable[str]) -> None:
    """Show warnings on the terminal, one line each."""
    for line in lines:
        click.echo(f"hystbench: warning: {line}", err=True)


unnamed_share = click.option(
    "--unnamed-share",
    type=click.FloatRange(0.0, 1.0, min_open=True),
    default=0.01,
    show_default=True,
    help="Share of the gap's power that may stay unnamed beside a name.",
)

write_experiment = click.option(
    "--write-experiment",
    type=OutputFile(path_type=Path),
    help="Write the excitation that would tell likely effects apart, as CSV or .npz.",
)

FILE = InputPlace(exists=True, dir_okay=False, path_type=Path)
#: A dataset.yaml or its folder; what it refers to is held safe as it is read.
DATASET = InputPlace(path_type=Path)
NEW_FILE = OutputFile(path_type=Path)
NEW_FOLDER = OutputFolder(path_type=Path)

out = click.option(
    "--out", type=NEW_FILE, required=True, help="File to write, whole or not at all."
)
out_folder = click.option(
    "--out", type=NEW_FOLDER, required=True, help="Folder to write."
)

"""Options that several commands share."""

import math
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, TypeVar, cast

import click

from hystbench import written
from hystbench.errors import InputError

Command = TypeVar("Command", bound=Callable[..., Any])


class GuardedPath(click.Path):
    """A path that counts as an input or an output of its command.

    Parameters
    ----------
    take : callable
        Told of the path: it refuses one that the command must not read or write.
    **about
        As for :class:`click.Path`.
    """

    def __init__(self, take: Callable[[Path], None], **about: Any) -> None:
        super().__init__(path_type=Path, **about)
        self.take = take

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


def held_safe(path: Path) -> None:
    """Hold a file safe that is read; what a folder holds is held safe as it is read."""
    if not path.is_dir():
        written.reads(path)


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


FILE = GuardedPath(held_safe, exists=True, dir_okay=False)
#: A dataset.yaml or its folder; what it refers to is held safe as it is read.
DATASET = GuardedPath(held_safe)
NEW_FILE = GuardedPath(written.writes)
NEW_FOLDER = GuardedPath(written.check_writable)


@dataclass(frozen=True)
class SearchOptions:
    """What is asked of a search for what a simulator lacks, each with its help."""

    without: tuple[
        Annotated[
            str,
            "An effect that the search must not name; may stand there several times.",
            {"metavar": "EFFECT"},
        ],
        ...,
    ] = ()
    with_: tuple[
        Annotated[
            str,
            "An effect that you put in: it is fitted from the start, and is no "
            "finding.",
            {"metavar": "EFFECT"},
        ],
        ...,
    ] = ()
    write_experiment: Annotated[
        Path | None,
        NEW_FILE,
        "Write the excitation that would tell likely effects apart, as CSV or .npz.",
    ] = None
    limit_low: Annotated[float | None, "Lowest input of the next experiment."] = None
    limit_high: Annotated[float | None, "Highest input of the next experiment."] = None
    limit_rate: Annotated[
        float | None, "Largest rate of its input, per second; else that of the records."
    ] = None
    unnamed_share: Annotated[
        float,
        click.FloatRange(0.0, 1.0, min_open=True),
        "Share of the gap's power that may stay unnamed beside a name.",
        {"show_default": True},
    ] = 0.01

    @property
    def limits(self) -> dict[str, float]:
        """The limits of the next experiment that were asked for, by name."""
        return asked_limits(self.limit_low, self.limit_high, self.limit_rate)

"""Commands made of a function's signature, and the options that several share.

What comes by its place is an argument of the command line, what comes by its name an
option: ``runs: tuple[In, ...]`` is ``--run``, once for each; what has a default may be
left out. A kind is a type with its help, and with what reads it where the type alone
does not say: ``Annotated[float, "Interval in seconds."]``.
"""

import inspect
import json
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    TypeVar,
    Union,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

import click

from hystbench import command_files
from hystbench.cores import available
from hystbench.errors import InputError
from hystbench.files import read_json

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
            ctx.with_resource(command_files.one_run())
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
        command_files.reads(path)


class SettingsType(click.ParamType[dict[str, Any]]):
    """Settings of a job: a JSON object, as the workflow writes it."""

    name = "JSON"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> dict[str, Any]:
        """Read the text as a JSON object."""
        try:
            settings = json.loads(value)
        except json.JSONDecodeError as error:
            self.fail(f"not JSON: {error}", param, ctx)
        if not isinstance(settings, dict):
            self.fail("expected a JSON object of settings", param, ctx)
        return settings


class JsonFile(GuardedPath):
    """A JSON file, read."""

    def convert(self, *given: Any) -> Any:
        """Check the path, and read what is there."""
        return read_json(super().convert(*given))


FILE = GuardedPath(held_safe, exists=True, dir_okay=False)
#: A dataset.yaml or its folder; what it refers to is held safe as it is read.
DATASET = GuardedPath(held_safe)
NEW_FILE = GuardedPath(command_files.writes)
NEW_FOLDER = GuardedPath(command_files.check_writable)
Settings = Annotated[dict[str, Any], SettingsType(), "Settings of the job."]
In = Annotated[Path, FILE, "File to read."]
Json = Annotated[
    Any, JsonFile(held_safe, exists=True, dir_okay=False), "JSON file to read."
]
DatasetFile = Annotated[Path, DATASET, "Dataset to read."]
Folder = Annotated[
    Path, click.Path(exists=True, file_okay=False, path_type=Path), "Folder to read."
]
Out = Annotated[Path, NEW_FILE, "File to write, whole or not at all."]
OutFolder = Annotated[Path, NEW_FOLDER, "Folder to write."]

# Of an actuator.
InputLow = Annotated[float, "Lowest input of the actuator."]
InputHigh = Annotated[float, "Highest input of the actuator."]


def command(
    function: Callable[..., None], also: Mapping[str, tuple[Any, Any]] | None = None
) -> click.Command:
    """Make a command of a function, with its docstring as help.

    Parameters
    ----------
    function : callable
    also : mapping of str to (kind, default), optional
        Further options, which its ``**`` parameter takes.
    """
    hints = get_type_hints(function, include_extras=True)
    parameters: list[click.Parameter] = []
    for given in inspect.signature(function).parameters.values():
        if given.kind is given.VAR_KEYWORD:
            parameters += [_option(name, *each) for name, each in (also or {}).items()]
        else:
            by_place = given.kind is given.POSITIONAL_OR_KEYWORD
            make = _argument if by_place else _option
            parameters.append(make(given.name, hints[given.name], given.default))
    return click.command(params=parameters)(function)


def of_class(kind: type) -> dict[str, tuple[Any, Any]]:
    """Give the fields of a dataclass as options, all with a default."""
    hints = get_type_hints(kind, include_extras=True)
    return {item.name: (hints[item.name], item.default) for item in fields(kind)}


def _argument(name: str, hint: Any, default: Any) -> click.Argument:
    kind, many = _kind(hint)
    required = default is inspect.Parameter.empty
    reads = _about(kind)["type"]
    return click.Argument(
        [name], type=reads, nargs=-1 if many else 1, required=required
    )


def _option(name: str, hint: Any, default: Any) -> click.Option:
    kind, many = _kind(hint)
    flag = (name.removesuffix("s") if many else name).rstrip("_").replace("_", "-")
    said = f"--{flag}/--no-{flag}" if default is True else f"--{flag}"
    about = {**_about(kind), "multiple": many}
    if default is False:
        about["is_flag"] = True
    if default is inspect.Parameter.empty:
        about["required"] = True
    elif default is not None:
        about["default"] = default
    return click.Option([said, name], **about)


def _kind(hint: Any) -> tuple[Any, bool]:
    """Give the kind of one value of a parameter, and whether there may be many."""
    hint = _given(hint)
    many = get_origin(hint) is tuple and ... in get_args(hint)
    return (get_args(hint)[0] if many else hint), many


def _given(hint: Any) -> Any:
    """Give what a parameter is that may be left out."""
    if get_origin(hint) not in (Union, UnionType):
        return hint
    (found,) = (each for each in get_args(hint) if each is not NoneType)
    return found


def _about(kind: Any) -> dict[str, Any]:
    """Give what Click is told of a kind: what reads it, its help, and all else."""
    if get_origin(kind) is not Annotated:
        return {"type": _type(kind)}
    about: dict[str, Any] = {"type": _type(_given(kind.__origin__))}
    for each in kind.__metadata__:
        if isinstance(each, dict):
            about |= each
        else:
            about["help" if isinstance(each, str) else "type"] = each
    return about


def _type(plain: Any) -> Any:
    """Give what reads the text of a type without words of its own."""
    if get_origin(plain) is tuple:
        return tuple(_about(each)["type"] for each in get_args(plain))
    return click.Choice(get_args(plain)) if get_origin(plain) is Literal else plain


class ChoiceOrNone(click.Choice[str]):
    """A choice that is better left out than made where none fits."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str:
        """Read a choice, or refuse it and say so."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            told = error.message.rstrip(".")
            self.fail(f"{told}; leave it out where none fits", param, ctx)


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
    cores: Annotated[
        int | None,
        click.IntRange(min=1),
        "Cores that the search may use; all that there are by default.",
    ] = None

    @property
    def most_cores(self) -> int:
        """How many cores the search may use."""
        return self.cores or available()

    @property
    def limits(self) -> dict[str, float]:
        """The limits of the next experiment that were asked for, by name."""
        return asked_limits(self.limit_low, self.limit_high, self.limit_rate)

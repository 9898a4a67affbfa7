"""Commands made of a function's signature, and the kinds of their parameters.

What comes by its place is an argument of the command line, what comes by its name an
option: ``runs: tuple[In, ...]`` is ``--run``, once for each; what has a default may be
left out. A kind is a type with its help, and with what reads it where the type alone
does not say: ``Annotated[float, "Interval in seconds."]``.
"""

import inspect
import json
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import click

from hystbench.files import read_json
from hystbench.options import (
    DATASET,
    FILE,
    NEW_FILE,
    NEW_FOLDER,
    GuardedPath,
    held_safe,
)


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


JSON_FILE = JsonFile(held_safe, exists=True, dir_okay=False)
FOLDER = click.Path(exists=True, file_okay=False, path_type=Path)
Settings = Annotated[dict[str, Any], SettingsType(), "Settings of the job."]
In = Annotated[Path, FILE, "File to read."]
Json = Annotated[Any, JSON_FILE, "JSON file to read."]
DatasetFile = Annotated[Path, DATASET, "Dataset to read."]
Folder = Annotated[Path, FOLDER, "Folder to read."]
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

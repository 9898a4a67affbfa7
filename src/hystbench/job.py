"""A job of the workflow: a command made of a function's signature.

What comes by its place is an argument of the command line, what comes by its name an
option: ``runs: tuple[In, ...]`` is ``--run``, once for each; what has a default may be
left out. The kinds of parameters below say what is read and what is written.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import click

from hystbench.files import read_json
from hystbench.options import DATASET, FILE, NEW_FILE, NEW_FOLDER, InputPlace


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


class JsonFile(InputPlace):
    """A JSON file, read."""

    def convert(self, *given: Any) -> Any:
        """Check the path, and read what is there."""
        return read_json(super().convert(*given))


JSON_FILE = JsonFile(exists=True, dir_okay=False, path_type=Path)
FOLDER = click.Path(exists=True, file_okay=False, path_type=Path)
# The type of a parameter, what reads it, and the help of an option.
Settings = Annotated[dict[str, Any], SettingsType(), "Settings of the job."]
In = Annotated[Path, FILE, "File to read."]
Json = Annotated[Any, JSON_FILE, "JSON file to read."]
DatasetFile = Annotated[Path, DATASET, "Dataset to read."]
Folder = Annotated[Path, FOLDER, "Folder to read."]
Out = Annotated[Path, NEW_FILE, "File to write, whole or not at all."]
OutFolder = Annotated[Path, NEW_FOLDER, "Folder to write."]


def job(function: Callable[..., None], also: Iterable[str] = ()) -> click.Command:
    """Make a command of a function, with its docstring as help.

    Parameters
    ----------
    function : callable
        Decorators of ``click`` below may have added options of their own.
    also : iterable of str
        Names of further options, which its ``**`` parameter takes: none is required.
    """
    hints = get_type_hints(function, include_extras=True)
    decorated = {each.name for each in getattr(function, "__click_params__", ())}
    parameters: list[click.Parameter] = []
    for given in inspect.signature(function).parameters.values():
        hint = hints[given.name]
        if given.kind is given.VAR_KEYWORD:
            parameters += [_option(each, hint, None) for each in also]
        elif given.name not in decorated:
            by_place = given.kind is given.POSITIONAL_OR_KEYWORD
            make = _argument if by_place else _option
            parameters.append(make(given.name, hint, given.default))
    return click.command(params=parameters)(function)


def _argument(name: str, hint: Any, default: Any) -> click.Argument:
    kind, many = _kind(hint)
    required = default is inspect.Parameter.empty
    count = -1 if many else 1
    return click.Argument([name], type=_type(kind), nargs=count, required=required)


def _option(name: str, hint: Any, default: Any) -> click.Option:
    kind, many = _kind(hint)
    flag = (name.removesuffix("s") if many else name).replace("_", "-")
    about: dict[str, Any] = {"type": _type(kind), "multiple": many}
    if get_origin(kind) is Annotated:
        about["help"] = kind.__metadata__[1]
    if default is inspect.Parameter.empty:
        about["required"] = True
    elif default is not None:
        about["default"] = default
    return click.Option([f"--{flag}", name], **about)


def _kind(hint: Any) -> tuple[Any, bool]:
    """Give the kind of one value of a parameter, and whether there may be many."""
    if get_origin(hint) in (Union, UnionType):
        (hint,) = (each for each in get_args(hint) if each is not NoneType)
    many = get_origin(hint) is tuple and ... in get_args(hint)
    return (get_args(hint)[0] if many else hint), many


def _type(kind: Any) -> Any:
    """Give what reads the text of a value, or of each part of it."""
    if get_origin(kind) is tuple:
        return tuple(map(_type, get_args(kind)))
    return kind.__metadata__[0] if get_origin(kind) is Annotated else kind

"""Options that several commands share."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import click

from hystbench.errors import InputError

Command = TypeVar("Command", bound=Callable[..., Any])


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


def limits(command: Command) -> Command:
    """Add the limits of the next experiment: ``limit_low``, ``_high``, ``_rate``."""
    for name, told in (
        ("rate", "Largest rate of its input, per second; else that of the records."),
        ("high", "Highest input of the next experiment."),
        ("low", "Lowest input of the next experiment."),
    ):
        command = click.option(f"--limit-{name}", type=float, help=told)(command)
    return command


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


def warn(lines: Iterable[str]) -> None:
    """Show warnings on the terminal, one line each."""
    for line in lines:
        click.echo(f"hystbench: warning: {line}", err=True)


write_experiment = click.option(
    "--write-experiment",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write the excitation that would tell likely effects apart, as CSV or .npz.",
)

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
NEW_FILE = click.Path(path_type=Path)

settings = click.option(
    "--settings", type=SettingsType(), required=True, help="Settings of the job."
)
out = click.option(
    "--out", type=NEW_FILE, required=True, help="File to write, whole or not at all."
)
identified = click.option(
    "--identified", type=FILE, help="Identified envelope functions (JSON)."
)
arrays = click.option(
    "--arrays", type=NEW_FILE, required=True, help="Archive of output and error."
)

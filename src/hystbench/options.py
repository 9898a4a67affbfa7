"""Options that several commands share."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

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
    """Give the limits that were asked for, by name."""
    asked = {"low": limit_low, "high": limit_high, "rate": limit_rate}
    return {name: value for name, value in asked.items() if value is not None}


unnamed_share = click.option(
    "--unnamed-share",
    type=click.FloatRange(0.0, 1.0, min_open=True),
    default=0.01,
    show_default=True,
    help="Share of the gap's power that may stay unnamed beside a name.",
)

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

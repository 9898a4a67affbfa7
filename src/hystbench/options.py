"""Options that several commands share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click


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

"""Captions: the files that `snakemake --report` shows, too."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hystbench.errors import InputError
from hystbench.report.markup import paragraphs

#: Where a table's caption has another name than its file.
_NAMES = {"published-parameters": "rdgpi-published"}


def caption(folder: Path, name: str, settings: Mapping[str, Any]) -> str:
    """Read the caption of a figure or table, as one paragraph.

    Captions are templates of Snakemake: ``snakemake.config`` and ``snakemake.input``
    are given what they use, the settings of the order sweep and its record.

    Raises
    ------
    InputError
        If there is none.
    """
    from jinja2 import Environment, StrictUndefined

    path = folder / f"{_NAMES.get(name, name)}.rst"
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: no caption ({error.strerror})") from error
    sweep = settings["order_sweep"]
    job = SimpleNamespace(
        config={"order_sweep": sweep},
        input=SimpleNamespace(record=[f"{sweep['signal']}.npz"]),
    )
    # It makes plain text, which is escaped where it is shown.
    template = Environment(undefined=StrictUndefined).from_string(text)  # noqa: S701
    return " ".join(paragraphs(template.render(snakemake=job)))

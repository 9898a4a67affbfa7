"""What the page shows, read from the files of results."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hystbench.compare import measured, off
from hystbench.compare.cells import ComparedCell
from hystbench.compare.rows import headers, names_of, read_items, read_rows
from hystbench.errors import InputError
from hystbench.files import read_json
from hystbench.published.discrepancies import AuditRow
from hystbench.report.markup import first_sentence, inline, paragraphs
from hystbench.report.picture import Link, PagePicture, embedded

Row = dict[str, str]

#: Where a table's caption has another name than its file.
_NAMES = {"published-parameters": "rdgpi-published"}

#: Columns that the page cannot do without; others are shown as they are.
_CLAIMS = ("id", "claim", "where", "kind", "basis", "verdict", "evidence")


@dataclass(frozen=True)
class Shown:
    """A CSV file that is shown as it is."""

    name: str
    rows: list[Row]
    caption: str
    file: Link


@dataclass(frozen=True)
class Reproduction:
    """What a comparison with the paper wrote."""

    cells: Sequence[ComparedCell]
    claims: list[Row]
    on_held_out: list[Row]
    off: list[Row]
    audit: list[Row]
    tables: list[Shown]
    verdict: str


@dataclass(frozen=True)
class Measured:
    """What a comparison on a measured dataset wrote."""

    name: str
    errors: list[Row]


@dataclass(frozen=True)
class ReproductionContent:
    """All that is on the page."""

    found: Reproduction | Measured
    figures: list[PagePicture]
    tables: list[Shown]
    captions: dict[str, str]
    compare: str


def read_content(
    base: Path,
    compare: Path,
    figures: Sequence[Path],
    tables: Sequence[Path],
    captions: Path,
    settings: Mapping[str, Any],
) -> ReproductionContent:
    """Read what the page shows.

    Parameters
    ----------
    base : Path
        Folder of the page: links are relative to it.
    compare : Path
        Folder that ``hystbench job compare`` or ``compare-measured`` wrote.
    figures : sequence of Path
        SVG files; the stem is the figure's name. A PNG lies beside each.
    tables : sequence of Path
        Further CSV files to show.
    captions : Path
        Folder with ``<name>.rst`` for each figure and table.
    settings : mapping
        ``dataset``, the name of the measured dataset or None for the twin;
        ``order_sweep`` with its ``signal`` and ``convergence_factor``, of which the
        caption of Figure 7 speaks.

    Raises
    ------
    InputError
        If a file is not as it should be.
    """

    def told(name: str) -> str:
        return _caption(captions, name, settings)

    def shown(path: Path, text: str) -> Shown:
        return Shown(path.stem, read_rows(path, ()), text, _link(path, base))

    found: Reproduction | Measured
    if settings["dataset"] is None:
        found = Reproduction(
            cells=read_items(compare / "cells.csv", ComparedCell),
            claims=read_rows(compare / "claims.csv", _CLAIMS),
            on_held_out=_on_held_out(compare / "summary.json"),
            off=read_rows(compare / "off.csv", headers(off.OFF_COLUMNS)),
            audit=read_rows(compare / "audit.csv", names_of(AuditRow)),
            tables=[
                shown(compare / "tables" / f"table-{number}.csv", "")
                for number in (1, 2, 3, 4)
            ],
            verdict=(compare / "verdict.md").read_text(encoding="utf-8"),
        )
        names = ["cells", "claims", "off", "audit"]
    else:
        rows = read_rows(compare / "errors.csv", measured.ERROR_COLUMNS)
        found = Measured(settings["dataset"], rows)
        names = ["errors"]
    return ReproductionContent(
        found=found,
        figures=[_figure(path, base, told(path.stem)) for path in figures],
        tables=[shown(path, told(path.stem)) for path in tables],
        captions={name: told(name) for name in names},
        compare=os.path.relpath(compare, base),
    )


def _figure(path: Path, base: Path, text: str) -> PagePicture:
    files = (
        Link("SVG", _link(path, base).href),
        Link("PNG", _link(path.with_suffix(".png"), base).href),
    )
    return embedded(path, first_sentence(text), inline(text), files)


def _link(path: Path, base: Path) -> Link:
    """Link a file by its path from the page, as a browser reads it."""
    from urllib.parse import quote

    return Link(
        path.suffix[1:].upper(), quote(Path(os.path.relpath(path, base)).as_posix())
    )


def _caption(folder: Path, name: str, settings: Mapping[str, Any]) -> str:
    """Read the caption of a figure or table, as one paragraph.

    Captions are templates of Snakemake: ``snakemake.config`` and ``snakemake.input``
    are given what they use, the settings of the order sweep and its record.
    """
    from jinja2 import Environment, StrictUndefined

    text = (folder / f"{_NAMES.get(name, name)}.rst").read_text(encoding="utf-8")
    sweep = settings["order_sweep"]
    job = SimpleNamespace(
        config={"order_sweep": sweep},
        input=SimpleNamespace(record=[f"{sweep['signal']}.npz"]),
    )
    # It makes plain text, which is escaped where it is shown.
    template = Environment(undefined=StrictUndefined).from_string(text)  # noqa: S701
    return " ".join(paragraphs(template.render(snakemake=job)))


def _on_held_out(path: Path) -> list[Row]:
    """Read the results that are judged on held-out signals alone."""
    try:
        found: list[Row] = read_json(path)["claims_on_held_out"]
    except (KeyError, TypeError) as error:
        raise InputError(f"{path}: expected the summary of a comparison") from error
    return found

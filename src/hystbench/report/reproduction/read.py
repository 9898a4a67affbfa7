"""The files that the page is made of, and what of them is text or a picture."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hystbench.compare.rows import read_rows
from hystbench.report.markup import first_sentence, inline, paragraphs
from hystbench.report.picture import Link, PagePicture, embedded

Row = dict[str, str]

#: Where a table's caption has another name than its file.
_NAMES = {"published-parameters": "rdgpi-published"}


@dataclass(frozen=True)
class Shown:
    """A CSV file that is shown as it is."""

    name: str
    rows: list[Row]
    caption: str
    file: Link


@dataclass(frozen=True)
class Results:
    """Files of results that the page shows."""

    base: Path
    """Folder of the page: links are relative to it."""
    compare: Path
    """Folder that ``hystbench job compare`` or ``compare-measured`` wrote."""
    figures: Sequence[Path]
    """SVG files; the stem is the figure's name. A PNG lies beside each."""
    tables: Sequence[Path]
    """Further CSV files to show."""
    captions: Path
    """Folder with ``<name>.rst`` for each figure and table."""
    settings: Mapping[str, Any]
    """``dataset``, the name of the measured dataset or None for the twin;
    ``order_sweep`` with its ``signal`` and ``convergence_factor``, of which the caption
    of Figure 7 speaks."""

    @property
    def folder(self) -> str:
        """Folder of the comparison, from the page."""
        return os.path.relpath(self.compare, self.base)

    def rows(self, name: str, columns: tuple[str, ...]) -> list[Row]:
        """Read a table of the comparison that has these columns."""
        return read_rows(self.compare / name, columns)

    def link(self, path: Path) -> Link:
        """Link a file by its path from the page, as a browser reads it."""
        from urllib.parse import quote

        href = quote(Path(os.path.relpath(path, self.base)).as_posix())
        return Link(path.suffix[1:].upper(), href)

    def shown(self, path: Path, caption: str = "") -> Shown:
        """Read a CSV file that is shown as it is."""
        return Shown(path.stem, read_rows(path, ()), caption, self.link(path))

    def pictures(self) -> dict[str, PagePicture]:
        """Read the figures, by name."""
        found = {}
        for path in self.figures:
            text = self.caption(path.stem)
            files = self.link(path), self.link(path.with_suffix(".png"))
            about = first_sentence(text), inline(text)
            found[path.stem] = embedded(path, *about, files)
        return found

    def caption(self, name: str) -> str:
        """Read the caption of a figure or table, as one paragraph.

        Captions are templates of Snakemake: ``snakemake.config`` and
        ``snakemake.input`` are given what they use, the settings of the order sweep
        and its record.
        """
        from jinja2 import Environment, StrictUndefined

        file = self.captions / f"{_NAMES.get(name, name)}.rst"
        sweep = self.settings["order_sweep"]
        job = SimpleNamespace(
            config={"order_sweep": sweep},
            input=SimpleNamespace(record=[f"{sweep['signal']}.npz"]),
        )
        # It makes plain text, which is escaped where it is shown.
        plain = Environment(undefined=StrictUndefined)  # noqa: S701
        template = plain.from_string(file.read_text(encoding="utf-8"))
        return " ".join(paragraphs(template.render(snakemake=job)))

"""The front page of the results: verdict, ours beside the paper's, tables, figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hystbench.files import write_text


def write_page(
    out: Path,
    compare: Path,
    figures: Sequence[Path],
    tables: Sequence[Path],
    captions: Path,
    settings: Mapping[str, Any],
) -> None:
    """Write the page of the reproduction or of a measured dataset.

    Parameters
    ----------
    out : Path
        The page. Its links are relative to its folder.
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
        If a file is missing or not as it should be.
    """
    from hystbench.report.reproduction.page import page
    from hystbench.report.reproduction.read import read_content

    content = read_content(out.parent, compare, figures, tables, captions, settings)
    write_text(out, page(content))

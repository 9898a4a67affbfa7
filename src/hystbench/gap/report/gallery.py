"""What a page of several devices shows of each: two pictures, and the verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.files import write_csv, write_text
from hystbench.gap.report import diagram, pictures, words
from hystbench.gap.report.page import with_optional
from hystbench.gap.report.read import Content, read_content

FORMATS = ("svg", "png")


def write_gallery(folder: str | Path) -> None:
    """Write verdict.md and, as SVG and PNG, the pictures ``model`` and ``residual``.

    They are made of gap.json, model.yaml and holdout/. ``model`` is the block diagram;
    ``residual`` is what is left, before and after, of the hold-out record that the base
    misses most.

    Parameters
    ----------
    folder : str or Path
        As the gap workflow left it.

    Raises
    ------
    InputError
        If one of these files is missing or cannot be read.
    """
    place = Path(folder)
    content = read_content(place)
    if content.model is None:
        raise InputError(f"{place / 'model.yaml'}: no such file; expected a model file")
    with style.in_style():
        drawn = {
            "model": diagram.figure_of(content.model, content.gap),
            "residual": _residual(content, place),
        }
        for name, figure in drawn.items():
            for suffix in FORMATS:
                style.save(figure, place / f"{name}.{suffix}")
    write_text(place / "verdict.md", words.verdict_text(with_optional(content.gap)))


def write_sentences(contents: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write one row a dataset: the verdict in a sentence.

    Parameters
    ----------
    contents : sequence of mapping
        What gap.json of each holds.
    path : Path
        CSV file.
    """
    rows = [
        [content["dataset"], words.verdict_sentence(with_optional(content))]
        for content in contents
    ]
    write_csv(path, ("dataset", "verdict in a sentence"), rows)


def _residual(content: Content, place: Path) -> Figure:
    table = pictures.worst(content.hold_out)
    if table is None:
        raise InputError(f"{place / 'holdout'}: no tables; expected one a record")
    figure = Figure(figsize=(style.PAGE, 2.3))
    gap = content.gap
    pictures.residual(
        figure.subplots(1, 2), table, gap["gap"]["noise_floor"], gap["unit"]
    )
    return figure

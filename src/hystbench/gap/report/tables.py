"""The verdicts on several datasets side by side: tables, sentences and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from hystbench.blocks.base import Block
from hystbench.blocks.force import Dynamics
from hystbench.blocks.parameter import SETTINGS
from hystbench.blocks.store import Store
from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.files import write_csv, write_text
from hystbench.gap.fitting.parameter_units import unit_at
from hystbench.gap.report import diagram, pictures, where_pictures, words
from hystbench.gap.report.page import with_optional
from hystbench.gap.report.read import Content, read_content
from hystbench.model import Model

Told = Mapping[str, Any]
"""What gap.json holds."""

Row = Sequence[Any]


def write_table(name: str, contents: Sequence[Told], path: Path) -> None:
    """Write one of the tables of several datasets as CSV.

    Parameters
    ----------
    name : {"summary", "records", "effects", "sentences"}
    contents : sequence of mapping
        What gap.json of each holds.
    path : Path
    """
    columns, rows_of = TABLES[name]
    write_csv(path, columns, [row for told in contents for row in rows_of(told)])


def write_adds(model: Model, path: Path) -> None:
    """Write what a model adds behind its hysteresis: one row a stated parameter.

    Beside what was named on the model's records it shows which of it was found.
    """
    rows = [
        [label, name, _any(block.parameters()[name].plain(getattr(block, name))), unit]
        for label, block, name, unit in _numbers(model)
        if not block.hysteretic and name not in SETTINGS and name in block.to_mapping()
    ]
    write_csv(path, ("block", "parameter", "value", "unit"), rows)


def write_host(model: Model, told: Told, path: Path) -> None:
    """Write the fitted numbers of what has effects inside: one row a number.

    Parameters
    ----------
    model : Model
        With the effects.
    told : mapping
        What gap.json holds. Its numbers of the base are those without the effects.
    path : Path
    """
    known = told.get("base_parameters", {})
    rows = [
        [label, name, _any(numbers["after"]), _any(numbers["before"]), unit]
        for label, block, name, unit in _numbers(model)
        if isinstance(block, Dynamics | Store)
        if (numbers := known.get(f"{label}.{name}")) is not None
    ]
    columns = ("block", "parameter", "fitted", "without the effects", "unit")
    write_csv(path, columns, rows)


def _numbers(model: Model) -> Iterator[tuple[str, Block, str, str]]:
    """Give each number of a model: its block's label, the block, its name and unit."""
    ends = model.input.unit, model.output.unit
    for k, (label, block) in enumerate(model.labelled()):
        for name, about in block.parameters().items():
            yield label, block, name, unit_at(about.unit, model.chain, k, *ends)


def _summary(told: Told) -> Iterator[Row]:
    """Give the row of a dataset: the verdict, and RMS over its hold-out records."""
    gap = told["gap"]
    yield [
        *(told[key] for key in ("dataset", "model", "verdict")),
        " + ".join(item["name"] for item in told["effects"]) or "none",
        " + ".join((told["withdrawn"] or {}).get("names", ())),
        told["unit"],
        *(_rms(gap[key]) for key in ("before", "after")),
        _rms(told["black_box"]["after"]),
        _number(gap["noise_floor"]),
        gap["floor_method"],
        *(_share(told[part]["explained"]) for part in ("gap", "fit")),
        told["reason"],
        (told["shortfall"] or {}).get("sentence", ""),
    ]


def _records(told: Told) -> Iterator[Row]:
    """Give a row a hold-out record: RMS, and in what it is outside what was fitted.

    There a black box knows nothing, and effects that are the right ones still hold.
    """
    for item in told["black_box"]["records"]:
        sizes = (_rms(item[key]) for key in ("before", "after", "named"))
        yield [told["dataset"], item["name"], " and ".join(item["outside"]), *sizes]


def _effects(told: Told) -> Iterator[Row]:
    """Give a row a parameter of each named effect."""
    for item in told["effects"]:
        shown = [
            *(told["dataset"], item["name"], item["place"]),
            _number(item["confidence"]),
            ", ".join(item["cannot_be_told_from"]),
        ]
        for name, about in item["parameters"].items():
            value, error = about["value"], about["standard_error"]
            yield [*shown, name, _any(value), _any(error), about["unit"]]


def _sentences(told: Told) -> Iterator[Row]:
    """Give the row of a dataset: the verdict in a sentence."""
    yield [told["dataset"], words.verdict_sentence(with_optional(told))]


TABLES: dict[str, tuple[tuple[str, ...], Callable[[Told], Iterator[Row]]]] = {
    "summary": (
        (
            *("dataset", "base", "verdict", "effects", "withdrawn", "unit", "before"),
            *("after", "black_box", "noise_floor", "floor_method", "explained_percent"),
            *("explained_on_fit_percent", "reason", "shortfall"),
        ),
        _summary,
    ),
    "records": (
        ("dataset", "record", "outside", "before", "black_box", "after"),
        _records,
    ),
    "effects": (
        (
            *("dataset", "effect", "place", "confidence", "cannot_be_told_from"),
            *("parameter", "value", "standard_error", "unit"),
        ),
        _effects,
    ),
    "sentences": (("dataset", "verdict in a sentence"), _sentences),
}
"""Columns of each table, and the rows of a dataset."""


def _share(explained: float | Sequence[float] | None) -> str:
    """Give a share in percent, or a range of it where the floor is a bound."""
    if explained is None:
        return ""
    if isinstance(explained, Sequence):
        return " to ".join(f"{100 * each:.1f}" for each in explained)
    return f"{100 * explained:.1f}"


def _any(value: object) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence):
        return " ".join(_any(each) for each in value)
    return "" if value is None else _number(float(str(value)))


def _rms(value: float | None) -> str:
    """Give an RMS; a model that runs away on a record has none."""
    return "unbounded" if value is None else _number(value)


def _number(value: float) -> str:
    return f"{value:.4g}"


FORMATS = ("svg", "png")


def write_gallery(folder: str | Path) -> None:
    """Write verdict.md, host.csv and pictures: ``model``, ``residual``, ``where``.

    They are made of gap.json, model.yaml, holdout/ and curves.json. Pictures are SVG
    and PNG. ``model`` is the block diagram; ``residual`` is what is left, before and
    after, of the hold-out record that the base misses most; ``where`` is how modes move
    with the level of the input, or else the first picture of where the gap is.

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
    with style.in_style():
        drawn = {
            "model": diagram.figure_of(content.model, content.gap),
            "residual": _residual(content, place),
            "where": where_pictures.first_picture(content.curves),
        }
        for name, figure in drawn.items():
            for suffix in FORMATS:
                style.save(figure, place / f"{name}.{suffix}")
    write_host(content.model, content.gap, place / "host.csv")
    write_text(place / "verdict.md", words.verdict_text(with_optional(content.gap)))


def _residual(content: Content, place: Path) -> Figure:
    if not content.hold_out:
        raise InputError(f"{place / 'holdout'}: no tables; expected one a record")
    (table,) = pictures.worst(content.hold_out, 1)
    figure = Figure(figsize=(style.PAGE, 2.3))
    pictures.residual(figure.subplots(1, 2), table)
    return figure

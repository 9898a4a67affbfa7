"""The pictures of where the gap is: what curves.json holds, drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from hystbench.errors import InputError
from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE,
    VERMILION,
    legend_above,
    unit_text,
)
from hystbench.gap.report.pictures import BARS, EmbeddedPicture, bars, draw, logarithmic

Content = Mapping[str, Any]
LEVELS = "levels"
"""Name of the picture of modes by level."""

#: Colour, line and mark of what a series is.
LOOKS: dict[str, tuple[str, str, str]] = {
    "measurement": (BLUE, "none", "."),
    "simulation": (GREY, "-", ""),
    "residual": (VERMILION, "-", ""),
    "linear part": (BLUE, "--", ""),
    "noise": (BLACK, ":", ""),
    "right": (BLACK, "--", ""),
    "rising": (BLUE, "-", ""),
    "falling": (ORANGE, "--", ""),
    "first": (BLUE, "-", "o"),
    "second": (VERMILION, "--", "s"),
    "first by width": (BLUE, "none", "o"),
    "second by width": (VERMILION, "none", "s"),
    "own lines": (BLUE, "none", "o"),
    "odd lines": (ORANGE, "none", "^"),
    "even lines": (VERMILION, "none", "s"),
    "other lines": (GREEN, "none", "D"),
}
#: Series whose marks are hollow, as others lie on them.
HOLLOW = ("first by width", "second by width")
#: Inches of a row of panels: by what they show.
ROW_INCHES, MAP_INCHES, LEAST_INCHES, BAR_INCHES = 2.4, 3.2, 0.8, 0.18


def pictures_of(curves: Content) -> tuple[list[EmbeddedPicture], list[str]]:
    """Draw the pictures that curves.json holds, and tell which it has not and why.

    Raises
    ------
    InputError
        If it holds something else.
    """
    try:
        return [_drawn(one) for one in curves["pictures"]], list(curves["not_drawn"])
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"curves.json: {error} in a picture; expected what hystbench gap writes"
        ) from error


def first_picture(curves: Content) -> Figure:
    """Draw how modes move with the level where that is seen, else the first picture."""
    pictures = curves["pictures"]
    levels = [one for one in pictures if one["name"] == LEVELS]
    picture = (*levels, *pictures)[0]
    panels = picture["panels"]
    figure = Figure(figsize=(PAGE, max(map(_height, panels))))
    _fill(figure.subplots(1, len(panels), squeeze=False)[0], picture)
    return figure


def _drawn(picture: Content) -> EmbeddedPicture:
    panels = picture["panels"]
    tall = max(_height(panel) for panel in panels)
    return draw(
        lambda axes: _fill(axes, picture),
        words=picture["words"],
        height=tall,
        panels=(1, len(panels)),
    )


def _fill(axes: Any, picture: Content) -> None:
    for panel, content in zip(axes, picture["panels"], strict=True):
        _paint(panel, content)
    handles = {
        label: handle
        for panel in axes
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)
        if label
    }
    if handles:
        legend_above(axes[0].figure, list(handles.values()))


def _height(panel: Content) -> float:
    if panel["cells"]:
        return MAP_INCHES
    if panel["bars"]:
        return LEAST_INCHES + BAR_INCHES * min(len(panel["bars"]["names"]), BARS)
    return ROW_INCHES


def _paint(panel: Axes, content: Content) -> None:
    if content["cells"]:
        _cells(panel, content["cells"])
    if content["bars"]:
        values = numbers(content["bars"]["values"])
        order = np.argsort(-values, kind="stable")[:BARS]
        names = [content["bars"]["names"][k] for k in order]
        bars([panel], names, values[order], "", [BLUE] * len(order))
    for series in content["series"]:
        above = content["labelled_above"]
        _series(panel, series | {"label": ""} if above else series)
        if above:
            panel.annotate(
                series["label"],
                ((series["x"][0] + series["x"][-1]) / 2, 1),
                (0, 2),
                ("data", "axes fraction"),
                textcoords="offset points",
                fontsize=6,
                ha="center",
                rotation=90,
                parse_math=False,
            )
    for axis, about in (("x", content["x"]), ("y", content["y"])):
        if about["logarithmic"]:
            logarithmic(panel, axis)
    panel.set_xlabel(_label(content["x"]))
    panel.set_ylabel("" if content["bars"] else _label(content["y"]))
    panel.set_title(content["title"])


def _label(axis: Content) -> str:
    unit = axis["unit"]
    return f"{axis['name']} ({unit_text(unit)})" if unit else f"{axis['name']} (-)"


def _series(panel: Axes, series: Content) -> None:
    color, line, mark = LOOKS[series["role"]]
    look: dict[str, Any] = {"color": color, "linestyle": line, "marker": mark}
    look |= {"label": series["label"], "markersize": 4}
    if series["role"] in HOLLOW:
        look |= {"markerfacecolor": "none", "markersize": 8}
    x, y = numbers(series["x"]), numbers(series["y"])
    if series["error"] is None:
        panel.plot(x, y, **look)
    else:
        panel.errorbar(x, y, numbers(series["error"]), capsize=2, **look)


def _cells(panel: Axes, cells: Content) -> None:
    """Draw values over a plane in colours, zero white; rows of equal height."""
    values = np.array([numbers(row) for row in cells["values"]])
    most = float(np.nanmax(np.abs(values), initial=0.0)) or 1.0
    rows = np.arange(len(cells["rows"]))
    image = panel.pcolormesh(
        cells["columns"],
        rows,
        np.ma.masked_invalid(values),
        cmap="RdBu_r",
        norm=Normalize(-most, most),
    )
    panel.grid(visible=False)
    panel.set_facecolor("0.85")  # cells without samples, which white would call right
    minus = "−"  # noqa: RUF001  (as axes have it, not a hyphen)
    panel.set_yticks(rows, [f"{x:.3g}".replace("-", minus) for x in cells["rows"]])
    bar = panel.figure.colorbar(image, ax=panel, pad=0.02)
    bar.set_label(_label(cells["axis"]))
    bar.outline.set_visible(False)


def numbers(values: Any) -> Any:
    """Turn null into a gap of the line."""
    return np.array([np.nan if each is None else each for each in values], dtype=float)

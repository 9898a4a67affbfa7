"""The block diagram of a model with its effects, as a picture."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch
from matplotlib.path import Path

from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    PAGE,
    axis_label,
    keep_layout,
)
from hystbench.gap.report.diagram_layout import (
    NAME_LINE,
    NAME_POINTS,
    NUMBER_LINE,
    NUMBER_POINTS,
    PAD,
    RADIUS,
    Box,
    Line,
    Shape,
    Summation,
    layout,
)
from hystbench.gap.report.parts import Whose, in_one_line, stages
from hystbench.model import Model

#: Edge, face and width of the edge of a box, and what they mean. Added boxes differ by
#: their edges too.
LOOKS: dict[Whose, tuple[str, str, float, str]] = {
    "simulator": (GREY, "#F2F2F2", 0.8, "the simulator"),
    "added": (BLUE, "#E1EEF7", 1.6, "added by the search"),
    "put in": (ORANGE, "#FCF2DC", 1.6, "put in by you"),
}
DRAWN = {"color": BLACK, "linewidth": 0.8}
"""Look of a line."""
ARROW = "-|>,head_length=3.2,head_width=1.6"
KEY_INCHES = 0.24
"""Height of the line that says what the colours mean, in inches."""


def figure_of(model: Model, gap: Mapping[str, Any]) -> Figure:
    """Draw a model as a block diagram, each effect in its place.

    Parameters
    ----------
    model : Model
        With its effects.
    gap : mapping
        What gap.json holds, which tells the effects from the simulator.

    Returns
    -------
    Figure
        As wide as a page.
    """
    found = stages(model, gap)
    diagram = layout(found, axis_label(model.input), axis_label(model.output), PAGE)
    size = (diagram.width, diagram.height + KEY_INCHES)
    figure = Figure(figsize=size)
    keep_layout(figure)  # all is in its place
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(0.0, diagram.width)
    axes.set_ylim(-KEY_INCHES, diagram.height)
    _paint(axes, diagram.shapes)
    _key(axes, {part.whose for stage in found for part in stage.parts})
    return figure


def words_of(model: Model, gap: Mapping[str, Any]) -> str:
    """Tell the diagram in words."""
    return f"Block diagram: {in_one_line(model, stages(model, gap))}"


def _paint(axes: Axes, shapes: Sequence[Shape]) -> None:
    """Draw what was laid out, larger boxes first: they may hold others."""
    boxes = [one for one in shapes if isinstance(one, Box)]
    for box in sorted(boxes, key=lambda box: -box.width * box.height):
        _box(axes, box)
    for one in shapes:
        if isinstance(one, Line):
            _line(axes, one)
        elif isinstance(one, Summation):
            _sum(axes, one)


def _frame(
    axes: Axes, x: float, y: float, width: float, height: float, whose: Whose
) -> None:
    edge, face, thick, _ = LOOKS[whose]
    style = "round,pad=0,rounding_size=0.04"
    look: dict[str, Any] = {"edgecolor": edge, "facecolor": face, "linewidth": thick}
    axes.add_patch(FancyBboxPatch((x, y), width, height, boxstyle=style, **look))


def _box(axes: Axes, box: Box) -> None:
    y = box.y + box.height
    if box.whose is not None:  # else a label, which has no edge
        _frame(axes, *box[:4], box.whose)
        y -= PAD
    for lines, size, step in (
        (box.words, NAME_POINTS, NAME_LINE),
        (box.numbers, NUMBER_POINTS, NUMBER_LINE),
    ):
        for text in lines:
            _text(axes, box.x + box.width / 2, y - step / 2, text, size)
            y -= step


def _text(axes: Axes, x: float, y: float, text: str, size: float) -> None:
    # A name of the user's may hold what matplotlib would take for a formula.
    axes.text(x, y, text, fontsize=size, ha="center", va="center", parse_math=False)


def _line(axes: Axes, line: Line) -> None:
    style = ARROW if line.arrow else "-"
    look: dict[str, Any] = {"mutation_scale": 1.0, "joinstyle": "miter", **DRAWN}
    axes.add_patch(FancyArrowPatch(path=Path(line.points), arrowstyle=style, **look))


def _sum(axes: Axes, item: Summation) -> None:
    edge: dict[str, Any] = {"edgecolor": BLACK, "linewidth": 0.8, "zorder": 3}
    axes.add_patch(Circle((item.x, item.y), RADIUS, facecolor="white", **edge))
    arm = 0.55 * RADIUS
    look: dict[str, Any] = {**DRAWN, "zorder": 4}
    axes.add_line(Line2D((item.x - arm, item.x + arm), (item.y, item.y), **look))
    axes.add_line(Line2D((item.x, item.x), (item.y - arm, item.y + arm), **look))
    if item.minus:  # what comes from below is subtracted
        x, y = item.x + 1.2 * RADIUS, item.y - 1.7 * RADIUS
        axes.add_line(Line2D((x, x + 1.2 * arm), (y, y), **look))


def _key(axes: Axes, there: Collection[Whose]) -> None:
    """Say below the diagram whose each colour is."""
    x = PAD
    for whose in (each for each in LOOKS if each in there):
        _frame(axes, x, -0.17, 0.16, 0.1, whose)
        axes.text(
            x + 0.22, -0.12, LOOKS[whose][-1], fontsize=NUMBER_POINTS, va="center"
        )
        x += 1.5

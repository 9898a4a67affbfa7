"""Where the boxes, lines and sums of a block diagram are, in inches.

A group is a piece of the diagram: the signal enters it at (0, 0) and leaves it at
(width, 0). Each function puts something around a group and gives the larger group, so
that a force inside a mechanism that has other modes beside it needs no rule of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from textwrap import wrap
from typing import NamedTuple

from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

from hystbench.gap.report.parts import Part, Stage, Whose

#: Type of names and of numbers (points), and the height of a line (inches).
NAME_POINTS, NUMBER_POINTS = 8.0, 7.0
NAME_LINE, NUMBER_LINE = 0.15, 0.13
#: Letters of a line, at most: longer words are broken.
NAME_LETTERS, NUMBER_LETTERS = 18, 24

PAD = 0.07
"""Distance between a box and what stands in it."""
RADIUS = 0.07
"""Radius of the circle where signals are summed."""
LEAD = 0.2
"""Length of a line with an arrow."""
STUB = 0.1
"""Length of a line without one."""
SPACE = 0.12
"""Distance between boxes above one another."""
ROWS = 0.22
"""Half the distance between rows: a line runs in the middle."""
MARGIN = 0.06


Point = tuple[float, float]


class Box(NamedTuple):
    """A box with words and numbers below each other, from its upper edge on."""

    x: float
    y: float
    """Its left lower corner."""
    width: float
    height: float
    words: tuple[str, ...]
    numbers: tuple[str, ...] = ()
    """Lines of text."""
    whose: Whose | None = None
    """None of what has no edge: a label."""


class Summation(NamedTuple):
    """A circle where signals are summed.

    With ``minus`` what comes from below is subtracted.
    """

    x: float
    y: float
    minus: bool = False


class Line(NamedTuple):
    """A line through points; with an arrow at its end or without."""

    points: tuple[Point, ...]
    arrow: bool = False


Shape = Box | Summation | Line


class Diagram(NamedTuple):
    """A whole diagram, in inches from its left lower corner."""

    width: float
    height: float
    shapes: tuple[Shape, ...]


class _Group(NamedTuple):
    """A piece that the signal passes from (0, 0) to (width, 0).

    ``up`` and ``down`` are how far it reaches; ``arrow`` is whether a line may end at
    (0, 0) with an arrow: at the edge of a box it may, where lines part it may not.
    """

    width: float
    up: float
    down: float
    shapes: tuple[Shape, ...]
    arrow: bool = True

    def at(self, x: float, y: float = 0.0) -> tuple[Shape, ...]:
        """Give what it is drawn of, moved to the right and up."""
        return _moved(self.shapes, x, y)


def _moved(shapes: Sequence[Shape], x: float, y: float) -> tuple[Shape, ...]:
    return tuple(
        Line(tuple((a + x, b + y) for a, b in one.points), one.arrow)
        if isinstance(one, Line)
        else one._replace(x=one.x + x, y=one.y + y)
        for one in shapes
    )


def text_width(text: str, size: float) -> float:
    """Tell how wide a line of text is, in inches, for type of some points."""
    # A name of the user's may hold what matplotlib would take for a formula.
    width, *_ = text_to_path.get_text_width_height_descent(
        text, FontProperties(size=size), ismath=False
    )
    return float(width) / 72


def layout(stages: Sequence[Stage], source: str, output: str, page: float) -> Diagram:
    """Lay a diagram out: from left to right, in as many rows as its width asks for.

    Parameters
    ----------
    stages : sequence of Stage
    source, output : str
        What stands where the signal comes in and goes out.
    page : float
        Width of the diagram, in inches.

    Returns
    -------
    Diagram
    """
    groups = [_label(source), *map(_group, stages), _label(output)]
    rows = _rows(groups, page - 2 * (MARGIN + STUB))
    drawn: tuple[Shape, ...] = ()
    below = 0.0
    ends: list[tuple[Point, Point, float]] = []
    for k, row in enumerate(rows):
        middle = below - (2 * ROWS if k else 0.0) - max(group.up for group in row)
        # A single row stands in the middle of the page, several begin below another.
        width = _width(row)
        x = MARGIN + STUB if len(rows) > 1 else (page - width) / 2
        drawn += _series(row).at(x, middle)
        ends.append(((x, middle), (x + width, middle), below - ROWS))
        below = middle - max(group.down for group in row)
    for ((_, last, _), (first, _, between)), row in zip(
        pairwise(ends), rows[1:], strict=True
    ):
        way = (
            last,
            (last[0] + STUB, last[1]),
            (last[0] + STUB, between),
            (MARGIN, between),
            (MARGIN, first[1]),
            first,
        )
        drawn += (Line(way, row[0].arrow),)
    height = 2 * MARGIN - below
    return Diagram(page, height, _moved(drawn, 0.0, height - MARGIN))


def _rows(groups: Sequence[_Group], most: float) -> list[list[_Group]]:
    """Fill rows from the left; a group that is wider than all has one to itself."""
    rows: list[list[_Group]] = [[]]
    for group in groups:
        if rows[-1] and _width([*rows[-1], group]) > most:
            rows.append([])
        rows[-1].append(group)
    return rows


def _width(row: Sequence[_Group]) -> float:
    return sum(group.width for group in row) + LEAD * (len(row) - 1)


def _series(row: Sequence[_Group]) -> _Group:
    """Put groups behind one another."""
    drawn, x = row[0].shapes, row[0].width
    for group in row[1:]:
        way = Line(((x, 0.0), (x + LEAD, 0.0)), group.arrow)
        drawn += (way, *group.at(x + LEAD))
        x += LEAD + group.width
    up, down = (max(getattr(group, key) for group in row) for key in ("up", "down"))
    return _Group(x, up, down, drawn, row[0].arrow)


def _group(stage: Stage) -> _Group:
    """Lay out a block, then what is attached to it, from the inside out."""
    group = _core(stage.core, stage.within)
    if stage.spilt is not None:
        group = _with_spill(group, stage.spilt, stage.caught)
    for part in stage.around:
        group = _with_frame(group, part)
    if stage.fed_back:
        group = _with_feedback(group, stage.fed_back)
    return _with_beside(group, stage.beside) if stage.beside else group


def _label(text: str) -> _Group:
    words = _lines(text, NAME_LETTERS)
    width = max(text_width(line, NAME_POINTS) for line in words)
    height = NAME_LINE * len(words)
    label = Box(STUB / 2, -height / 2, width, height, words)
    return _Group(width + STUB, height / 2, height / 2, (label,))


def _lines(text: str, letters: int) -> tuple[str, ...]:
    return tuple(wrap(text, letters, break_on_hyphens=False)) or ("",)


def _box(part: Part) -> Box:
    """Give a part its box, its left lower corner at (0, 0)."""
    words = _lines(part.words, NAME_LETTERS)
    numbers = tuple(
        line for text in part.numbers for line in _lines(text, NUMBER_LETTERS)
    )
    widths = [text_width(line, NAME_POINTS) for line in words]
    widths += [text_width(line, NUMBER_POINTS) for line in numbers]
    height = NAME_LINE * len(words) + NUMBER_LINE * len(numbers) + 2 * PAD
    width = max(widths) + 2 * PAD
    return Box(0.0, 0.0, width, height, words, numbers, part.whose)


def _core(part: Part, within: Sequence[Part]) -> _Group:
    """Put a block on the signal's way; effects that are its numbers stand in it."""
    box, inner = _box(part), [_box(item) for item in within]
    width = max([box.width, *(item.width + 2 * PAD for item in inner)])
    height = box.height + sum(item.height + PAD for item in inner)
    drawn = [box._replace(width=width, height=height, y=-height / 2)]
    top = height / 2 - box.height
    for item in inner:
        x = (width - item.width) / 2
        drawn.append(item._replace(x=x, y=top - item.height))
        top -= item.height + PAD
    return _Group(width, height / 2, height / 2, tuple(drawn))


def _with_frame(group: _Group, part: Part) -> _Group:
    """Draw a box around a group, its words above what it holds."""
    box = _box(part)
    width = max(group.width + 2 * STUB, box.width)
    left = (width - group.width) / 2
    up, down = group.up + box.height, group.down + PAD
    drawn = (
        box._replace(width=width, height=up + down, y=-down),
        Line(((0.0, 0.0), (left, 0.0)), group.arrow),
        Line(((left + group.width, 0.0), (width, 0.0))),
    )
    return _Group(width, up, down, drawn + group.at(left), arrow=False)


def _with_feedback(group: _Group, parts: Sequence[Part]) -> _Group:
    """Draw a loop below a group: what it gives comes back and is subtracted."""
    back = [_core(part, ()) for part in parts]
    # The loop is as wide as its boxes ask for; the group stands in its middle.
    inner = max(group.width, LEAD + max(one.width for one in back))
    start = RADIUS
    left = start + RADIUS + LEAD + (inner - group.width) / 2
    end = start + RADIUS + LEAD + inner + STUB
    width = end + STUB
    loop, reach = _branches(back, end, start, -group.down)
    ways = (
        Line(((start + RADIUS, 0.0), (left, 0.0)), group.arrow),
        Line(((left + group.width, 0.0), (width, 0.0))),
        Summation(start, 0.0, minus=True),
    )
    return _Group(width, group.up, -reach, group.at(left) + ways + loop)


def _with_beside(group: _Group, stages: Sequence[Stage]) -> _Group:
    """Draw branches above a group: they have its input, and are added to its output."""
    beside = [_group(stage) for stage in stages]
    inner = max(group.width, *(one.width for one in beside))
    left = STUB + LEAD + (inner - group.width) / 2
    end = STUB + LEAD + inner + LEAD + RADIUS
    above, reach = _branches(beside, STUB, end, group.up)
    drawn = (
        *group.at(left),
        Line(((0.0, 0.0), (left, 0.0)), group.arrow),
        Line(((left + group.width, 0.0), (end - RADIUS, 0.0)), arrow=True),
        Summation(end, 0.0),
    )
    return _Group(end + RADIUS, reach, group.down, drawn + above, arrow=False)


def _branches(
    groups: Sequence[_Group], tap: float, total: float, edge: float
) -> tuple[tuple[Shape, ...], float]:
    """Stack groups on ways from where a signal is tapped to where they are summed.

    The stack begins at ``edge`` from the signal's line; below zero it goes down. How
    far from the line it ends is given as well. Where the ways go back each group is a
    single box.
    """
    up = 1 if edge > 0 else -1
    onward = 1 if total > tap else -1
    drawn: list[Shape] = []
    before = 0.0
    for k, group in enumerate(groups):
        inward, outward = (group.down, group.up)[::up]
        middle = edge + up * (SPACE + inward)
        x = (tap + total - group.width) / 2
        near, far = (x, x + group.width)[::onward]
        ways: list[tuple[Point, ...]] = [((tap, before), (tap, middle), (near, middle))]
        head = (total, before + up * RADIUS)
        if k == len(groups) - 1:
            ways.append(((far, middle), (total, middle), head))
        else:  # what comes from further out is added first
            ways.append(((far, middle), (total - onward * RADIUS, middle)))
            ways.append(((total, middle - up * RADIUS), head))
            drawn.append(Summation(total, middle))
        drawn += group.at(x, middle)
        into, *on = ways
        drawn += [Line(into, group.arrow), *(Line(way, arrow=True) for way in on)]
        edge, before = middle + up * outward, middle
    return tuple(drawn), edge


def _with_spill(group: _Group, part: Part, caught: bool) -> _Group:
    """Draw what leaves a full store above it; what is caught joins its output."""
    box = _box(part)
    inner = max(group.width, box.width)
    left, x = (inner - group.width) / 2, (inner - box.width) / 2
    foot = group.up + LEAD
    middle = foot + box.height / 2
    drawn = [
        *group.at(left),
        box._replace(x=x, y=foot),
        Line(((inner / 2, group.up), (inner / 2, foot)), arrow=True),
    ]
    if left:
        drawn.append(Line(((0.0, 0.0), (left, 0.0)), arrow=True))
    up, out, end = foot + box.height, left + group.width, inner
    if caught:
        end = inner + LEAD + RADIUS
        drawn += [
            Line(((out, 0.0), (end - RADIUS, 0.0)), arrow=True),
            Line(((x + box.width, middle), (end, middle), (end, RADIUS)), arrow=True),
            Summation(end, 0.0),
        ]
        end += RADIUS
    elif left:
        drawn.append(Line(((out, 0.0), (inner, 0.0))))
    return _Group(end, up, group.down, tuple(drawn), arrow=not left)

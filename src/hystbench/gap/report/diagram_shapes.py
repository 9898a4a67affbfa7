"""What a block diagram is drawn of: boxes, lines, sums and labels, in inches."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TypeVar

from hystbench.gap.report.parts import Whose

#: Type of names and of numbers (points), and the height of a line (inches).
NAME, NUMBER = 8.0, 7.0
NAME_LINE, NUMBER_LINE = 0.15, 0.13
#: Letters of a line, at most: longer words are broken.
NAME_LETTERS, NUMBER_LETTERS = 18, 24
#: Widths of letters, in times of the type's size. Most are narrower than this says.
NARROW, USUAL, BROAD = 0.42, 0.67, 1.0
_NARROW, _BROAD = frozenset("ijltfrI.,:;'|()[]/- ·"), frozenset("mwMWOQ@%&")

PAD = 0.07
"""Between a box and what stands in it."""
RADIUS = 0.07
"""Of the circle where signals are summed."""

Point = tuple[float, float]


@dataclass(frozen=True)
class Box:
    """A box with words and numbers below each other, from its upper edge on.

    Parameters
    ----------
    x, y : float
        Its left lower corner.
    width, height : float
    words, numbers : tuple of str
        Lines of text.
    whose : {"simulator", "added", "put in"}
    """

    x: float
    y: float
    width: float
    height: float
    words: tuple[str, ...]
    numbers: tuple[str, ...]
    whose: Whose


@dataclass(frozen=True)
class Line:
    """A line through points; with an arrow at its end or without."""

    points: tuple[Point, ...]
    arrow: bool = False


@dataclass(frozen=True)
class Sum:
    """A circle where signals are summed.

    With ``minus`` what comes from below is subtracted.
    """

    x: float
    y: float
    minus: bool = False


@dataclass(frozen=True)
class Label:
    """Lines of text without a box, in the middle of a width."""

    x: float
    y: float
    width: float
    words: tuple[str, ...]


Placed = TypeVar("Placed", Box, Sum, Label)


@dataclass(frozen=True)
class Drawn:
    """What is drawn, anywhere."""

    boxes: tuple[Box, ...] = ()
    lines: tuple[Line, ...] = ()
    sums: tuple[Sum, ...] = ()
    labels: tuple[Label, ...] = ()

    def moved(self, x: float, y: float) -> Drawn:
        """Move all to the right and up."""

        def placed(items: tuple[Placed, ...]) -> tuple[Placed, ...]:
            return tuple(replace(one, x=one.x + x, y=one.y + y) for one in items)

        lines = tuple(
            replace(line, points=tuple((a + x, b + y) for a, b in line.points))
            for line in self.lines
        )
        return Drawn(placed(self.boxes), lines, placed(self.sums), placed(self.labels))

    def __add__(self, other: Drawn) -> Drawn:
        """Draw both."""
        names = (field.name for field in fields(self))
        return Drawn(*(getattr(self, name) + getattr(other, name) for name in names))


@dataclass(frozen=True)
class Diagram:
    """A whole diagram, in inches from its left lower corner."""

    width: float
    height: float
    drawn: Drawn


def text_width(text: str, size: float) -> float:
    """Tell how wide a line of text is at most, in inches, for type of some points."""
    letters = (
        NARROW if letter in _NARROW else BROAD if letter in _BROAD else USUAL
        for letter in text
    )
    return sum(letters) * size / 72

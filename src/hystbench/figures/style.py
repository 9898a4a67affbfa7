"""How every figure looks, and how it is written: the same bytes each time."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from itertools import cycle, pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator, ScalarFormatter
from numpy.typing import ArrayLike

from hystbench import published
from hystbench.errors import refuse_unknown
from hystbench.files import atomic_path
from hystbench.record import Channel, FloatArray

#: Widths of a journal's column and page (inches).
COLUMN = 3.5
PAGE = 7.2

#: Colours that the colour-blind can tell apart: M. Okabe, K. Ito, "Color universal
#: design", 2008; https://jfly.uni-koeln.de/color/. Grey stands behind a model's line.
BLACK = "#000000"
GREY = "#999999"
ORANGE = "#E69F00"
GREEN = "#009E73"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
SKY = "#56B4E9"

_STYLE = Path(__file__).with_name("hystbench.mplstyle")
_METADATA: dict[str, dict[str, None]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
}


@dataclass(frozen=True)
class Look:
    """Name and line of a model, the same in every figure."""

    label: str
    color: str
    dashes: str | tuple[int, tuple[float, ...]]
    marker: str

    @property
    def line(self) -> dict[str, Any]:
        """Keywords for a line."""
        return {"label": self.label, "color": self.color, "linestyle": self.dashes}

    @property
    def marked(self) -> dict[str, Any]:
        """Keywords for a line with markers."""
        return {**self.line, "marker": self.marker}


#: The paper's models, in the order of its tables.
PAPER = {
    "gpo": Look("GPO filter", BLUE, "-", "o"),
    "backlash": Look("backlash filter", ORANGE, (0, (5, 1.5)), "s"),
    "volterra": Look("Volterra filter", GREEN, (0, (5, 1.5, 1, 1.5)), "^"),
    "delayed": Look("delayed filter", VERMILION, (0, (1, 1.2)), "D"),
    "rdgpi": Look("RDGPI model", PURPLE, (0, (3, 1.2, 1, 1.2, 1, 1.2)), "v"),
}

#: What the other filters take in turn. Seven colours and eight markers: no two of the
#: first 56 look the same, and no marker is one of the paper's models.
_COLORS = (SKY, BLACK, PURPLE, GREEN, ORANGE, VERMILION, BLUE)
_MARKERS = ("P", "X", "<", ">", "*", "p", "h", "d")
_DASHES = ((0, (7, 2)), (0, (2, 2)), (0, (7, 2, 2, 2)))

#: A record lies behind the models' lines, so that what they miss stands out.
BEHIND: dict[str, Any] = {"color": GREY, "linewidth": 2.6, "linestyle": "-"}
#: Where a run diverged.
DIVERGED: dict[str, Any] = {"marker": "x", "markersize": 5, "linestyle": "none"}


@contextmanager
def in_style() -> Iterator[None]:
    """Draw and save inside: matplotlib's defaults and ours, no user's own."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rc_file(_STYLE, use_default_template=False)
        yield


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG or SVG without date or version.

    The layout is made once: a second format of a figure shows it in the same places.

    Raises
    ------
    InputError
        If the suffix is neither.
    """
    refuse_unknown(path.suffix, _METADATA, f"{path}: {path.suffix!r} is no format")
    plain_ticks(figure)
    with atomic_path(path) as temporary:
        figure.savefig(temporary, metadata=_METADATA[path.suffix])
    keep_layout(figure)


def keep_layout(figure: Figure) -> None:
    """Let a figure stay as it is laid out.

    It has no layout engine then. With the one that ``"none"`` gives, matplotlib would
    draw all twice, the first time for nothing.
    """
    off: Any = {"figure.constrained_layout.use": False, "figure.autolayout": False}
    with mpl.rc_context(off):
        figure.set_layout_engine(None)


class _PlainTicks(ScalarFormatter):
    """Plain numbers at the ticks; the power of ten that they share is typeset."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        number = super().__call__(x, pos)
        return number.removeprefix(r"$\mathdefault{").removesuffix("}$")


DECADES = 1000.0
"""Axes that span so much need no marks between the decades."""


def plain_ticks(figure: Figure) -> None:
    """Write the numbers of linear axes as plain text, and no small marks on wide axes.

    Matplotlib would parse each number as a formula, which takes a quarter of a page's
    time. Another quarter goes to marks between decades, where decades are enough.
    """
    for axes in figure.axes:
        for axis, (low, high) in (
            (axes.xaxis, axes.get_xlim()),
            (axes.yaxis, axes.get_ylim()),
        ):
            if axis.get_scale() == "log" and high >= DECADES * low:
                axis.set_minor_locator(NullLocator())
            if type(axis.get_major_formatter()) is ScalarFormatter:
                axis.set_major_formatter(_PlainTicks())


def unit_text(unit: str) -> str:
    """Write a unit as it is printed: ``um^2`` and ``um2`` as µm²."""
    micro = re.sub(r"\bu(?=[A-Z]|[gms]\b|[gms]\^?\d)", "µ", unit)
    return re.sub(
        r"(?<=[A-Za-z])\^?([23])\b", lambda match: "²³"[int(match[1]) - 2], micro
    )


def axis_label(channel: Channel) -> str:
    """Label an axis with a channel's name and unit."""
    return f"{channel.name} ({unit_text(channel.unit)})"


def signal_title(name: str) -> str:
    """Write the name of a signal of the paper in words; others stay as they are."""
    patterns = {
        r"sine-0*(\d+)hz": r"\1 Hz sine",
        r"chirp-(\d+)-(\d+)hz": r"\1 to \2 Hz chirp",
        r"multisine-random-(\d+)-(\d+)hz": r"random sum, \1 to \2 Hz",
        r"multisine-([\d-]+)hz": r"sum of \1 Hz",
    }
    for pattern, words in patterns.items():
        if match := re.fullmatch(pattern, name):
            text = match.expand(words)
            return text.replace("-", ", ") if text.startswith("sum") else text
    return name


@cache
def looks() -> dict[str, Look]:
    """Give the look of every model: the paper's first, then the others by name."""
    from hystbench.filters import registry  # late: most figures show the paper's alone

    found = dict(PAPER)
    added = {name: item for name, item in registry().items() if name not in PAPER}
    turns = zip(added.items(), cycle(_COLORS), cycle(_DASHES), cycle(_MARKERS))
    for (name, item), color, dashes, marker in turns:
        found[name] = Look(item.label, color, dashes, marker)
    return found


def look(model: str) -> Look:
    """Give the look of a model.

    Raises
    ------
    InputError
        If there is no such model.
    """
    known = PAPER if model in PAPER else looks()
    refuse_unknown(model, known, f"no model {model!r}")
    return known[model]


def in_order(models: Iterable[str]) -> list[str]:
    """Put models in the order of the paper's tables, others by name, each once."""
    there = published.in_order(models)
    for model in there:
        look(model)
    return there


def handles(
    models: Iterable[str], *, marked: bool = False, diverged: bool = False
) -> list[Line2D]:
    """Make the legend of models: lines, or marked lines; and what a cross is."""
    looks = [look(model) for model in in_order(models)]
    lines = [Line2D([], [], **(each.marked if marked else each.line)) for each in looks]
    if diverged:
        lines.append(Line2D([], [], color=BLACK, label="diverged", **DIVERGED))
    return lines


def key(label: str, **line: Any) -> Line2D:
    """Make an entry of a legend."""
    return Line2D([], [], label=label, **line)


def name_rows(axes: Axes, names: Sequence[str], *, ruled: bool = True) -> None:
    """Name rows on the vertical axis, the first above, with lines between them."""
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    for edge in range(1, len(names) if ruled else 0):
        axes.axhline(edge - 0.5, color=GREY, linewidth=0.4)


def in_row(index: int, count: int, spread: float) -> float:
    """Place one of several marks in a row, off its middle, over a part of the row."""
    return (index - (count - 1) / 2) * spread / count


def logarithmic(axes: Axes, subs: Sequence[float] = (1.0,)) -> None:
    """Make the horizontal axis logarithmic, with plain numbers at these multiples."""
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=subs))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("")


def mark_above(axes: Axes, x: ArrayLike, color: str) -> None:
    """Mark a divergence below the upper edge: it has no value to stand at."""
    y = np.full(np.shape(x), 0.95)
    axes.plot(x, y, color=color, transform=axes.get_xaxis_transform(), **DIVERGED)


def letter(axes: Sequence[Axes]) -> None:
    """Letter panels (a), (b), ... before their titles; a single one has no letter."""
    for index, panel in enumerate(axes if len(axes) > 1 else ()):
        title = panel.get_title(loc="left")
        panel.set_title(f"({chr(ord('a') + index)}) {title}".rstrip(), loc="left")


def legend_above(figure: Figure, handles: Sequence[Line2D], columns: int = 0) -> None:
    """Put one legend above all panels, where it hides no data."""
    figure.legend(
        handles=list(handles),
        loc="outside upper center",
        ncols=columns or len(handles),
    )


def thin(
    x: FloatArray, y: FloatArray, bins: int = 2000
) -> tuple[FloatArray, FloatArray]:
    """Keep the smallest and the largest sample of each bin, as they are.

    With more bins than a printer has dots the line looks the same, and an SVG file
    stays small.
    """
    if len(x) <= 2 * bins:
        return x, y
    edges = np.linspace(0, len(x), bins + 1).astype(int)
    kept = {0, len(x) - 1}
    for low, high in pairwise(edges):
        part = y[low:high]
        kept |= {low + int(part.argmin()), low + int(part.argmax())}
    index = np.array(sorted(kept))
    return x[index], y[index]

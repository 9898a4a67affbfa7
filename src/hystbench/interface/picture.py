"""Figures as a notebook shows them."""

import io
from collections.abc import Callable
from typing import Any

from matplotlib.figure import Figure

from hystbench.figures.style import PAGE, in_style, plain_ticks

RESOLUTION = 130
"""Dots an inch in a notebook."""


class Picture(Figure):
    """A figure that a notebook shows by itself, once, whatever its backend is.

    It belongs to no window; ``savefig`` writes it to a file.
    """

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        with in_style():
            self.savefig(buffer, format="png", dpi=RESOLUTION, bbox_inches="tight")
        return buffer.getvalue()


def drawn(
    paint: Callable[[Any], None], rows: int, columns: int, height: float
) -> Picture:
    """Draw panels in hystbench's style.

    Parameters
    ----------
    paint : callable
        Given the axes, shape (rows, columns).
    rows, columns : int
    height : float
        Of a row, in inches.

    Returns
    -------
    Picture
    """
    with in_style():
        figure = Picture(figsize=(PAGE, height * rows), layout="constrained")
        paint(figure.subplots(rows, columns, squeeze=False))
        plain_ticks(figure)
        figure.draw_without_rendering()
    return figure

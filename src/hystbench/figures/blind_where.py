"""How often the first view shows where an effect is, at 20 dB."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures.shares import by_effect


def draw(*, table: Path) -> Figure:
    """Draw for each effect how often the first view is right and holds half its power.

    Parameters
    ----------
    table : Path
        ``effect, family, figure, share, low, high, cases``.
    """
    return by_effect(table, {"where_hit": "first view is the right one"})

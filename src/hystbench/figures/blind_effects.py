"""How often each effect is named, alone and first, at 20 dB."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from hystbench.figures.shares import by_effect


def draw(*, table: Path) -> Figure:
    """Draw for each effect how often it is named first, and named with nothing beside.

    Parameters
    ----------
    table : Path
        ``effect, family, figure, share, low, high, cases``.
    """
    return by_effect(
        table, {"top1": "named first", "exact": "named, and nothing beside it"}
    )

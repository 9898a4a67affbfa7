"""The residual over the plane of the input and its rate, for a picture."""

from __future__ import annotations

from typing import Any

import numpy as np

from hystbench.gap.locate.cells import cell_of
from hystbench.gap.locate.listed import listed
from hystbench.gap.locate.samples import Samples
from hystbench.record import FloatArray

COLUMNS = 18
"""Cells along the input, of one width."""
ROWS = 6
"""Cells along the rate's magnitude, for each sign, of about as many samples each.

Fewer where the input rests."""
FEWEST = 5
"""Samples of a cell that is shown: the mean of fewer is mostly noise."""


def over_plane(samples: Samples) -> dict[str, Any] | None:
    """Average the residual over cells of the input and of its rate together.

    What depends on both, as a loop that widens with rate and amplitude, shows neither
    over the input alone nor over the rate alone.

    Returns
    -------
    dict, optional
        ``input`` (edges of the cells), ``rate`` (edges, from the fastest falling to
        the fastest rising), ``mean`` (rows over the rate of columns over the input;
        None where a cell holds few samples) and ``share`` (of the gap's power above
        the noise that the cells' means hold: what any function of both could, that is
        as smooth as the cells are wide). None where the input never moves.
    """
    u, speed = samples.input, samples.speed
    rate = rate_edges(speed)
    if rate is None:
        return None
    columns = np.linspace(float(u.min()), float(u.max()), COLUMNS + 1)
    count = len(rate) - 1
    cell = cell_of(columns, u) * count + cell_of(rate, speed)
    held = np.bincount(cell, minlength=COLUMNS * count)
    total = np.bincount(cell, samples.residual, COLUMNS * count)
    enough = held >= FEWEST
    mean = np.where(enough, total / np.maximum(held, 1), 0.0)
    explained = float(held @ mean**2) / len(u)
    rows = np.where(enough, mean, np.nan).reshape(COLUMNS, count).T
    return {
        "input": listed(columns),
        "rate": listed(rate),
        "mean": [[None if np.isnan(x) else float(x) for x in row] for row in rows],
        "share": samples.share(explained, int(enough.sum())),
    }


def rate_edges(speed: FloatArray) -> FloatArray | None:
    """Give edges that are alike for both signs; fast records do not hide slow ones."""
    size = np.abs(speed)
    found = np.unique(np.quantile(size, np.linspace(0, 1, ROWS + 1)[1:]))
    found = found[found > 0]
    return np.concatenate([-found[::-1], [0.0], found]) if len(found) else None

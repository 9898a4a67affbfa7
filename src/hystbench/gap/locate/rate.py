"""The rate view: what grows with the speed of the input, nonlinearly."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.forms import fit_form, named_or, narrowest, p_value_of
from hystbench.gap.locate.picture import Axis, Cells, Panel, Picture, listed
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent
from hystbench.record import FloatArray

EXPONENTS = (0.25, 0.5, 1.0)
COLUMNS = 18
"""Cells of the map along the input, of one width."""
ROWS = 6
"""Cells along the rate's magnitude, for each sign, of about as many samples each.

Fewer where the input rests."""
FEWEST = 5
"""Samples of a cell that is shown: the mean of fewer is mostly noise."""


def rate(samples: ViewSamples) -> View:
    """Fit odd powers of the rate, alone and by the input's magnitude.

    The p-value is that of the odd powers.
    """
    top = max(float(np.max(np.abs(samples.speed))), 1e-300)
    speed, size = np.abs(samples.speed) / top, np.abs(samples.input) / samples.reach
    powers = [np.sign(samples.speed) * speed**exponent for exponent in EXPONENTS]
    wider = [power * factor for power in powers for factor in (1.0, size)]
    odd = fit_form(samples, "an odd function of the rate", powers)
    forms = [
        odd,
        fit_form(samples, "a loop that widens with rate and amplitude", wider),
    ]
    form = named_or(samples, "rate", forms)
    start, end = narrowest(np.abs(samples.speed), form.fitted**2)
    unit = f"{samples.units[0]}/s"
    share = samples.share(form.explained, form.freedom)
    plane = over_plane(samples)
    return View(
        view="rate",
        axis="magnitude of the input's rate",
        start=start,
        end=end,
        unit=unit,
        share_of_gap_power=share,
        p_value=p_value_of(samples, form, [odd]),
        sentence=(
            f"{percent(share)} of the gap is {form.words}; most of it lies where the "
            f"input moves at {number(start)} to {number(end)} {unit}."
        ),
        saved=form.saved,
        named=form.named,
        pictures=() if plane is None else (plane,),
        not_drawn=("the residual by rate, as the input rests",)
        if plane is None
        else (),
    )


def over_plane(samples: ViewSamples) -> Picture | None:
    """Average the residual over cells of the input and of its rate together.

    What depends on both, as a loop that widens with rate and amplitude, shows neither
    over the input alone nor over the rate alone. The share that is told is that of the
    gap's power that the cells' means hold.

    Returns
    -------
    Picture, optional
        None where the input never moves.
    """
    u, residual = samples.input, samples.residual
    rows = rate_edges(samples.speed)
    if rows is None:
        return None
    columns = np.linspace(float(u.min()), float(u.max()), COLUMNS + 1)
    at, edges = (u, samples.speed), (columns, rows)
    held, _, _ = np.histogram2d(*at, edges)
    total, _, _ = np.histogram2d(*at, edges, weights=residual)
    enough = held >= FEWEST
    mean = np.where(enough, total / np.maximum(held, 1), np.nan)
    explained = float(np.sum(held * np.nan_to_num(mean) ** 2)) / len(u)
    share = samples.share(explained, int(enough.sum()))
    given, made = samples.units
    cells = Cells(
        listed(columns),
        listed(rows),
        [listed(row) for row in mean.T],
        Axis("measured − simulated", made),  # noqa: RUF001  (a minus sign)
    )
    panel = Panel(
        Axis("input", given),
        Axis("rate of the input", f"{given}/s"),
        title="mean residual by the input and its rate",
        cells=cells,
    )
    words = (
        "How to read it: a cell shows by how much the measurement lies above (red) or "
        "below (blue) the simulation, in the mean, where the input had that value and "
        "moved at that rate; above zero it rises, below it falls; grey cells have few "
        f"samples. These cells hold {percent(share)} of the gap"
    )
    return Picture("over-plane", words, (panel,))


def rate_edges(speed: FloatArray) -> FloatArray | None:
    """Give edges that are alike for both signs; fast records do not hide slow ones."""
    size = np.abs(speed)
    found = np.unique(np.quantile(size, np.linspace(0, 1, ROWS + 1)[1:]))
    found = found[found > 0]
    return np.concatenate([-found[::-1], [0.0], found]) if len(found) else None

"""The view by level: how modes move when the input grows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import special

from hystbench.gap.locate.dominant import find_modes
from hystbench.gap.locate.forms import saved
from hystbench.gap.locate.lines import Lines, lines_of
from hystbench.gap.locate.mode import LINES, Mode, fit_mode
from hystbench.gap.locate.moving import Moving
from hystbench.gap.locate.picture import Axis, Panel, Picture, series
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, number, percent
from hystbench.gap.records.residual import Compared
from hystbench.quantities import quantity_of

APART = 1.2
"""Of two input levels, rms over rms, at least."""
FEWEST = 3
"""Levels that show how something moves."""
BLURRED = 0.5
"""Relative error of damping or gain above which there is no peak to speak of."""
MODES = 2
"""That are shown."""
NUMBERS = 8
"""Of a mode at a level: its pole, and three complex numbers of its band."""
INTEGRALS = {"position": 0, "velocity": 1, "acceleration": 2}
ROLES = (
    ("first", "first by width"),
    ("second", "second by width"),
)


def take_levels(samples: ViewSamples) -> tuple[Moving, ...]:
    """Fit the dominant modes at each level of the input.

    Returns
    -------
    tuple of Moving
        Empty where fewer than three levels have a broadband input, or no mode is seen
        at three of them.
    """
    levels = _levels(samples.compared)
    if len(levels) < FEWEST:
        return ()
    lines = [[lines_of(item) for item in level] for level in levels]
    inputs = np.array([np.mean([_rms(one) for one in level]) for level in levels])
    measured = quantity_of("output", samples.units[1])
    integrals = INTEGRALS.get(measured, 1)
    moving: list[Moving] = []
    # A clearance and friction matter least at the highest level, a spring at the
    # lowest: a mode is followed from the end where it explains more.
    ends = [(mode, k) for k in (0, -1) for mode in find_modes(lines[k], integrals)]
    for mode, end in sorted(ends, key=lambda item: item[0].left / item[0].held):
        fits = dict(_followed(lines, end, mode, integrals))
        if len(fits) >= FEWEST:
            places = sorted(fits)
            modes = tuple(fits[place] for place in places)
            one = Moving(inputs[places], modes, integrals, len(levels))
            if not any(_same(one, other) for other in moving):
                moving.append(one)
    moving.sort(key=lambda one: -sum(mode.held for mode in one.modes))
    return tuple(moving[:MODES])


def level(samples: ViewSamples) -> View | None:
    """Tell how modes move with the level.

    The share is what a mode of each level's own takes away of the gap within its band.
    The p-value is that of frequency, damping and gain being the same at every level.

    Returns
    -------
    View, optional
        None where no three levels of a broadband input show a mode.
    """
    moving = take_levels(samples)
    if not moving:
        return None
    inputs = moving[0].inputs
    total = len(samples.compared)
    explained = sum(m.missed - m.left for each in moving for m in each.modes) / total
    freedom = NUMBERS * sum(len(each.modes) for each in moving)
    chi_squares, freedoms = zip(*(each.chi_square for each in moving), strict=True)
    share = samples.share(explained, freedom)
    unit = samples.units[0]
    told = "; ".join(each.sentence for each in moving)
    return View(
        view="level",
        axis="rms of the input",
        start=float(inputs[0]),
        end=float(inputs[-1]),
        unit=unit,
        share_of_gap_power=share,
        p_value=float(special.chdtrc(sum(freedoms), sum(chi_squares))),
        sentence=(
            f"From {number(inputs[0])} to {number(inputs[-1])} {unit} rms of the input "
            f"{told}. A mode of each level's own takes away "
            f"{percent(share)} of the gap."
        ),
        saved=saved(samples, explained, freedom),
        pictures=(picture_of(moving, unit),),
    )


def picture_of(moving: Sequence[Moving], unit: str) -> Picture:
    """Draw how modes move with the input's level: frequency, damping, gain."""
    frequency, damping, gain = [], [], []
    for (role, by_width), mode in zip(ROLES, moving, strict=False):
        values, errors = mode.numbers, mode.errors * mode.numbers
        first, label = values[0], f"{values[0, 0]:.3g} Hz: {mode.kind}"
        change, size = 100 * (values[:, 0] / first[0] - 1), 100 / first[0]
        x = mode.inputs
        frequency.append(series(role, x, change, label, size * errors[:, 0]))
        damping += [
            series(role, x, 100 * values[:, 2], "", 100 * errors[:, 2]),
            series(by_width, x, 100 * values[:, 1], "width of the peak"),
        ]
        relative = values[:, 3] / first[3], errors[:, 3] / first[3]
        gain.append(series(role, x, relative[0], "", relative[1]))
    x_axis = Axis("rms of the input", unit)
    panels = (
        Panel(x_axis, Axis("change of frequency", "%"), tuple(frequency)),
        Panel(x_axis, Axis("damping ratio", "%"), tuple(damping)),
        Panel(x_axis, Axis("gain over the first"), tuple(gain)),
    )
    words = (
        "How modes move when the input grows; a linear device's stay. Damping is told "
        "by power: what the input puts in, over the mean square velocity; a curved "
        "spring widens the peak and leaves this alone. Bars: standard errors"
    )
    return Picture("levels", words, panels)


def _levels(compared: Sequence[Compared]) -> list[list[Compared]]:
    """Group records of a broadband input by its rms, the smallest first."""
    broad = [
        item for item in compared if int(np.sum(lines_of(item).excited)) >= 2 * LINES
    ]
    levels: list[list[Compared]] = []
    for item in sorted(broad, key=_rms):
        if levels and _rms(item) < APART * _rms(levels[-1][0]):
            levels[-1].append(item)
        else:
            levels.append([item])
    return levels


def _rms(item: Compared) -> float:
    return float(np.std(item.record.u))


def _followed(
    lines: Sequence[Sequence[Lines]], end: int, mode: Mode, integrals: int
) -> list[tuple[int, Mode]]:
    """Fit a mode at each level, each from its neighbour, as long as it has a peak."""
    order = range(len(lines))
    found = []
    for place in order if end == 0 else reversed(order):
        fitted = fit_mode(lines[place], mode.frequency, mode.damping, integrals)
        if fitted is not None and float(np.max(fitted.errors)) <= BLURRED:
            mode = fitted
            found.append((place, fitted))
    return found


def _same(one: Moving, other: Moving) -> bool:
    """Tell whether two starts led to one mode: they lie within its width anywhere."""
    place = np.searchsorted(other.inputs, one.inputs).clip(max=len(other.inputs) - 1)
    frequency, damping = other.numbers[place, :2].T
    return bool(np.any(np.abs(one.numbers[:, 0] - frequency) < damping * frequency))

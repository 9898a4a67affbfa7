"""The view by level: how modes move when the input grows, and the class that follows.

A linear device has the same modes at every level. What moves, and how, tells the class
of what is missing [1]_ [2]_.

References
----------
.. [1] K. Worden, G. R. Tomlinson, Nonlinearity in Structural Dynamics, IOP Publishing,
   2001, chapters 2 and 3.
.. [2] L. Lauwers, J. Schoukens, R. Pintelon, M. Enqvist, "A nonlinear block structure
   identification procedure using frequency response function measurements", IEEE Trans.
   Instrumentation and Measurement 57 (2008) 2257-2264.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from hystbench.gap.locate.forms import View, saved
from hystbench.gap.locate.level_classes import CLASSES
from hystbench.gap.locate.mode import (
    LEAST_LINES,
    LevelLines,
    Mode,
    find_modes,
    fit_mode,
    lines_of,
)
from hystbench.gap.locate.picture import Axis, Panel, ViewPicture, series
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.records.scored_samples import Compared
from hystbench.quantities import quantity_of
from hystbench.record import FloatArray
from hystbench.sentences import percent, shortly

SURE_ERRORS = 3.0
"""Standard errors by which a number has to move."""
LEAST_ERRORS = np.array([1e-4, 1e-2, 1e-2, 1e-2])
"""Smallest relative error of frequency, damping twice, and gain that is believed: from
one record to the next temperature alone moves them by as much."""
CLEARANCE_BEND = 0.75
"""Share of a rise in frequency squared that lies in the lower half of the mean square
of the motion: half of it of a cubic spring, next to all of it of a clearance."""


@dataclass(frozen=True)
class Moving:
    """A mode at several levels of the input, by the largest output, the least first.

    A sweep moves a mode farther than noise of the same rms does.
    """

    inputs: FloatArray
    """Shape (levels,). RMS of the input."""
    modes: tuple[Mode, ...]
    integrals: int
    """How often the output has to be integrated for a position."""
    levels: int
    """Levels that there are; at some of them the mode may have no peak."""

    @property
    def numbers(self) -> FloatArray:
        """Frequency, damping ratio of the pole, that by power, gain: (levels, 4)."""
        return np.array(
            [[m.frequency, m.damping, m.power_damping, m.gain] for m in self.modes]
        )

    @property
    def errors(self) -> FloatArray:
        """Relative standard errors of the numbers, shape (levels, 4)."""
        found = np.array([mode.errors for mode in self.modes])
        return np.asarray(np.maximum(found, LEAST_ERRORS))

    @property
    def told(self) -> tuple[FloatArray, FloatArray]:
        """Frequency, damping by power, gain; and their relative errors.

        The damping is a rate of decay, which no stiffness changes.
        """
        frequency, _, ratio, gain = self.numbers.T
        values = np.column_stack([frequency, ratio * frequency, gain])
        return values, self.errors[:, [0, 2, 3]]

    @property
    def moved(self) -> tuple[int, int, int]:
        """Whether frequency, damping and gain grow (1), fall (-1) or stay (0).

        By the level where each is farthest from the first, in standard errors.
        """
        values, errors = self.told
        # A value that noise made negative is next to nothing.
        size = np.log(np.maximum(values, 1e-3 * np.max(np.abs(values), axis=0)))
        away = (size - size[0]) / np.hypot(errors, errors[0])
        away[0] = 0.0
        most = away[np.argmax(np.abs(away), axis=0), range(3)]
        ways = np.where(np.abs(most) > SURE_ERRORS, np.sign(most), 0.0).astype(int)
        frequency, damping, gain = ways.tolist()
        return frequency, damping, gain

    @property
    def kind(self) -> str:
        """The class that follows from what moves."""
        frequency, damping, gain = self.moved
        if damping < 0 and not (frequency and self.springs):
            return "Coulomb friction"
        if frequency > 0:
            return "clearance" if self.bend > CLEARANCE_BEND else "hardening"
        if frequency < 0:
            return "micro-slip or hysteresis" if damping > 0 else "softening"
        if damping > 0:
            return "damping that grows with speed"
        return "a static curve before or behind" if gain else "none"

    @property
    def springs(self) -> bool:
        """Whether the stiffness changes by a larger factor than the damping.

        Sliding more freely makes no spring stiffer or softer; but of a motion that
        meets a stop, or of a spring that yields, the damping is not well known.
        """
        values, _ = self.told
        change = np.abs(
            np.log(np.maximum(values[-1], 1e-3 * values.max(axis=0)) / values[0])
        )
        return bool(2 * change[0] > change[1])

    @property
    def bend(self) -> float:
        """Share of the rise of frequency squared in the lower half of the motion."""
        frequency = self.numbers[:, 0]
        reach = np.array([mode.reach for mode in self.modes])
        motion = (reach / frequency**self.integrals) ** 2
        order = np.argsort(motion)
        motion, square = motion[order], frequency[order] ** 2
        middle = np.interp((motion[0] + motion[-1]) / 2, motion, square)
        return float((middle - square[0]) / (square[-1] - square[0]))

    @property
    def chi_square(self) -> tuple[float, int]:
        """How far all numbers are from the same at every level, and the freedom."""
        values, errors = self.told
        weights = errors**-2
        means = np.sum(weights * values, axis=0) / np.sum(weights, axis=0)
        away = np.sum(weights * (values / means - 1) ** 2)
        return float(away), 3 * (len(values) - 1)

    @property
    def sentence(self) -> str:
        """What moves by how much, and the class."""
        first, last = self.numbers[0], self.numbers[-1]
        errors = np.hypot(self.errors[0], self.errors[-1])
        frequency, damping, gain = self.moved
        changes = self.numbers[:, 0] / first[0] - 1
        most = int(np.argmax(changes * frequency if frequency else np.abs(changes)))
        change = 100 * float(changes[most])
        by = _with_error(abs(change), 100 * float(np.hypot(*self.errors[[0, most], 0])))
        moved = f"stays (it moves by {by} %)"
        if frequency:
            moved = f"{'rises' if frequency > 0 else 'falls'} by {by} %"
        rates = 2 * np.pi * self.told[0][:, 1]
        low, *_, high = (
            _with_error(rate, rate * float(error))
            for rate, error in zip(rates.tolist(), self.errors[:, 2], strict=True)
        )
        told = f"{low} to {high} 1/s"
        damped = f"{_verb(damping)} {told}" if damping else f"stays ({told})"
        ratio = _with_error(last[3] / first[3], last[3] / first[3] * float(errors[3]))
        held = f"its gain {_verb(gain)} 1 to {ratio}" if gain else "its gain stays"
        seen = len(self.modes)
        at = "" if seen == self.levels else f" ({seen} of {self.levels} levels)"
        return (
            f"the mode at {shortly(first[0])} Hz {moved}, its rate of decay {damped}, "
            f"{held}{at}: {CLASSES[self.kind][0]}"
        )


def _verb(way: int) -> str:
    return "grows from" if way > 0 else "falls from"


def _with_error(value: float, error: float) -> str:
    """Write a number and its standard error, which has one digit."""
    decimals = max(0, -int(np.floor(np.log10(max(error, 1e-9)))))
    return f"{value:.{decimals}f} ± {error:.{decimals}f}"


APART = 1.2
"""Least ratio of two input levels, rms over rms."""
LEAST_LEVELS = 3
"""Levels that show how something moves."""
BLURRED_ERROR = 0.5
"""Relative error of damping or gain above which there is no peak to speak of."""
MODES_SHOWN = 2
"""Modes that are shown."""
NUMBERS = 8
"""Numbers of a mode at a level: its pole, and three complex numbers of its band."""
INTEGRALS = {"position": 0, "velocity": 1, "acceleration": 2}
"""Integrals that lead from an output to a position."""
ROLES = (("first", "first by width"), ("second", "second by width"))
"""Roles of the lines of the first and the second mode."""


def take_levels(samples: ViewSamples) -> tuple[Moving, ...]:
    """Fit the dominant modes at each level of the input.

    Returns
    -------
    tuple of Moving
        Empty where fewer than three levels have a broadband input, or no mode is seen
        at three of them.
    """
    levels = _levels(samples.compared)
    if len(levels) < LEAST_LEVELS:
        return ()
    lines = [[lines_of(item) for item in level] for level in levels]
    inputs = np.array([np.mean([_rms(one) for one in level]) for level in levels])
    peaks = [max(float(np.ptp(one.record.y)) for one in level) for level in levels]
    measured = quantity_of("output", samples.units[1])
    integrals = INTEGRALS.get(measured, 1)
    moving: list[Moving] = []
    # A clearance and friction matter least at the highest level, a spring at the
    # lowest: a mode is followed from the end where it explains more.
    ends = [(mode, k) for k in (0, -1) for mode in find_modes(lines[k], integrals)]
    for mode, end in sorted(ends, key=lambda item: item[0].left / item[0].held):
        fits = dict(_followed(lines, end, mode, integrals))
        if len(fits) >= LEAST_LEVELS:
            places = sorted(fits, key=peaks.__getitem__)
            modes = tuple(fits[place] for place in places)
            one = Moving(inputs[places], modes, integrals, len(levels))
            if not any(_same(one, other) for other in moving):
                moving.append(one)
    moving.sort(key=lambda one: -sum(mode.held for mode in one.modes))
    return tuple(moving[:MODES_SHOWN])


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
    inputs = np.sort(moving[0].inputs)
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
            f"From {shortly(inputs[0])} to {shortly(inputs[-1])} {unit} rms of the "
            f"input {told}. A mode of each level's own takes away "
            f"{percent(share)} of the gap."
        ),
        saved=saved(samples, explained, freedom),
        pictures=(picture_of(moving, unit),),
        kinds=tuple(dict.fromkeys(each.kind for each in moving)),
    )


def picture_of(moving: Sequence[Moving], unit: str) -> ViewPicture:
    """Draw how modes move with the input's level: frequency, damping, gain."""
    frequency, damping, gain = [], [], []
    for (role, by_width), mode in zip(ROLES, moving, strict=False):
        first, label = mode.numbers[0], f"{mode.numbers[0, 0]:.3g} Hz: {mode.kind}"
        order = np.argsort(mode.inputs)
        values = mode.numbers[order]
        errors = mode.errors[order] * values
        change, size = 100 * (values[:, 0] / first[0] - 1), 100 / first[0]
        x = mode.inputs[order]
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
    return ViewPicture("levels", words, panels)


def _levels(compared: Sequence[Compared]) -> list[list[Compared]]:
    """Group records of a broadband input by its rms, the smallest first."""
    broad = [
        item for item in compared if np.sum(lines_of(item).excited) >= 2 * LEAST_LINES
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
    lines: Sequence[Sequence[LevelLines]], end: int, mode: Mode, integrals: int
) -> list[tuple[int, Mode]]:
    """Fit a mode at each level, each from its neighbour, as long as it has a peak."""
    order = range(len(lines))
    found = []
    for place in order if end == 0 else reversed(order):
        fitted = fit_mode(lines[place], mode.frequency, mode.damping, integrals)
        if fitted is not None and float(np.max(fitted.errors)) <= BLURRED_ERROR:
            mode = fitted
            found.append((place, fitted))
    return found


def _same(one: Moving, other: Moving) -> bool:
    """Tell whether two starts led to one mode: they lie within its width anywhere."""
    place = np.argmin(np.abs(other.inputs[:, None] - one.inputs), axis=0)
    frequency, damping = other.numbers[place, :2].T
    return bool(np.any(np.abs(one.numbers[:, 0] - frequency) < damping * frequency))

"""The records that a machine is tried with.

Commands are those of :mod:`hystbench.challenge.excitation`, whose nominal rate is
4 kHz: a machine that is sampled at another rate sees the same samples.
"""

from __future__ import annotations

import numpy as np

from hystbench.challenge.excitation import (
    FAST,
    Excitation,
    Function,
    add,
    chirp,
    multisine,
    sine,
    staircase,
)
from hystbench.challenge.excitation import PERIOD as NOMINAL_PERIOD

#: Samples of a record to fit, of one held out, and of a multisine's period.
FIT, HELD_OUT, PERIOD = 1500, 1000, 500


#: A multisine's nominal period is :data:`hystbench.challenge.excitation.PERIOD`.
_FASTER = NOMINAL_PERIOD / PERIOD


def _faster(function: Function) -> Function:
    return lambda t: function(_FASTER * t)


def _tones(
    random: np.random.Generator, low: float, high: float, peak: float
) -> Function:
    """Multisine whose period is five hundred samples."""
    return _faster(multisine(random, low / _FASTER, high / _FASTER, peak))


def _steps(
    random: np.random.Generator, count: int, seconds: float, edge: float
) -> Function:
    levels = random.uniform(0.3, 1.0, count) * (-1.0) ** np.arange(count)
    levels *= 0.9 / np.abs(levels).max()
    return staircase([float(level) for level in levels], seconds, edge)


def machine_records(
    random: np.random.Generator, middle: float
) -> tuple[Excitation, ...]:
    """Four records to fit and two held out, of levels up to about one.

    Parameters
    ----------
    random : numpy.random.Generator
    middle : float
        Frequency in Hz, at 4 kHz, about which the machine is to be moved.
    """
    low, high = middle / 6.0, 2.5 * middle

    def of(name: str, function: Function, period: int | None = None) -> Excitation:
        return Excitation(name, "fit", FAST, FIT, function, period)

    def held(name: str, function: Function) -> Excitation:
        return Excitation(name, "hold-out", FAST, HELD_OUT, function)

    edge = 0.2 / middle
    return (
        of("multisine-low", _tones(random, low, high, 0.35), PERIOD),
        of("multisine-high", _tones(random, low, high, 1.0), PERIOD),
        of("sweep", chirp(low, 2.0 * middle, 0.7, FIT / FAST)),
        of("steps", _steps(random, 10, FIT / FAST / 10, edge)),
        held("multisine-other", _tones(random, low, high, 0.85)),
        held(
            "two-tones",
            add(sine(0.37 * middle, 0.5), sine(1.1 * middle, 0.35)),
        ),
    )


def filling(random: np.random.Generator, middle: float) -> tuple[Excitation, ...]:
    """Inflows of a tank, none of them below zero, in the same order."""

    def raised(function: Function, most: float) -> Function:
        return lambda t: np.asarray(most * (0.55 + 0.45 * function(t)))

    def made(item: Excitation, most: float) -> Excitation:
        function = raised(item.function, most)
        samples, period = item.samples, item.period_samples
        return Excitation(item.name, item.use, FAST, samples, function, period)

    levels = (0.6, 1.0, 0.9, 1.0, 0.95, 0.8)
    records = machine_records(random, middle)
    return tuple(made(item, most) for item, most in zip(records, levels, strict=True))

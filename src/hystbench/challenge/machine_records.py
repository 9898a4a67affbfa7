"""The records that a machine is tried with.

Commands are those of :mod:`hystbench.challenge.campaigns`, whose nominal rate is
4 kHz: a machine that is sampled at another rate sees the same samples.
"""

from dataclasses import replace

import numpy as np

from hystbench.challenge.campaigns import (
    FAST_HZ,
    Function,
    RecordCommand,
    add,
    chirp,
    fit,
    held_out,
    multisine,
    sine,
    staircase,
)
from hystbench.challenge.campaigns import PERIOD_SAMPLES as NOMINAL_PERIOD

#: Samples of a record to fit, of one held out, and of a multisine's period.
FIT, HELD_OUT, PERIOD = 1500, 1000, 500
#: So many times shorter than the nominal period.
_FASTER = NOMINAL_PERIOD / PERIOD


def _tones(
    random: np.random.Generator, low: float, high: float, peak: float
) -> Function:
    """Multisine whose period is five hundred samples."""
    function = multisine(random, low / _FASTER, high / _FASTER, peak)
    return lambda t: function(_FASTER * t)


def _steps(
    random: np.random.Generator, count: int, seconds: float, edge: float
) -> Function:
    levels = random.uniform(0.3, 1.0, count) * (-1.0) ** np.arange(count)
    levels *= 0.9 / np.abs(levels).max()
    return staircase([float(level) for level in levels], seconds, edge)


def machine_records(
    random: np.random.Generator, middle: float
) -> tuple[RecordCommand, ...]:
    """Four records to fit and two held out, of levels up to about one.

    Parameters
    ----------
    random : numpy.random.Generator
    middle : float
        Frequency in Hz, at 4 kHz, about which the machine is to be moved.
    """
    low, high = middle / 6.0, 2.5 * middle
    edge = 0.2 / middle
    two = add(sine(0.37 * middle, 0.5), sine(1.1 * middle, 0.35))
    return (
        fit("multisine-low", FAST_HZ, FIT, _tones(random, low, high, 0.35), PERIOD),
        fit("multisine-high", FAST_HZ, FIT, _tones(random, low, high, 1.0), PERIOD),
        fit("sweep", FAST_HZ, FIT, chirp(low, 2.0 * middle, 0.7, FIT / FAST_HZ)),
        fit("steps", FAST_HZ, FIT, _steps(random, 10, FIT / FAST_HZ / 10, edge)),
        held_out("multisine-other", FAST_HZ, HELD_OUT, _tones(random, low, high, 0.85)),
        held_out("two-tones", FAST_HZ, HELD_OUT, two),
    )


def filling(random: np.random.Generator, middle: float) -> tuple[RecordCommand, ...]:
    """Inflows of a tank, none of them below zero, in the same order."""

    def raised(function: Function, most: float) -> Function:
        return lambda t: np.asarray(most * (0.55 + 0.45 * function(t)))

    levels = (0.6, 1.0, 0.9, 1.0, 0.95, 0.8)
    records = machine_records(random, middle)
    return tuple(
        replace(item, function=raised(item.function, most))
        for item, most in zip(records, levels, strict=True)
    )

"""Records that begin in the middle of a motion: any first state is taken off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.record import ComplexArray, Record

STILL = 0.1
"""Share of the rms of an output's steps from sample to sample that is no motion: a
hundredth of its power."""
FADED = 0.01
"""Share of what a state does at first that is nothing."""


def begins_alike(record: Record) -> bool:
    """Tell whether the beginning of a record is known.

    It repeats, it is a window of a free mass, or its output rests for its first two
    steps.
    """
    if record.repeats or record.decay_s is not None:
        return True
    steps = np.abs(np.diff(record.y))
    return bool(np.all(steps[:2] <= STILL * np.sqrt(np.mean(steps**2))))


def with_free_start(record: Record, poles: ComplexArray) -> Record:
    """Give a record of which no score counts what a first state of dynamics does.

    Parameters
    ----------
    record : Record
        One whose beginning is known stays as it is.
    poles : ndarray of complex
        Of the dynamics, in 1/s; of a pair either or both. What has faded when the score
        begins is left out.
    """
    return record if begins_alike(record) else with_state_of(record, poles)


def with_state_of(record: Record, poles: ComplexArray) -> Record:
    """Give a record of which no score counts a first state, whether it rests or not.

    Parameters
    ----------
    record : Record
        One that repeats, or a window of a free mass, stays as it is.
    poles : ndarray of complex
        As for :func:`with_free_start`.
    """
    if record.repeats or record.decay_s is not None:
        return record
    until = (record.lead + 1) * record.dt
    lasting = (poles.imag >= 0.0) & (np.exp(poles.real * until) > FADED)
    return replace(record, start_poles=tuple(poles[lasting].tolist()))

"""Records that begin in the middle of a motion which a linear base remembers for long.

The start of a base is at rest, settled, or moving as before. A record that was cut out
of a longer one begins in neither way. Where the base soon forgets, the beginning is not
scored (:mod:`hystbench.gap.bases.lead`). Where it does not, poles and zeros are bent to
what another first state does. So a linear model is also looked for beside any state.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.orders import HIGHEST
from hystbench.gap.bases.output_error import has_constant
from hystbench.gap.bases.poles import lasting_ones, poles_of
from hystbench.gap.bases.spectral import Spectra, fit_ratio
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.first_state import (
    begins_alike,
    with_free_start,
    with_state_of,
)
from hystbench.gap.thresholds import LOOSE, MOST
from hystbench.model import Model
from hystbench.record import ComplexArray, FloatArray, Record


def with_free_starts(evidence: Evidence, rms: float) -> Evidence | None:
    """Give the fit records as such that may begin in any state of a linear model.

    A fit to spectra leaves the state at both ends free.

    Parameters
    ----------
    evidence : Evidence
    rms : float
        What a linear model leaves of the records that begin alike.

    Returns
    -------
    Evidence or None
        None where a fit of the highest order to spectra does not leave less than a
        quarter of that power; where the beginning of all records is known; and of a
        store, whose level at the first sample is a number of its own.
    """
    storage = evidence.quantities.causality == "storage"
    if storage or all(map(begins_alike, evidence.fit)):
        return None
    spectra = Spectra.of(evidence.fit, evidence.input_hold)
    left = fit_ratio(spectra, HIGHEST, HIGHEST).cost
    if left > LOOSE * rms**2 * sum(map(len, evidence.fit)):
        return None
    return replace(evidence, free_starts=True)


def begun_freely(records: tuple[Record, ...], base: Model) -> tuple[Record, ...]:
    """Give records that may begin in any state of a linear base."""
    poles = _poles(base)
    return tuple(with_free_start(record, poles) for record in records)


def begun_at_any_level(
    records: tuple[Record, ...], base: Model, seconds: float
) -> tuple[Record, ...]:
    """Give records of which no score counts a state that lasts for longer than they do.

    Where an integrator stands is no number of the device: two records of it begin at
    two levels, also at rest.

    Parameters
    ----------
    records : tuple of Record
        Those that a linear base was not identified from.
    base : Model
    seconds : float
        Length of the longest record that it was identified from: what hardly fades in
        that is not known to fade.
    """
    lasting = lasting_ones(_poles(base), seconds)
    if not len(lasting):
        return records
    return tuple(
        record if record.start_poles else with_state_of(record, lasting)
        for record in records
    )


def _poles(base: Model) -> ComplexArray:
    blocks = [block for block in base.chain if isinstance(block, TransferFunction)]
    return np.concatenate([np.zeros(0, complex), *map(poles_of, blocks)])


def start_fades(base: Model, evidence: Evidence) -> bool:
    """Tell whether what first states do is a start, and not the motion itself.

    It has at most half of the power of the output, and in the second half of the
    records at most half of that in the first. Poles that hardly fade do by themselves
    what the input does.
    """
    output = first = second = 0.0
    for record in begun_freely(evidence.fit, base):
        own = _of_first_state(record, base, evidence) ** 2
        half = len(own) // 2
        first, second = first + np.sum(own[:half]), second + np.sum(own[half:])
        output += float(np.sum((record.y - np.mean(record.y)) ** 2))
    return bool(first + second <= MOST * output and second <= MOST * first)


def _of_first_state(record: Record, base: Model, evidence: Evidence) -> FloatArray:
    """Give what the first state does that fits a record best, shape (n,)."""
    held = base.with_hold(evidence.input_hold)
    rest = record.y - held.begun_on(record).simulate(record.driven, record.dt)
    constants = int(has_constant(record, evidence.own_offsets))
    beside = np.hstack([np.ones((len(record), constants)), record.of_start])
    counted = record.counted
    numbers = np.linalg.lstsq(beside[counted], rest[counted], rcond=None)[0]
    return np.asarray(record.of_start @ numbers[constants:])

"""Records that begin in the middle of a motion: their lead is not scored.

A base that is identified starts all its records alike: at rest, settled, or moving as
before. A record that was cut out of a longer one starts in none of these ways, and what
it remembers of the time before is no effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.bases.linear import LEAD, is_identified
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model
from hystbench.record import Record


def without_lead(evidence: Evidence, base: Model, say: Say = silent) -> Evidence:
    """Leave out of the score the leads of records that begin in the middle of a motion.

    The lead is the first tenth, which an identified base was not fitted to either. It
    is left out of a record where the base leaves more of it than of the rest, in mean
    square.

    Parameters
    ----------
    evidence : Evidence
    base : Model
        Where it was given and not identified, nothing is left out.
    say : callable
        Told of how many records the lead is left out.
    """
    if not is_identified(base):
        return evidence
    held = base.with_hold(evidence.hold)
    fit, hold_out = (
        _shortened(records, held) for records in (evidence.fit, evidence.hold_out)
    )
    every = (*fit, *hold_out)
    cut = sum(item.lead > 0 for item in every)
    if cut:
        say(
            f"the first tenth of {cut} of {len(every)} records is not scored: the base "
            "leaves more there than behind it, as where a record begins in the middle "
            "of a motion"
        )
    return replace(evidence, fit=fit, hold_out=hold_out)


def _shortened(records: Sequence[Record], base: Model) -> tuple[Record, ...]:
    return tuple(_without(record, base) for record in records)


def _without(record: Record, base: Model) -> Record:
    if record.decay_s is not None:
        return record  # what its start does is a number of its own
    lead = int(LEAD * len(record))
    squares = (record.y - base.simulate(record.u, record.dt)) ** 2
    counted = record.counted
    first, rest = squares[:lead][counted[:lead]], squares[lead:][counted[lead:]]
    if len(first) == 0 or len(rest) == 0 or np.mean(first) <= np.mean(rest):
        return record
    return replace(record, lead=lead)

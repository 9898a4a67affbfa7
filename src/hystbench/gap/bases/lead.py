"""Records that begin in the middle of a motion: their lead is not scored.

A base that is identified starts all its records alike: at rest, settled, or moving as
before. A record that was cut out of a longer one starts in none of these ways, and what
it remembers of the time before is no effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.store import Store
from hystbench.blocks.structure import Structure
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.free_starts import begun_freely
from hystbench.gap.bases.linear import (
    IdentifiedModel,
    has_free_starts,
    is_identified_linear,
)
from hystbench.gap.bases.orders import LEAD
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.pasts import with_pasts
from hystbench.gap.thresholds import MOST
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.sentences import listed, percent
from hystbench.units import sized

LEFT = 0.01
"""Share of what a state does at most: when no more is left, it is forgotten."""

HALF = 0.5
"""Share of a record that a lead may be."""

ONE_PLACE = 0.1
"""Share of the rms of an output about its mean that is no other place to begin at: a
level that is off by so much takes a hundredth of the power, and dies out."""


def begun_beside(base: Model, records: tuple[Record, ...]) -> tuple[Record, ...]:
    """Give records with the periods before those that begin in a steady motion.

    A linear base that was identified needs none, as it has a start of its own, or lets
    each record have one. A column of a simulator that ran elsewhere begins where the
    record does.
    """
    if has_free_starts(base):
        return begun_freely(records, base)
    own = isinstance(base, IdentifiedModel)
    reruns = all(block.reruns for block in base.chain)
    return records if own or not reruns else with_pasts(records)


def without_leads(
    records: tuple[Record, ...],
    base: Model,
    evidence: Evidence,
    say: Say = silent,
    found: Model | None = None,
) -> tuple[Record, ...]:
    """Leave out of the score the leads of records that begin in the middle of a motion.

    The lead is what the model takes to forget a state, at least the first tenth, which
    an identified base was not fitted to either. It is left out of a record where the
    model leaves more of it than of the rest, in mean square, and another state at the
    first sample would explain most of that. At least half of a record stays. Where the
    device may be a store, whose level at the start is a number, the base alone has to
    forget within the tenth.

    Parameters
    ----------
    records : tuple of Record
        Of one use; one that has no lead already stays as it is. Hold-out records are
        looked at when the search is over.
    base : Model
        Where it was given and not identified, nothing is left out.
    evidence : Evidence
        The level that a store begins with is a number of the model, where all its fit
        records begin alike.
    say : callable
        Told of how many records the lead is left out.
    found : Model, optional
        The base with what was found: it is asked in the place of the base, whose own
        error may hide a start.
    """
    causality = evidence.quantities.causality
    stores = any(isinstance(block, Store) for block in (found or base).chain)
    if not is_identified_linear(base) or (
        (stores or causality == "storage") and begin_alike(evidence.fit)
    ):
        return records
    held = base.with_hold(evidence.input_hold)
    asked = held if found is None else found.with_hold(evidence.input_hold)
    moves = causality in ("force to motion", "motion to force")
    most = HALF if moves or found is not None else LEAD
    shorter = tuple(x if x.lead else _without(x, held, asked, most) for x in records)
    cut = sum(item is not x for item, x in zip(shorter, records, strict=True))
    if cut:
        who = "the base" if found is None else "the model found"
        share = max(item.lead / len(item) for item in shorter)
        say(
            f"the beginning of {cut} of {len(records)} {records[0].use} records is not "
            f"scored, at most {percent(share)} of one: what {who} leaves there is what "
            "another state at the first sample would do"
        )
    return shorter if cut else records


def lead_warnings(records: Sequence[Record]) -> list[str]:
    """Tell of which records a lead is not scored: a sentence, or none."""
    cut = [
        f"{item.name} ({sized(item.lead * item.dt, 's')})"
        for item in records
        if item.lead > item.past
    ]
    free = [item.name for item in records if item.start_poles]
    told = (
        ("not scored is the beginning of records that", cut),
        (
            "not scored is what another first state does in records that",
            free,
        ),
    )
    return [
        f"{what} start in the middle of a motion: {listed(names)}"
        for what, names in told
        if names
    ]


def begin_alike(records: Sequence[Record]) -> bool:
    """Tell whether records begin at one output, to a tenth of how far it moves."""
    moves = max(float(np.std(record.y)) for record in records)
    return float(np.ptp([record.y[0] for record in records])) <= ONE_PLACE * moves


def _without(record: Record, base: Model, asked: Model, most: float) -> Record:
    if record.of_start.shape[1]:
        return record  # what its start does are numbers of its own
    free = _free_motion(asked, record, most)
    if len(free) == 0 and asked is not base:  # it may hold no linear part
        free = _free_motion(base, record, most)
    lead = len(free)
    if lead == 0:
        return record
    rest = record.y - asked.begun_on(record).simulate(record.driven, record.dt)
    first, behind = rest[:lead], rest[lead:][record.counted[lead:]]
    measured = record.counted[:lead]
    first, free = first[measured], free[measured]
    if len(behind) == 0 or len(first) <= free.shape[1]:
        return record
    if np.mean(first**2) <= np.mean(behind**2):
        return record
    states = np.linalg.lstsq(free, first, rcond=1e-9)[0]
    if np.mean((first - free @ states) ** 2) > MOST * np.mean(first**2):
        return record
    return replace(record, lead=lead)


def _free_motion(model: Model, record: Record, most: float) -> FloatArray:
    """Give what other states of a model at the first sample would do.

    Such states are left by other inputs before it: a pulse in each of as many samples
    as its linear parts have states. So what the forces of a mechanism make of a motion
    is in it. Shape (n, states): for as long as it lasts, but at least the first tenth;
    none where that is more than a share of the record.
    """
    order = 0
    for block in model.chain:
        if isinstance(block, TransferFunction):
            order += len(block.denominator) - 1
        elif isinstance(block, Structure):
            order += 2 * len(block.stiffness)
        elif isinstance(block, Mechanism):
            order += 2
        elif isinstance(block, Store):
            order += 1
    model = model.begun_once()
    driven = record.driven
    u = np.concatenate([np.full(order, driven[0]), driven])
    now = model.simulate(u, record.dt)
    size = np.std(record.u) or np.max(np.abs(record.u)) or 1.0
    motion = np.zeros((len(record), order))
    for k in range(order):
        pulse = u.copy()
        pulse[k] += size
        motion[:, k] = (model.simulate(pulse, record.dt) - now)[order:]
    largest = np.max(np.abs(motion), axis=1, initial=0.0)
    lasting = np.flatnonzero(largest > LEFT * np.max(largest, initial=0.0))
    if len(lasting) == 0 or lasting[-1] >= most * len(record):
        return motion[:0]
    return motion[: max(int(LEAD * len(record)), int(lasting[-1]) + 1)]

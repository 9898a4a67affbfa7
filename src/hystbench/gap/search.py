"""The search on the fit records: forces inside the dynamics, and a chain of effects."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from hystbench.blocks.held import Hold
from hystbench.blocks.store import Store
from hystbench.gap.asked import USUAL, Asked
from hystbench.gap.bases.lead import without_leads
from hystbench.gap.bases.linear import is_identified
from hystbench.gap.effects.places import places_between_halves
from hystbench.gap.experiment.excitations import Limits
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.named_inside import (
    Inside,
    apart_inside,
    beats,
    betters,
    named_inside,
)
from hystbench.gap.judge_and_tell import Decision, judge_and_tell
from hystbench.gap.naming.add_effects import Named, add_effects, beside_forces
from hystbench.gap.naming.with_own_values import named_apart
from hystbench.gap.progress import Say
from hystbench.gap.records.evidence import Evidence, own_offsets
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import LOOSE, PAYS
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Record

NOT_IN_WINDOWS = ("drift", "sensor-nonlinearity", "saturation")
"""Effects that windows of a free mass cannot tell. An integrator makes a path of its
own in every window of any error; and each begins at zero wherever the mass is, so that
no curve over its place has a meaning."""
OF_THE_PLACE = "asymmetry"
"""Closed as well where the base may hold a hysteresis: it then stands behind it. Before
a linear base it bends what drives the mass, as a valve does that opens more one way."""


def search(
    evidence: Evidence,
    base: Model,
    asked: Asked = USUAL,
    quantities: Quantities | None = None,
) -> Decision:
    """Locate the gap, name what is missing and add it.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are read.
    base : Model
    asked : Asked
    quantities : Quantities, optional
        What the device takes and gives, where forces are to be tried inside the
        dynamics too.

    Raises
    ------
    InputError
        If the base does not run on the records, or no excitation fits the limits.
    """
    records, hold, declared = evidence.fit, evidence.input_hold, evidence.noise_rms
    offered, say, share = asked.vocabulary.offered, asked.say, asked.unnamed_share
    limits = Limits.of(records, asked.limits) if asked.limits else None
    if any(record.decay_s is not None for record in records):
        closed = (*NOT_IN_WINDOWS, *(() if quantities else (OF_THE_PLACE,)))
        offered = tuple(name for name in offered if name not in closed)
    start, floor = start_state(records, base, hold, declared, offered)
    first, inside, own = start, None, NONE
    identified = is_identified(base)
    in_a_chain = cache(partial(add_effects, start, floor.rms, asked))

    @cache
    def most() -> float:
        return _most_inside(in_a_chain(), floor)

    halves = bool(places_between_halves(start.simulation))
    # Two halves say themselves that there is a curve between two filters: a chain. And
    # a base that was given has to be beaten by forces, also where they leave little.
    if halves or (quantities is not None and not identified):
        little = halves and _why_enough(start, in_a_chain().state, floor, share)
        if quantities and (little or most() < 1):
            say("no force could gain what matters, so none is tried inside")
            quantities = None
    if quantities is not None:
        whole = start, floor
        start, floor, inside, own = _with_forces(
            base, start, floor, quantities, declared, asked, most
        )
        if inside is not None and not betters(inside, start, floor.rms):
            say("inside: what stands for the base leaves more than the base does")
            (start, floor), inside, own = whole, None, NONE
    if inside is not None:
        beside = beside_forces(inside.named, inside.start, floor.rms, share, say)
        inside = replace(inside, named=beside)
    enough = ""
    # A base that was given is re-tuned where it is a host: that may stand for a chain.
    if inside is not None and identified:
        enough = _why_enough(inside.start, inside.named.state, floor, share)
    if enough:
        say(f"inside: {enough}, so no chain of effects is tried")
    else:
        same = start is first
        chain = in_a_chain() if same else add_effects(start, floor.rms, asked)
        named, theirs = chain, own
        if inside is not None and not beats(inside, named, floor.rms, say):
            inside = None
        if not (own.records or _leaves_little(inside, floor)):
            start, named, theirs = named_apart(start, floor.rms, named, asked)
            if inside is not None and theirs.records:
                inside = inside if beats(inside, named, floor.rms, say) else None
        own = theirs if inside is None else own
    if inside is not None:
        base, start, named = inside.base, inside.start, inside.named
    found = judge_and_tell(evidence.name, base, start, floor, named, asked, limits, own)
    if inside is None:
        return found
    reason = f"{found.content['reason']}; {inside.sentence}"
    return replace(found, content={**found.content, "reason": reason})


def _with_forces(
    base: Model,
    start: ModelState,
    floor: Floor,
    quantities: Quantities,
    declared: float | None,
    asked: Asked,
    most: Callable[[], float],
) -> tuple[ModelState, Floor, Inside | None, OwnValues]:
    """Look for forces inside the dynamics, beside what is a record's own.

    Returns
    -------
    start : ModelState
        The base on the records, without what was found to be their own.
    floor : Floor
    inside : Inside or None
    own : OwnValues
    """
    identified, records, hold = is_identified(base), start.records, start.hold
    say = asked.say

    def look(start: ModelState) -> Inside | None:
        return named_inside(base, start, floor.rms, quantities, identified, asked, most)

    inside, own = look(start), NONE
    shorter = _without_leads(inside, base, records, hold, quantities, say)
    if shorter is not records:
        whole = start, floor
        start, floor = start_state(shorter, base, hold, declared, start.offered)
        inside = look(start)
        if inside is None:  # no force shows where a motion begins
            start, floor = whole
    if not _leaves_little(inside, floor) and own_offsets(records, quantities):
        start, inside, own = apart_inside(start, inside, floor.rms, look, say)
    return start, floor, inside, own


def _without_leads(
    inside: Inside | None,
    base: Model,
    records: tuple[Record, ...],
    hold: Hold,
    quantities: Quantities,
    say: Say,
) -> tuple[Record, ...]:
    """Leave out the leads of records of which forces show that they begin in motion.

    A base without the forces is too far off to show it.
    """
    if inside is None:
        return records
    found = augmented(inside.base, inside.named.state)
    if any(isinstance(block, Store) for block in found.chain):
        return records  # the level that it begins with is a number of its own
    return without_leads(records, base, hold, quantities, say, found)


def _leaves_little(inside: Inside | None, floor: Floor) -> bool:
    """Tell whether forces leave so little that no record needs numbers of its own."""
    if inside is None:
        return False
    square = floor.rms**2
    left = inside.named.state.power(square)
    return left <= LOOSE * inside.start.power(square)


def _most_inside(chain: Named, floor: Floor) -> float:
    """Give how many effects inside could do better than what a chain has found.

    They have to lower its score by what an effect has to gain. Where it leaves so
    little that nothing can, they have to be fewer.
    """
    state = chain.state
    score = Score.plain(state.sample, floor.rms**2)
    left = score_of(state, score) - score.least(state.freedom)
    return np.inf if left >= PAYS else len(state.added) - 1


def _why_enough(
    start: ModelState, state: ModelState, floor: Floor, share: float
) -> str:
    """Say why no further effect could gain what matters; or nothing.

    It is what ends a search in a chain as well: an effect has to take more than may
    stay unnamed, and more than noise.
    """
    square = floor.rms**2
    before, after = start.power(square), state.power(square)
    if after < square:
        return "less than the noise's own power is left above it"
    if after <= share * before:
        return "no more is left than may stay unnamed"
    return ""

"""The search on the fit records: beside which bases, in what order, and its verdict."""

from __future__ import annotations

from dataclasses import replace

from hystbench.device_kinds import behaviour_of
from hystbench.gap.asked import Asked
from hystbench.gap.bases.gpi import again_words, is_another
from hystbench.gap.bases.linear import (
    found_with,
    is_identified_linear,
    linear_of,
    with_its_numbers_free,
)
from hystbench.gap.bases.roughly_known import roughly_known
from hystbench.gap.beside_base import BesideBase, stays
from hystbench.gap.effects import effects
from hystbench.gap.experiment.candidates import Limits
from hystbench.gap.fitting.re_tuning_gain import re_tuned_words
from hystbench.gap.gap_search import GapSearch, leaves_little
from hystbench.gap.inside.named_inside import beats_chain
from hystbench.gap.inside.timing import better_timed, in_time_words, timed_as_named
from hystbench.gap.judge_and_tell import Decision, judge_and_tell
from hystbench.gap.naming.with_own_values import named_apart
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model
from hystbench.quantities import Quantities

NOT_EXACT = "the base does not call its numbers exact, and was re-tuned"
EXACT = "write 'free: []' in a model file that is exact"


def search_and_judge(
    evidence: Evidence,
    base: Model,
    asked: Asked,
    quantities: Quantities | None = None,
) -> Decision:
    """Name what is missing and add it, then give the verdict on that.

    A given base is first taken as it is. Where re-tuning it might replace an effect, or
    pay beside one, the search is repeated with its numbers and timing free within their
    tolerances. What explains the records better stands.

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
    limits = Limits.of(evidence.fit, asked.limits) if asked.limits else None
    gap = GapSearch(evidence, asked.sought, quantities)
    found, re_tuned = _beside_what_is_named(gap, base), False
    identified = is_identified_linear(base)
    if identified:
        found = _in_better_time(gap, found)
    found = gap.identified_again(found, found.named)
    if identified:
        found = gap.of_more_poles(gap.begun_otherwise(found))
    else:
        found, re_tuned = _with_numbers_free(gap, found)
    found = _apart(found, gap.asked)
    told = judge_and_tell(evidence.name, found, asked, limits)
    reason = "; ".join([told.content["reason"], *_reason(gap, base, found, re_tuned)])
    return replace(told, content={**told.content, "reason": reason})


def _beside_what_is_named(gap: GapSearch, base: Model) -> BesideBase:
    """Name beside a base; where it was found together with an effect, with that.

    Without that effect such a base is no model of the records. If it is not named, the
    linear base is the one of input and output alone.
    """
    found = gap.beside(base)
    effect = found_with(base)
    named = {item.effect for item in found.named.state.added}
    if effect not in effects() or effect in named:
        return found
    gap.asked.say(
        f"the linear base was found together with {effect}, which is not named: naming "
        "beside one that was found alone"
    )
    alone = linear_of(gap.evidence).model
    return gap.beside(with_its_numbers_free(alone))


def _in_better_time(gap: GapSearch, found: BesideBase) -> BesideBase:
    """Name with the timing that effects show of an identified base, if it is better."""
    tried, say = found.tried, gap.asked.say
    better = tried and better_timed(found.base, tried.named.state, found.floor)
    shifted = better or timed_as_named(found.base, found.named.state)
    if shifted is None:
        return found
    say("the input may be taken at another time: naming beside that")
    other = gap.beside(shifted, found.hosts)
    found = found if stays(found, other) else other
    say("it is" if found is other else "that explains no more: it is not")
    return found


def _with_numbers_free(gap: GapSearch, found: BesideBase) -> tuple[BesideBase, bool]:
    """Name beside a given base with its numbers and timing free, if that does better.

    Returns
    -------
    BesideBase
    bool
        Whether the base was re-tuned.
    """
    rough, say = roughly_known(found.base, gap.evidence.fit), gap.asked.say
    if rough is None or not found.may_be_simpler():
        return found, False
    say("the base's numbers or timing may be off: naming beside that")
    other = gap.beside(rough, found.hosts)
    if not stays(found, other, re_tuned=True):
        return other, True
    say("that explains no more: they stay as they are")
    if found.named.state.paths:  # beside other numbers it may be a law
        found = gap.identified_again(found, other.named)
    return found, False


def _apart(found: BesideBase, asked: Asked) -> BesideBase:
    """Name anew beside what records have of their own, where effects leave much."""
    if found.chain is None or found.own.records:
        return found
    inside, floor = found.inside, found.floor
    if leaves_little(inside, floor):
        return found
    start, chain, own = named_apart(found.start, floor, found.chain, asked)
    if (
        inside is not None
        and own.records
        and not beats_chain(inside, chain, floor, asked.say)
    ):
        inside = None
    own = found.own if inside is not None else own
    return replace(found, start=start, chain=chain, inside=inside, own=own)


def _reason(
    gap: GapSearch, base: Model, found: BesideBase, re_tuned: bool
) -> list[str]:
    """Say what was changed of the base before the names were found beside it."""
    state, told = found.named.state, []
    if found_with(base) and not found_with(found.base):
        effect = behaviour_of(found_with(base))
        told.append(f"the linear base is that without {effect}, which is not named")
    if is_another(base, found.base):
        told.append(again_words(gap.evidence.to_identify_from.name))
    if found.inside is not None:
        told.append(found.inside.sentence)
    if is_identified_linear(base) and (late := in_time_words(state)):
        told.append(late)
    if re_tuned:
        told.append(f"{NOT_EXACT} ({EXACT})")
        if found.inside is None:
            told[-1] += f": {re_tuned_words(found.start, state)}"
    return told

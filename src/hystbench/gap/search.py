"""The search on the fit records: forces inside the dynamics, and a chain of effects."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial

from hystbench.gap.asked import Asked
from hystbench.gap.bases.gpi import again_words, is_another
from hystbench.gap.bases.integrator import integrates
from hystbench.gap.bases.lead import without_leads
from hystbench.gap.bases.linear import found_with, is_identified_linear
from hystbench.gap.bases.roughly_known import roughly_known
from hystbench.gap.beside_base import BesideBase, leaves_much, stays
from hystbench.gap.effects.places import places_between_halves
from hystbench.gap.experiment.candidates import Limits
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import on_records, start_state
from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.re_tuning_gain import re_tuned_words
from hystbench.gap.fitting.refit import finished
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.identify_again import identified_again
from hystbench.gap.inside.choose import has_free_form, most_inside
from hystbench.gap.inside.host import Kind
from hystbench.gap.inside.named_inside import (
    Inside,
    apart_inside,
    beats_base,
    beats_chain,
    named_inside,
)
from hystbench.gap.inside.timing import better_timed, in_time_words, timed_as_named
from hystbench.gap.judge_and_tell import Decision, judge_and_tell
from hystbench.gap.naming.add_effects import NO_MORE_LEFT, Named, add_effects
from hystbench.gap.naming.begun_otherwise import begun_as_named
from hystbench.gap.naming.beside_forces import beside_forces
from hystbench.gap.naming.poles_of_base import named_beside_them, with_poles_named
from hystbench.gap.naming.with_own_values import named_apart, offsets_for_paths
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Record

NOT_IN_WINDOWS = ("drift", "sensor-nonlinearity", "saturation")
"""Effects that windows of a free mass cannot tell. A window begins at zero wherever the
mass is, so a curve of the place means nothing; and any small error becomes a path."""
WANDERS = "drift"
"""Not offered either beside a base that integrates: its own errors become paths."""
OF_THE_PLACE = "asymmetry"
"""It is not offered in windows where the base may hold a hysteresis, as it would then
be a curve of the place. Before a linear base it bends the input, as a valve does that
opens more one way, and is offered."""

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
    gap, say = GapSearch(evidence, asked.sought, quantities), asked.say
    found = gap.beside(base)
    identified = is_identified_linear(base)
    shifted = _in_better_time(found) if identified else None
    if shifted is not None:
        say("the input may be taken at another time: naming beside that")
        other = gap.beside(shifted, found.hosts)
        found = found if stays(found, other) else other
        say("it is" if found is other else "that explains no more: it is not")
    found = gap.identified_again(found, found.named)
    if identified:
        found = gap.of_more_poles(gap.begun_otherwise(found))
    rough = None if identified else roughly_known(found.base, evidence.fit)
    if rough is not None and found.may_be_simpler():
        say("the base's numbers or timing may be off: naming beside that")
        other = gap.beside(rough, found.hosts)
        if stays(found, other, re_tuned=True):
            say("that explains no more: they stay as they are")
            if found.named.state.paths:  # beside other numbers it may be a law
                found = gap.identified_again(found, other.named)
        else:
            found = other
    found = _apart(found, gap.asked)
    told = judge_and_tell(evidence.name, found, asked, limits)
    more = [told.content["reason"]]
    if is_another(base, found.base):
        more.append(again_words(evidence.to_identify_from.name))
    if found.inside is not None:
        more.append(found.inside.sentence)
    if identified and (late := in_time_words(found.named.state)):
        more.append(late)
    if found.base is rough:
        more.append(f"{NOT_EXACT} ({EXACT})")
        if found.inside is None:
            more[-1] += f": {re_tuned_words(found.start, found.named.state)}"
    return replace(told, content={**told.content, "reason": "; ".join(more)})


@dataclass(frozen=True)
class GapSearch:
    """How fit records are searched, beside one base or another."""

    evidence: Evidence
    asked: Asked
    quantities: Quantities | None
    """None where no forces are to be tried inside the dynamics."""

    def offered(self, base: Model) -> tuple[str, ...]:
        """Effects that these records may show beside a base, of those to be named."""
        offered = self.asked.vocabulary.offered
        if not self.evidence.in_windows:
            span = max(len(record) * record.dt for record in self.evidence.fit)
            wanders = integrates(base, span)
            return tuple(x for x in offered if not (wanders and x == WANDERS))
        beside = () if self.quantities is not None else (OF_THE_PLACE,)
        barred = (*NOT_IN_WINDOWS, *beside)
        return tuple(name for name in offered if name not in barred)

    def started(self, records: tuple[Record, ...], base: Model) -> BesideBase:
        """Give a base on records, with nothing named beside it yet."""
        hold, noise = self.evidence.input_hold, self.evidence.noise_rms
        offered = self.offered(base)
        begun = start_state(records, base, hold, declared=noise, offered=offered)
        return BesideBase(base, *begun)

    def without_leads(self, found: BesideBase, model: Model) -> BesideBase:
        """Start without the leads that a model shows; the same where there are none.

        The model was found beside the base. What was named goes with the leads.
        """
        records, base, say = found.start.records, found.base, self.asked.say
        shorter = without_leads(records, base, self.evidence, say, found=model)
        return found if shorter is records else self.started(shorter, base)

    def identified_again(self, found: BesideBase, named: Named) -> BesideBase:
        """Name beside a hysteresis that is identified again, where that is better."""
        named_beside = partial(self.beside, kinds=found.hosts)
        offered = self.offered(found.base)
        return identified_again(
            found, named, self.evidence, named_beside, self.asked.say, offered
        )

    def begun_otherwise(self, found: BesideBase) -> BesideBase:
        """Name beside another start of the base, if that may stand for records' paths.

        It does if the other effects are then named, and nothing else.
        """
        state, say = found.named.state, self.asked.say
        begun = begun_as_named(found.base, state, self.evidence.fit, found.floor)
        if begun is None:
            return found
        say("the records may begin otherwise: naming beside that")
        other = self.beside(begun, found.hosts)
        others = {item.effect for item in state.added} - state.paths
        stands = {item.effect for item in other.named.state.added} == others
        say("they do" if stands else "that explains something else: they do not")
        return other if stands else found

    def of_more_poles(self, found: BesideBase) -> BesideBase:
        """Give poles that were named beside an identified base to the base.

        Its numbers are those that leave least without any effect.
        """
        if found.inside is not None or found.own.records:
            return found
        base = with_poles_named(found.base, found.named.state)
        if base is None:
            return found
        records, say = found.start.records, self.asked.say
        begun = self.started(records, base)
        alone, _ = finished(begun.start, make_score(begun.start, begun.floor))
        begun = self.started(records, replace(base, chain=alone.chain))
        chain = named_beside_them(found.named, begun.start, begun.floor, say)
        if chain is None:
            return found
        say("the base may have the poles that were named: they are no effect")
        return replace(begun, chain=chain, tried=found.tried)

    @cached_property
    def chain_of(self) -> Callable[[ModelState, Floor], Named]:
        """Names effects in a chain; kept, as it is slow and asked for often."""
        return cache(lambda start, floor: add_effects(start, floor, self.asked))

    def in_a_chain(self, found: BesideBase) -> Named:
        """Give the effects that are named in a chain, whatever forces there are."""
        return self.chain_of(found.start, found.floor)

    def beside(self, base: Model, kinds: tuple[Kind, ...] = ()) -> BesideBase:
        """Name in a chain and inside the dynamics, on the records as they are.

        Forces are tried in hosts of some kinds; in all by default.
        """
        found = self.started(self.evidence.fit, base)
        known = bool(places_between_halves(found.start.simulation) or found_with(base))
        if known:  # what that effect hides of a start is no reason to try forces
            found = self.without_leads_beside_chain(found)
        if self.quantities is None:
            return self.with_chain(found)
        # A base of two filters tells that a curve lies between them. One that was found
        # beside an effect tells that there is this effect. So the chain is tried first.
        # So it is beside a given base: forces must beat that.
        chain_first = known or not is_identified_linear(base)
        if chain_first and self.none_could_gain(found, known):
            self.asked.say("no force could gain what matters, so none is tried inside")
        else:
            found = self.with_forces(found, self.quantities, kinds)
        return self.with_chain(found)

    def none_could_gain(self, found: BesideBase, known: bool) -> bool:
        """Tell whether a chain leaves nothing to forces.

        Beside an effect that the base tells of, it is enough if it leaves little.
        """
        chain, share = self.in_a_chain(found), self.asked.unnamed_share
        enough = known and _why_enough(found.start, chain.state, found.floor, share)
        return bool(enough) or most_inside(chain, found.floor) < 1

    def with_chain(self, found: BesideBase) -> BesideBase:
        """Name in a chain too, unless forces are enough; what does better stands."""
        inside, say, floor = found.inside, self.asked.say, found.floor
        # A base that was given is re-tuned where it is a host: that may stand for a
        # chain.
        if inside is not None and is_identified_linear(found.base):
            state, share = inside.named.state, self.asked.unnamed_share
            enough = _why_enough(inside.start, state, floor, share)
            if enough:
                say(f"inside: {enough}, so no chain of effects is tried")
                return found
        if inside is None and self.in_a_chain(found).state.added:
            found = self.without_leads_beside_chain(found)
        chain = self.in_a_chain(found)
        if inside is not None and not beats_chain(inside, chain, floor, say):
            inside = None
        return replace(found, chain=chain, inside=inside)

    def without_leads_beside_chain(self, found: BesideBase) -> BesideBase:
        """Start without the leads that a base shows with the chain beside it."""
        chain = self.in_a_chain(found)
        return self.without_leads(found, augmented(found.base, chain.state))

    def with_forces(
        self, whole: BesideBase, quantities: Quantities, kinds: tuple[Kind, ...]
    ) -> BesideBase:
        """Look for forces inside the dynamics, beside what is a record's own.

        After the first look only such hosts are tried as it has found best. Records get
        offsets of their own only where a chain leaves much as well. Wrong forces leave
        much, and an offset would take some of it. What does not beat the base is left
        out, with all that was found beside it.
        """
        look = partial(
            named_inside,
            whole.base,
            quantities=quantities,
            asked=self.asked,
            most=lambda: most_inside(self.in_a_chain(whole), whole.floor),
        )
        shorter, found, inside = whole, None, None
        while shorter is not found:  # each time fewer records are whole
            found = shorter
            inside, shorter = self.forces_and_leads(found, partial(look, kinds=kinds))
            kinds = kinds if inside is None else (inside.host,)
        if inside is None:  # no force shows where a motion begins
            found = whole
        start, floor, own, say = found.start, found.floor, NONE, self.asked.say
        if (
            not _leaves_little(inside, floor)
            and self.evidence.own_offsets
            and leaves_much(self.in_a_chain(whole).state, whole.start, whole.floor)
        ):
            start, inside, own = apart_inside(start, inside, floor, look, kinds, say)
        if inside is None:
            return whole
        if not beats_base(inside, start, floor):
            say("inside: what stands for the base leaves more than the base does")
            return whole
        start, inside, own = self.not_of_the_input(start, floor, inside, own)
        return replace(found, start=start, inside=inside, own=own, tried=inside)

    def forces_and_leads(
        self, found: BesideBase, look: Callable[..., Inside | None]
    ) -> tuple[Inside | None, BesideBase]:
        """Look for forces once, and start without the leads that these show.

        If a host shows leads already, the look ends with nothing: on shorter records it
        is to begin again.
        """
        starts = [found]

        def shows_leads(model: Model) -> bool:
            starts.append(self.without_leads(found, model))
            return starts[-1] is not found

        inside = look(found.start, found.floor, again=shows_leads)
        if inside is not None:
            shows_leads(augmented(inside.base, inside.named.state))
        return inside, starts[-1]

    def not_of_the_input(
        self, start: ModelState, floor: Floor, inside: Inside, own: OwnValues
    ) -> tuple[ModelState, Inside, OwnValues]:
        """Name beside forces what the input does not explain: signals, or offsets."""
        say, share = self.asked.say, self.asked.unnamed_share
        beside = beside_forces(inside.named, inside.start, floor, share, say)
        inside = replace(inside, named=beside)
        if beside.state.paths and self.evidence.own_offsets and not own.records:
            start, named, own = offsets_for_paths(start, beside, floor, say)
            alone = on_records(inside.start, start.records)
            inside = replace(inside, start=alone, named=named)
        return start, inside, own


def _in_better_time(found: BesideBase) -> Model | None:
    """Give an identified base with the timing that effects show, if that is another."""
    tried = found.tried
    better = tried and better_timed(found.base, tried.named.state, found.floor)
    return better or timed_as_named(found.base, found.named.state)


def _apart(found: BesideBase, asked: Asked) -> BesideBase:
    """Name anew beside what records have of their own, where effects leave much."""
    if found.chain is None or found.own.records:
        return found
    inside, floor = found.inside, found.floor
    if _leaves_little(inside, floor):
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


def _leaves_little(inside: Inside | None, floor: Floor) -> bool:
    """Tell whether forces leave so little that no record needs numbers of its own."""
    if inside is None:
        return False
    return not leaves_much(inside.named.state, inside.start, floor)


def _why_enough(
    start: ModelState, state: ModelState, floor: Floor, share: float
) -> str:
    """Say why no further effect could gain what matters; or nothing.

    It would have to take more than may stay unnamed, as in a chain, and the noise would
    have to be the lesser part of what is left. What a free form leaves says nothing: it
    bends to what other effects do.
    """
    if has_free_form(state):
        return ""
    square = floor.square
    before, after = start.power(square), state.power(square)
    if after < square:
        return "less than the noise's own power is left above it"
    if after <= share * before:
        return NO_MORE_LEFT
    return ""

"""How records are searched beside a base: forces inside it, and a chain of effects."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial

from hystbench.gap.asked import Asked
from hystbench.gap.bases.integrator import integrates
from hystbench.gap.bases.lead import without_leads
from hystbench.gap.bases.linear import found_with, is_identified_linear
from hystbench.gap.beside_base import BesideBase, leaves_much
from hystbench.gap.effects.places import places_between_halves
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import on_records, start_state
from hystbench.gap.fitting.own_values import NONE, OwnValues
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
from hystbench.gap.naming.add_effects import NO_MORE_LEFT, Named, add_effects
from hystbench.gap.naming.begun_otherwise import begun_as_named
from hystbench.gap.naming.beside_forces import beside_forces
from hystbench.gap.naming.poles_of_base import named_beside_them, with_poles_named
from hystbench.gap.naming.with_own_values import offsets_for_paths
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
        start, floor = start_state(records, base, hold, declared=noise, offered=offered)
        return BesideBase(base, replace(start, expected=found_with(base)), floor)

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
        chain, allowed = self.in_a_chain(found), self.asked.unnamed_share
        enough = known and _why_enough(found.start, chain.state, found.floor, allowed)
        return bool(enough) or most_inside(chain, found.floor) < 1

    def with_chain(self, found: BesideBase) -> BesideBase:
        """Name in a chain too, unless forces are enough; what does better stands."""
        inside, say, floor = found.inside, self.asked.say, found.floor
        # A base that was given is re-tuned where it is a host: that may stand for a
        # chain.
        if inside is not None and is_identified_linear(found.base):
            state, allowed = inside.named.state, self.asked.unnamed_share
            enough = _why_enough(inside.start, state, floor, allowed)
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
        found, inside, kinds = self._forces_without_leads(whole, look, kinds)
        start, floor, own, say = found.start, found.floor, NONE, self.asked.say
        if self._may_have_own_offsets(whole, inside, floor):
            start, inside, own = apart_inside(start, inside, floor, look, kinds, say)
        if inside is None:
            return whole
        if not beats_base(inside, start, floor):
            say("inside: what stands for the base leaves more than the base does")
            return whole
        start, inside, own = self.not_of_the_input(start, floor, inside, own)
        return replace(found, start=start, inside=inside, own=own, tried=inside)

    def _forces_without_leads(
        self,
        whole: BesideBase,
        look: Callable[..., Inside | None],
        kinds: tuple[Kind, ...],
    ) -> tuple[BesideBase, Inside | None, tuple[Kind, ...]]:
        """Look for forces till they show no further leads.

        Returns
        -------
        BesideBase
            The base on records without their leads; as they are if no force is found.
        Inside or None
        tuple of str
            Hosts for a further look.
        """
        shorter, found, inside = whole, None, None
        while shorter is not found:  # each time fewer records are whole
            found = shorter
            inside, shorter = self.forces_and_leads(found, partial(look, kinds=kinds))
            kinds = kinds if inside is None else (inside.host,)
        if inside is None:  # no force shows where a motion begins
            found = whole
        return found, inside, kinds

    def _may_have_own_offsets(
        self, whole: BesideBase, inside: Inside | None, floor: Floor
    ) -> bool:
        """Tell whether offsets of single records are to be tried beside forces.

        That is where forces leave much, and a chain as well.
        """
        return (
            not leaves_little(inside, floor)
            and self.evidence.own_offsets
            and leaves_much(self.in_a_chain(whole).state, whole.start, whole.floor)
        )

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
        say, allowed = self.asked.say, self.asked.unnamed_share
        beside = beside_forces(inside.named, inside.start, floor, allowed, say)
        inside = replace(inside, named=beside)
        if beside.state.paths and self.evidence.own_offsets and not own.records:
            start, named, own = offsets_for_paths(start, beside, floor, say)
            alone = on_records(inside.start, start.records)
            inside = replace(inside, start=alone, named=named)
        return start, inside, own


def leaves_little(inside: Inside | None, floor: Floor) -> bool:
    """Tell whether forces leave so little that no record needs numbers of its own."""
    if inside is None:
        return False
    return not leaves_much(inside.named.state, inside.start, floor)


def _why_enough(
    start: ModelState, state: ModelState, floor: Floor, allowed: float
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
    if after <= allowed * before:
        return NO_MORE_LEFT
    return ""

"""The next experiment: which excitation tells rival effects apart, and by how much.

Rivals of a named effect are those that it cannot be told from, each as it was fitted
beside the same other effects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

from hystbench.errors import InputError
from hystbench.gap.experiment.candidates import Excitation, Limits, candidates
from hystbench.gap.experiment.separation import Rival, RivalPair, Sets, separations
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate, near
from hystbench.gap.records.floor import Floor
from hystbench.model import Model
from hystbench.record import Record

CLEAR_FLOORS = 3.0
"""A pair that differs by so many floors is told apart: more of it helps no other."""
TOLD_FLOORS = 1.0
"""A pair that differs by less is not told apart."""
PAIRS_SHOWN = 3
"""Pairs that a sentence names: all of them are in the table."""
REFITTED = "after both are refitted"
ELSEWHERE = (
    "the base holds the output of a simulator that ran elsewhere, which answers to no "
    "other input"
)
"""Why no experiment is computed."""


@dataclass(frozen=True, repr=False)
class Experiment:
    """The excitation that separates rivals best, those of all sets at once."""

    excitation: Excitation
    pairs: dict[RivalPair, float]
    """Separation of each pair of rivals, in noise floors."""
    existing: dict[RivalPair, float]
    """The same for the existing record that is best for the pair."""
    largest: dict[RivalPair, float]
    """The same for the excitation that is best for the pair."""
    left_out: tuple[tuple[str, str], ...] = ()
    """Members of sets that no input brings out, each with the effect whose set it
    is."""

    @property
    def sentence(self) -> str:
        """What to do and what it gives, in words."""
        told = [pair for pair, size in self.pairs.items() if size >= TOLD_FLOORS]
        return " ".join([self._lead(told), *self._not_told(told)])

    def _lead(self, told: Sequence[RivalPair]) -> str:
        lead, count = f"Try {self.excitation.words}", len(self.pairs)
        if not told:
            lead = f"The best feasible excitation is {self.excitation.words}"
        elif _merit(self.existing) >= _merit(self.pairs):
            lead = (
                "The existing records do as well as the best feasible excitation, "
                f"{self.excitation.words}"
            )
        choose = min if told else max
        shown = choose(told or self.pairs, key=lambda pair: self.pairs[pair])
        apart = f"{self._words(shown)} by {self.pairs[shown]:.2g} noise floors"
        if count > 1:
            many = f"{len(told) or 'none'} of {count}"
            many = f"all {count}" if len(told) == count else many
            apart = (
                f"{many} pairs by a noise floor or more, {self._words(shown)} "
                f"{'least' if told else 'most'}, by {self.pairs[shown]:.2g}"
            )
        return (
            f"{lead}: it separates {apart} {REFITTED}; the best of the existing "
            f"records reaches {self.existing[shown]:.2g}."
        )

    def _not_told(self, told: Sequence[RivalPair]) -> list[str]:
        """Say what the excitation does not tell, and who would."""
        rest = [pair for pair in self.pairs if pair not in told]
        known = [pair for pair in rest if self.existing[pair] >= TOLD_FLOORS]
        unknown = [pair for pair in rest if pair not in known]
        never = [pair for pair in unknown if self.largest[pair] < TOLD_FLOORS]
        other = [pair for pair in unknown if pair not in never]
        found = [
            f"{who} {self._listed(pairs)}."
            for who, pairs in (
                ("The existing records tell", known),
                ("No feasible excitation tells", never),
                ("Another excitation would tell", other),
            )
            if pairs
        ]
        if self.left_out:
            found.append(f"{new_in_every_record(self.left_out)}.")
        return found

    def _words(self, pair: RivalPair) -> str:
        several = len({each.of for each in self.pairs}) > 1
        place = f" in the place of {pair.of}" if several else ""
        return " from ".join(pair.names) + place

    def _listed(self, pairs: Sequence[RivalPair]) -> str:
        shown = [self._words(pair) for pair in pairs[:PAIRS_SHOWN]]
        more = len(pairs) - len(shown)
        return ", ".join(shown) + (f" and {more} more" if more else "")

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``next_experiment``."""
        return {
            "excitation": self.excitation.kind,
            "parameters": self.excitation.parameters,
            "sampling_interval_s": self.excitation.dt,
            "separation": min(self.pairs.values()),
            "existing_separation": min(self.existing.values()),
            "pairs": [
                {
                    "of": pair.of,
                    "names": list(pair.names),
                    "separation": size,
                    "existing_separation": self.existing[pair],
                    "largest_separation": self.largest[pair],
                }
                for pair, size in self.pairs.items()
            ],
            "left_out": [{"of": of, "name": name} for of, name in self.left_out],
            "sentence": self.sentence,
        }


def new_in_every_record(left_out: Sequence[tuple[str, str]]) -> str:
    """Say which members of sets no input brings out."""
    names = list(dict.fromkeys(name for _, name in left_out))
    are, them = ("is", "it") if len(names) == 1 else ("are", "them")
    return (
        f"{' and '.join(names)} {are} new in every record: no input brings {them} out"
    )


def next_experiment(
    sets: Sets,
    records: Sequence[Record],
    noise_floor: float,
    excitations: Sequence[Excitation],
) -> Experiment:
    """Choose the excitation that tells rival models apart best.

    Parameters
    ----------
    sets : mapping of str to mapping of str to Rival
        By the effect that they are rivals of, and by name; each fitted to the records.
        One of the sets has two or more.
    records : sequence of Record
        The fit records: what they separate is the measure.
    noise_floor : float
        RMS in output units, above zero.
    excitations : sequence of Excitation
        As :func:`~hystbench.gap.experiment.candidates.candidates` gives them.

    Returns
    -------
    Experiment
        Of the excitations that tell most pairs apart, the one that separates all pairs
        most, each counted up to ``CLEAR_FLOORS``; of equals, the hardest pair decides.

    Raises
    ------
    InputError
        If there is no excitation that lets every rival run.
    """
    every = [
        RivalPair(of, x) for of, each in sets.items() for x in combinations(each, 2)
    ]
    tried = [
        (item, separations(sets, item.u, item.dt, noise_floor)) for item in excitations
    ]
    run = [(item, pairs) for item, pairs in tried if len(pairs) == len(every)]
    if not run:
        raise InputError(
            f"next experiment: none of {len(tried)} excitations keeps within the "
            "limits and gives finite outputs; expected wider limits"
        )
    excitation, pairs = max(run, key=lambda each: _merit(each[1]))
    reached = [separations(sets, item.u, item.dt, noise_floor) for item in records]
    return Experiment(
        excitation,
        pairs,
        {pair: max(each.get(pair, 0.0) for each in reached) for pair in every},
        {pair: max(each[pair] for _, each in run) for pair in every},
    )


def _merit(pairs: dict[RivalPair, float]) -> tuple[int, float, float]:
    """Rank by pairs told apart, then by how clearly, then by the hardest."""
    sizes = list(pairs.values())
    told = sum(size >= TOLD_FLOORS for size in sizes)
    return told, sum(min(size, CLEAR_FLOORS) for size in sizes), min(sizes)


def tell_apart(
    base: Model,
    named: Named,
    records: Sequence[Record],
    floor: Floor,
    limits: Limits | None,
) -> tuple[Experiment | None, str]:
    """Look for the one excitation that tells all sets of likely effects apart.

    Parameters
    ----------
    base : Model
    named : Named
    records : sequence of Record
        The fit records.
    floor : Floor
    limits : Limits or None
        Those of the records where none are given.

    Returns
    -------
    experiment : Experiment or None
    str
        Why there is none though effects cannot be told apart; else empty.
    """
    alike = {
        (item.effect, name): state
        for item in named.state.added
        for name, state in _alike(
            item.effect, named.reasons.get(item.effect, ())
        ).items()
    }
    if not alike:
        return None, ""
    if not all(block.reruns for block in base.chain):
        return None, ELSEWHERE
    sets: dict[str, dict[str, Rival]] = {}
    left_out = []
    for (of, name), state in alike.items():
        if any(beside.effect == name for beside, _ in state.beside):
            left_out.append((of, name))
            continue
        # What other effects put beside the chain is new in every record too.
        model = augmented(base, replace(state, beside=()))
        sets.setdefault(of, {})[name] = Rival.of(model, model.free)
    unseen = new_in_every_record(left_out) if left_out else ""
    if all(len(members) < 2 for members in sets.values()):
        return None, unseen
    try:
        limits = Limits.of(records) if limits is None else limits
        excitations = candidates(limits, records[0].input.unit)
        found = next_experiment(sets, records, floor.rms, excitations)
    except InputError as error:
        return None, "; ".join(filter(None, [str(error), unseen]))
    return replace(found, left_out=tuple(left_out)), ""


def _alike(effect: str, ranking: Sequence[Candidate]) -> dict[str, ModelState]:
    """Give an effect and those that cannot be told from it, if there are any."""
    own = next((x for x in ranking if x.effect == effect), None)
    names = () if own is None else near(own, ranking)
    return {
        x.effect: x.state
        for x in ranking
        if names and x.effect in (effect, *names) and x.state is not None
    }

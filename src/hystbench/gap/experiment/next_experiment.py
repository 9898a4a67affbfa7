"""The next experiment: which excitation tells rival models apart, and by how much."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hystbench.errors import InputError
from hystbench.gap.experiment.excitations import Excitation, candidates
from hystbench.gap.experiment.limits import Limits
from hystbench.gap.experiment.separation import Pair, Sets, pairs_of, separations
from hystbench.record import Record

#: A pair that differs by so many floors is told apart: more of it helps no other pair.
CLEAR = 3.0
#: A pair that differs by less is not told apart.
TOLD = 1.0
#: Pairs that a sentence names: all of them are in the table.
NAMED = 3
REFITTED = "after both are refitted"


@dataclass(frozen=True, repr=False)
class Experiment:
    """The excitation that separates rivals best, those of all sets at once.

    Parameters
    ----------
    excitation : Excitation
    pairs : dict of Pair to float
        Separation of each pair of rivals, in noise floors.
    existing : dict of Pair to float
        The same for the existing record that is best for the pair.
    largest : dict of Pair to float
        The same for the excitation that is best for the pair.
    left_out : tuple of (str, str)
        Members of sets that no input brings out, each with the effect whose set it is.
    """

    excitation: Excitation
    pairs: dict[Pair, float]
    existing: dict[Pair, float]
    largest: dict[Pair, float]
    left_out: tuple[tuple[str, str], ...] = ()

    @property
    def separation(self) -> float:
        """Separation of the pair that is hardest to tell apart, in noise floors."""
        return min(self.pairs.values())

    @property
    def existing_separation(self) -> float:
        """What the existing records reach for the pair that is hardest for them."""
        return min(self.existing.values())

    @property
    def sentence(self) -> str:
        """What to do and what it gives, in words."""
        told = self._of_one() if len(self.pairs) == 1 else self._of_many()
        if not self.left_out:
            return told
        return f"{told} {new_in_every_record(self.left_out)}."

    def _of_one(self) -> str:
        ((pair, size),) = self.pairs.items()
        names, now, best = self._words(pair), self.existing[pair], self.excitation.words
        if now >= max(size, TOLD):
            return (
                f"The existing records tell {names} by {now:.2g} noise floors "
                f"{REFITTED}; the best feasible excitation, {best}, reaches {size:.2g}."
            )
        if size < TOLD:
            return (
                f"No feasible excitation tells {names}: the best, {best}, separates "
                f"them by {size:.2g} noise floors {REFITTED}."
            )
        return (
            f"Try {best}: it separates {names} by {size:.2g} noise floors {REFITTED}; "
            f"the best of the existing records reaches {now:.2g}."
        )

    def _of_many(self) -> str:
        best, count = self.excitation.words, len(self.pairs)
        told = [pair for pair, size in self.pairs.items() if size >= TOLD]
        if told:
            lead = f"Try {best}"
            if _merit(self.existing) >= _merit(self.pairs):
                lead = (
                    "Over all pairs the existing records do as well as the best "
                    f"feasible excitation, {best}"
                )
            many = f"all {count}" if len(told) == count else f"{len(told)} of {count}"
            shown = min(told, key=lambda pair: self.pairs[pair])
            found = [
                f"{lead}: it separates {many} pairs by a noise floor or more "
                f"{REFITTED}, {self._words(shown)} least, by {self.pairs[shown]:.2g}"
            ]
        else:
            shown = max(self.pairs, key=lambda pair: self.pairs[pair])
            found = [
                f"The best excitation for all {count} pairs, {best}, tells none: it "
                f"separates {self._words(shown)} most, by {self.pairs[shown]:.2g} "
                f"noise floors {REFITTED}"
            ]
        now = self.existing[shown]
        found[0] += f"; the best of the existing records reaches {now:.2g}."
        rest = [pair for pair in self.pairs if pair not in told]
        known = [pair for pair in rest if self.existing[pair] >= TOLD]
        unknown = [pair for pair in rest if pair not in known]
        never = [pair for pair in unknown if self.largest[pair] < TOLD]
        other = [pair for pair in unknown if pair not in never]
        if known:
            found.append(f"The existing records tell {self._listed(known, 'and')}.")
        if never:
            found.append(f"No feasible excitation tells {self._listed(never)}.")
        if other:
            found.append(f"Another excitation would tell {self._listed(other)}.")
        return " ".join(found)

    def _words(self, pair: Pair) -> str:
        several = len({each.of for each in self.pairs}) > 1
        place = f" in the place of {pair.of}" if several else ""
        return " from ".join(pair.names) + place

    def _listed(self, pairs: Sequence[Pair], last: str = "or") -> str:
        shown = [self._words(pair) for pair in pairs[:NAMED]]
        more = len(pairs) - len(shown)
        if more:
            return f"{', '.join(shown)} and {more} more"
        return f" {last} ".join(shown)

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``next_experiment``."""
        return {
            "excitation": self.excitation.kind,
            "parameters": {
                name: {"value": value, "unit": unit}
                for name, (value, unit) in self.excitation.parameters.items()
            },
            "sampling_interval_s": self.excitation.dt,
            "separation": self.separation,
            "existing_separation": self.existing_separation,
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
    limits: Limits | None = None,
    excitations: Sequence[Excitation] | None = None,
) -> Experiment:
    """Choose the excitation that tells rival models apart best.

    Parameters
    ----------
    sets : mapping of str to mapping of str to Rival
        By the effect that they are rivals of, and by name; each fitted to the records.
        Those of one set are to be told apart.
    records : sequence of Record
        The fit records: what they separate is the measure, and their inputs are the
        limits where none are given.
    noise_floor : float
        RMS in output units, above zero.
    limits : Limits, optional
    excitations : sequence of Excitation, optional
        Instead of :func:`~hystbench.gap.experiment.excitations.candidates`.

    Returns
    -------
    Experiment
        Of the excitations that tell most pairs apart, the one that separates all pairs
        most, each counted up to ``CLEAR``; of equals, the hardest pair decides.

    Raises
    ------
    InputError
        If no set has two rivals, there is no noise floor, or no excitation keeps within
        the limits and lets every rival run.
    """
    every = pairs_of(sets)
    if not every:
        raise InputError(
            "next experiment: no set has two rival models; expected one that has"
        )
    if not noise_floor > 0:
        raise InputError(f"noise floor: {noise_floor:g}; expected above 0")
    if excitations is None:
        limits = Limits.of(records) if limits is None else limits
        excitations = candidates(limits, records[0].input.unit)
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


def _merit(pairs: dict[Pair, float]) -> tuple[int, float, float]:
    """Rank by pairs told apart, then by how clearly, then by the hardest."""
    sizes = list(pairs.values())
    told = sum(size >= TOLD for size in sizes)
    return told, sum(min(size, CLEAR) for size in sizes), min(sizes)

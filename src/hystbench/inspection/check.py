"""A dataset looked at: what each record is like, what is wrong, what it can reveal."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.dataset import Dataset
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.gap.records.floor import Floor, noise_floor
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.records.unlike import Unlike, unlike_the_others
from hystbench.inspection.base import Base, base_of
from hystbench.inspection.facts import Facts, facts_of, late
from hystbench.inspection.findings import KIND_ORDER, Finding, finding
from hystbench.inspection.model_findings import model_findings
from hystbench.inspection.record_findings import entry_with, record_findings
from hystbench.inspection.same_input import FAR_APART, SameInput, same_inputs
from hystbench.inspection.visible import SmallestSeen, seen_effects
from hystbench.metrics import rms
from hystbench.record import Record

SAME_RATIO = 2.0
"""Ratio of the fastest rate to the slowest below which records are of one rate."""
ONE_RATE = ("sine", "ramps")
"""Kinds of input of which a record has one rate, or few."""


@dataclass(frozen=True, eq=False)
class Check:
    """A dataset that was looked at."""

    dataset: Dataset
    records: tuple[Record, ...]
    facts: tuple[Facts, ...]
    """Facts, in their order."""
    floor: Floor
    base: Base
    """What effects are judged beside."""
    findings: tuple[Finding, ...]
    effects: tuple[SmallestSeen, ...]
    """Empty where they were not simulated: not asked for, or no base to judge them
    on."""

    @property
    def revealed(self) -> tuple[SmallestSeen, ...]:
        """Effects that show before they are a tenth of the output."""
        return tuple(item for item in self.effects if item.revealed)

    @property
    def hidden(self) -> tuple[SmallestSeen, ...]:
        """The others."""
        return tuple(x for x in self.effects if x.judged and not x.revealed)

    @property
    def judged(self) -> tuple[SmallestSeen, ...]:
        """Effects that were simulated on the records."""
        return tuple(item for item in self.effects if item.judged)

    @property
    def unjudged(self) -> tuple[SmallestSeen, ...]:
        """Effects of which nothing is said here."""
        return tuple(item for item in self.effects if not item.judged)


def check(dataset: Dataset, effects: bool = True, model: str = "") -> Check:
    """Look at all records of a dataset.

    Parameters
    ----------
    dataset : Dataset
    effects : bool
        Whether to simulate them, which takes most of the time. On a loop of play
        operators that does not fit none are.
    model : str
        As of ``hystbench gap --model``: effects are judged beside it. By default
        beside a loop of play operators that is fitted to the records.

    Raises
    ------
    InputError
        If a record cannot be read, one held out is a copy of one to fit, or the model
        is none of these records.
    """
    records = tuple(dataset.read(name) for name in dataset.record_files)
    unlike = unlike_the_others(records)
    base = base_of(dataset, records, model, [item.name for item in unlike])
    facts = tuple(facts_of(dataset, item) for item in base.whole)
    periods = {item.name: item.period for item in facts}
    floor = noise_floor(
        [_repeating(item, periods) for item in base.fit],
        dataset.about.get("noise_rms"),
    )
    found = [
        *_findings(dataset, records, facts, floor, unlike),
        *model_findings(dataset, base),
    ]
    return Check(
        dataset,
        records,
        facts,
        floor,
        base,
        tuple(sorted(found, key=lambda item: KIND_ORDER.index(item.kind))),
        seen_effects(
            base.model,
            [item.record for item in base.fit],
            floor.rms,
            dataset.input_hold,
        )
        if effects and (base.given or base.fits)
        else (),
    )


def _repeating(item: Compared, periods: Mapping[str, int | None]) -> Compared:
    """Give a record with the period that was found; a window of one has none."""
    period = periods.get(item.record.name)
    return replace(item, record=replace(item.record, period_samples=period))


def _findings(
    dataset: Dataset,
    records: Sequence[Record],
    facts: Sequence[Facts],
    floor: Floor,
    unlike: Sequence[Unlike],
) -> list[Finding]:
    """Say what a reader should know of the records."""
    both = list(zip(records, facts, strict=True))
    found = [each for pair in both for each in record_findings(dataset, *pair)]
    found += [finding("unlike", name=x.name, line=x.words) for x in unlike]
    spoilt = {item.name for item in unlike}
    new = [item for item in facts if item.period and not item.declared]
    if new:
        told = ", ".join(f"{item.name} every {item.period} samples" for item in new)
        lines = [
            entry_with(dataset, item.name, period_samples=item.period) for item in new
        ]
        topic = "steady" if "noise_rms" in dataset.about else "periods"
        found.append(finding(topic, told=told, paste=lines))
    found += [finding("no period", **vars(x)) for x in facts if not x.repeats]
    found += [
        finding(
            "late" if by > 0 else "early",
            name=item.name,
            ms=1e3 * abs(by),
            samples=abs(by) / item.dt,
        )
        for item, by in late([item for item in facts if item.name not in spoilt])
    ]
    twice = same_inputs(records)
    if twice and floor.method == "upper-bound":
        found.append(_of_one_input(twice, records[0].output.unit))
    found += [
        finding("apart", name=x.other, times=x.rms / floor.rms, **x._asdict())
        for x in twice
        if floor.method != "upper-bound" and x.rms > FAR_APART * floor.rms
    ]
    fit = [item.input for item in facts if item.use == "fit"]
    rates, spans = ([x.rate for x in fit], [round(x.span, 12) for x in fit])
    alone = all(item.kind in ONE_RATE for item in fit)
    on_the_whole = {
        "none held out": all(item.use == "fit" for item in facts),
        "no noise": floor.method == "upper-bound" and not twice,
        "one rate": alone and max(rates) < SAME_RATIO * min(rates),
        "one amplitude": max(spans) < SAME_RATIO * min(x.least_swing for x in fit),
    }
    found += [finding(topic) for topic, holds in on_the_whole.items() if holds]
    try:
        found += [finding("doubt", line=line) for line in doubts(dataset, records)]
    except InputError as error:
        found.append(finding("refused", line=str(error)))
    return found


def _of_one_input(twice: Sequence[SameInput], unit: str) -> Finding:
    """Say what noise the records tell that share an input."""
    noise = rms(np.array([item.noise for item in twice]))
    told = "; ".join(f"{x.first} and {x.other} have the same input" for x in twice)
    lines = [f"noise_rms: {noise:.3g}"]
    return finding("same input", lines, told=told, noise=noise, unit=unit)

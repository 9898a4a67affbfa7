"""A dataset looked at: what each record is like, what is wrong, what it can reveal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hystbench.dataset import Dataset
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.gap.records.floor import Floor, noise_floor
from hystbench.gap.records.sample import Compared, rms
from hystbench.inspection.base import loop_of_plays
from hystbench.inspection.facts import Facts, facts_of, late
from hystbench.inspection.flat import flats
from hystbench.inspection.visible import Seen, runs, seen_effects
from hystbench.inspection.writing import entry_text
from hystbench.model import Model
from hystbench.record import Record

ALIKE = 2.0
"""Ratio of the fastest rate to the slowest below which records are of one rate."""
TOO_FAR = (
    " The input is missing for more than a quarter of its fastest period, which no "
    "straight line can stand for: give the parts between as 'rows'."
)
JITTERS = 0.01
"""Of a step: a clock that is less even than that is told."""


@dataclass(frozen=True)
class Finding:
    """One thing that a reader should know.

    Parameters
    ----------
    kind : {"wrong", "missing", "note"}
        Refused by ``hystbench gap``; to be added to dataset.yaml; good to know.
    text : str
    paste : tuple of str
        Lines for dataset.yaml that mend it.
    topic : str
        Findings of one topic say the same of several records.
    record : str
        Whom it concerns; empty where that is no single record.
    """

    kind: str
    text: str
    paste: tuple[str, ...] = ()
    topic: str = ""
    record: str = ""


@dataclass(frozen=True, eq=False)
class Check:
    """A dataset that was looked at.

    Parameters
    ----------
    dataset : Dataset
    records : tuple of Record
        With the periods that were found.
    facts : tuple of Facts
        In their order.
    floor : Floor
    base : Model
        Beside which effects were simulated.
    left : float
        Rms of what it leaves on the fit records, in the output's unit.
    findings : tuple of Finding
    effects : tuple of Seen
        None where they were not simulated.
    """

    dataset: Dataset
    records: tuple[Record, ...]
    facts: tuple[Facts, ...]
    floor: Floor
    base: Model
    left: float
    findings: tuple[Finding, ...]
    effects: tuple[Seen, ...]

    @property
    def revealed(self) -> tuple[Seen, ...]:
        """Effects that show before they are a tenth of the output."""
        return tuple(item for item in self.effects if item.revealed)

    @property
    def hidden(self) -> tuple[Seen, ...]:
        """The others."""
        return tuple(item for item in self.effects if not item.revealed)


def check(dataset: Dataset, effects: bool = True) -> Check:
    """Look at all records of a dataset.

    Parameters
    ----------
    dataset : Dataset
    effects : bool
        Whether to simulate them, which takes most of the time.

    Raises
    ------
    InputError
        If a record cannot be read, or one held out is a copy of one to fit.
    """
    records = tuple(dataset.read(name) for name in dataset.record_files)
    fit = [record for record in records if record.use == "fit"]
    base = loop_of_plays(fit)
    hold = dataset.about["input"].get("hold", "band-limited")
    outputs = runs(base, records, hold)
    compared = [Compared(*pair) for pair in zip(records, outputs, strict=True)]
    facts = tuple(facts_of(dataset, item) for item in compared)
    compared = [
        replace(item, record=replace(item.record, period_samples=about.period))
        for item, about in zip(compared, facts, strict=True)
    ]
    to_fit = [item for item in compared if item.record.use == "fit"]
    floor = noise_floor(to_fit, dataset.about.get("noise_rms"))
    left = rms(np.concatenate([x.residual[x.record.counted] for x in to_fit]))
    return Check(
        dataset,
        tuple(item.record for item in compared),
        facts,
        floor,
        base,
        left,
        tuple(_findings(dataset, records, facts, floor)),
        seen_effects(base, [item.record for item in to_fit], floor.rms, hold)
        if effects
        else (),
    )


def _findings(
    dataset: Dataset, records: Sequence[Record], facts: Sequence[Facts], floor: Floor
) -> list[Finding]:
    found = [
        *_stuck(dataset, records, facts),
        *_flat(dataset, records, facts),
        *_periods(dataset, facts),
    ]
    for item in facts:
        if item.missing:
            found.append(
                Finding(
                    "note",
                    f"{item.name}: {item.missing} of {item.samples} samples are "
                    "missing and interpolated; no score counts them."
                    + TOO_FAR
                    * item.bridged_too_far,
                    topic="missing",
                    record=item.name,
                )
            )
        if item.jitter is not None and item.jitter > JITTERS:
            found.append(
                Finding(
                    "note",
                    f"{item.name}: the steps of time differ by "
                    f"{100 * item.jitter:.2g} % rms of their mean; the mean is taken.",
                    topic="jitter",
                    record=item.name,
                )
            )
    for item in late(facts):
        samples = item.delay_s / item.dt
        found.append(
            Finding(
                "note",
                f"{item.name}: its output is {1e3 * item.delay_s:.3g} ms "
                f"({samples:+.1f} samples) behind a loop that does not depend on the "
                "rate; the delays of the others do not foretell that: was its trigger "
                "late?",
                topic="late",
                record=item.name,
            )
        )
    found += _on_the_whole(dataset, facts, floor)
    try:
        found += [
            Finding("note", line, topic="doubt") for line in doubts(dataset, records)
        ]
    except InputError as error:
        found.append(Finding("wrong", str(error)))
    order = ("wrong", "missing", "note")
    return sorted(found, key=lambda item: order.index(item.kind))


def _stuck(
    dataset: Dataset, records: Sequence[Record], facts: Sequence[Facts]
) -> list[Finding]:
    """Say which records look stuck or clipped."""
    found = []
    for record, item in zip(records, facts, strict=True):
        if not item.stuck:
            continue
        of_input = item.stuck.partition(": ")[2].startswith(record.input.name)
        channel = "input" if of_input else "output"
        entry = {**dataset.entry(item.name), "stands_still": [channel]}
        text = f"{item.name}: {item.stuck}. Leave it out, or where it is real write:"
        found.append(Finding("wrong", text, (_entry(entry),), "stuck", item.name))
    return found


def _flat(
    dataset: Dataset, records: Sequence[Record], facts: Sequence[Facts]
) -> list[Finding]:
    """Say which channels repeat a value exactly, where 'hystbench gap' takes them."""
    found = []
    for record, item in zip(records, facts, strict=True):
        said = dataset.stands_still(item.name)
        on_purpose = item.excitation.kind in ("steps", "ramps")
        for key, channel, values in (
            ("input", record.input, record.u),
            ("output", record.output, record.y),
        ):
            if item.stuck or key in said or (key == "input" and on_purpose):
                continue
            for flat in flats(values):
                text = (
                    f"{item.name}: {channel.name} is exactly {flat.value:g} "
                    f"{channel.unit} for {flat.samples} samples in {flat.stretches} "
                    f"stretches, the first from sample {flat.first + 1} on: it looks "
                    f"{flat.kind}. 'hystbench gap' takes it; mend it or leave it out."
                )
                topic = f"{flat.kind} {key}"
                found.append(Finding("note", text, (), topic, item.name))
    return found


def _periods(dataset: Dataset, facts: Sequence[Facts]) -> list[Finding]:
    """Say which periods were found and are to be written."""
    new = [item for item in facts if item.period and not item.declared]
    if not new:
        return []
    told = ", ".join(f"{item.name} every {item.period} samples" for item in new)
    lines = tuple(
        _entry({**dataset.entry(item.name), "period_samples": item.period})
        for item in new
    )
    text = f"inputs repeat themselves: {told}. So the noise can be measured; write:"
    return [Finding("missing", text, lines)]


def _on_the_whole(
    dataset: Dataset, facts: Sequence[Facts], floor: Floor
) -> list[Finding]:
    """Say what holds of all records together."""
    found = []
    if not any(item.use == "hold-out" for item in facts):
        found.append(
            Finding(
                "missing",
                "no record is held out, and 'hystbench gap' needs one. Best is one of "
                "another kind than the others:",
                ("use: hold-out",),
            )
        )
    if floor.method == "upper-bound":
        found.append(
            Finding(
                "missing",
                "no record repeats its input and no noise is declared: the noise below "
                "is an upper bound, and 'no gap' can never be said. Measure one record "
                "with its input twice in a row, or say its rms while the input stands:",
                ("noise_rms: ...",),
            )
        )
    rates = [item.excitation.rate for item in facts if item.use == "fit"]
    if max(rates) < ALIKE * min(rates):
        found.append(
            Finding(
                "note",
                "all records to fit are of about one rate: what depends on the rate "
                "shows in them only by the shape of the loop.",
            )
        )
    levels = {round(item.excitation.span, 12) for item in facts if item.use == "fit"}
    if max(levels) < ALIKE * min(levels):
        found.append(
            Finding(
                "note",
                "all records to fit are of about one amplitude: what depends on it "
                "shows in them only by the shape of the loop.",
            )
        )
    return found


def _entry(entry: dict[str, Any]) -> str:
    return f"- {entry_text(entry)}"

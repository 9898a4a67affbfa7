"""What looks wrong of one record by itself: lone samples, flats, holes, the clock."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from hystbench.dataset import Dataset
from hystbench.flat import flats, held_for
from hystbench.inspection.entries import entry_text
from hystbench.inspection.facts import Facts
from hystbench.inspection.findings import Finding, finding
from hystbench.inspection.lone import lone_samples
from hystbench.record import Record
from hystbench.sentences import MAKE_MISSING, listed

UNEVEN_SHARE = 0.01
"""Share of a step: a clock that is less even than that is told."""
PLACES = 5
"""Places of lone samples that are named; more of them are counted."""


def record_findings(
    dataset: Dataset, record: Record, facts: Facts
) -> Iterator[Finding]:
    """Say what looks wrong of a record by itself.

    Parameters
    ----------
    dataset : Dataset
    record : Record
    facts : Facts
        Of the record.
    """
    lone = lone_samples(record)
    if facts.stuck:
        of_input = facts.stuck.partition(": ")[2].startswith(record.input.name)
        channels = ["input" if of_input else "output"]
        line = entry_with(dataset, facts.name, stands_still=channels)
        yield finding("stuck", paste=[line], **vars(facts))
    given = ("input", record.input, record.u), ("output", record.output, record.y)
    for key, channel, values in given:
        said = vars(channel) | {"channel": channel.name, "name": facts.name}
        if lone[key]:
            # The file is to change, and so is its SHA-256.
            line = entry_with(dataset, facts.name, missing="interpolate", sha256=None)
            places = _places(dataset, record.name, lone[key])
            made = finding("lone", [line], places=places, mend=MAKE_MISSING, **said)
            # Not with those of other records: each has its own places.
            yield replace(made, topic=f"lone {key} of {facts.name}")
        if facts.stuck or key in dataset.stands_still(facts.name):
            continue
        if key == "input" and facts.input.kind in ("steps", "ramps"):
            continue  # it stands still on purpose
        if key == "output" and (every := _read_every(record)) > 1:
            yield finding("held", every=every, **said)
            continue
        for flat in flats(values):
            if any(first <= flat.first < behind for first, behind in lone[key]):
                continue
            more = f" in {flat.stretches} stretches, the first" * (flat.stretches > 1)
            made = finding("flat", flat=flat, first=flat.first + 1, more=more, **said)
            yield replace(made, topic=f"{flat.kind} {key}")
    if facts.missing:
        far = " too far" * facts.bridged_too_far
        yield replace(finding(f"bridged{far}", **vars(facts)), topic="missing")
    if facts.jitter is not None and facts.jitter > UNEVEN_SHARE:
        yield finding("jitter", name=facts.name, percent=100 * facts.jitter)


def _read_every(record: Record) -> int:
    """Give the samples in which an output is read once; one where each may be new.

    Where its input stands as long, the device may follow that at once.
    """
    every = held_for(record.y)
    return every if math.gcd(every, held_for(record.u)) == 1 else 1


def _places(dataset: Dataset, name: str, stretches: list[tuple[int, int]]) -> str:
    """Name stretches of a record as a reader of its file finds them."""
    table, _, rows = dataset.columns(name)
    told = []
    for first, behind in stretches[:PLACES]:
        ends = [table.place(rows.start + at) for at in (first, behind - 1)]
        number = ends[1].rpartition(" ")[2]
        told.append(ends[0] + f" to {number}" * (behind > first + 1))
    more = len(stretches) - PLACES
    return listed([*told, f"{more} more places"] if more > 0 else told)


def entry_with(dataset: Dataset, name: str, **more: Any) -> str:
    """Give a record's line of dataset.yaml with what it should say too.

    What is None is left out.
    """
    entry = {**dataset.entry(name), **more}
    kept = {key: value for key, value in entry.items() if value is not None}
    return f"- {entry_text(kept)}"

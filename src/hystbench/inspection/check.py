"""A dataset looked at: what each record is like, what is wrong, what it can reveal."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks import block_class
from hystbench.dataset import Dataset
from hystbench.doubts import doubts
from hystbench.errors import InputError
from hystbench.flat import flats
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.records.floor import Floor, noise_floor
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.thresholds import LOOSE
from hystbench.inspection.entries import entry_text
from hystbench.inspection.facts import Facts, facts_of, late
from hystbench.inspection.same_input import FAR_APART, SameInput, same_inputs
from hystbench.inspection.visible import SmallestSeen, seen_effects
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.operators import play
from hystbench.record import Record
from hystbench.yaml_files import load_yaml

SAME_RATIO = 2.0
"""Ratio of the fastest rate to the slowest below which records are of one rate."""
ONE_RATE = ("sine", "ramps")
"""Kinds of input of which a record has one rate, or few."""
UNEVEN_SHARE = 0.01
"""Share of a step: a clock that is less even than that is told."""
PLAY_OPERATORS = 10
"""Play operators, the first of threshold zero: the input itself."""


@dataclass(frozen=True)
class Finding:
    """One thing that a reader should know."""

    kind: str
    """``wrong``: ``hystbench gap`` refuses it; ``missing``: dataset.yaml lacks it; or
    ``note``."""
    text: str
    paste: tuple[str, ...] = ()
    """Lines for dataset.yaml that mend it."""
    topic: str = ""
    """Findings of one topic say the same of several records."""
    record: str = ""
    """Whom it concerns; empty where that is no single record."""


@dataclass(frozen=True, eq=False)
class Check:
    """A dataset that was looked at."""

    dataset: Dataset
    records: tuple[Record, ...]
    """Records, with the periods that were found."""
    facts: tuple[Facts, ...]
    """Facts, in their order."""
    floor: Floor
    left: float
    """Rms of what it leaves on the fit records, in the output's unit."""
    findings: tuple[Finding, ...]
    effects: tuple[SmallestSeen, ...]
    """Empty where they were not simulated."""

    @property
    def share_left(self) -> float:
        """Share of the output's rms on the fit records, about its mean, of ``left``."""
        outputs = [x.y[x.counted] for x in self.records if x.use == "fit"]
        power = float(np.mean([np.var(y) for y in outputs]))
        return self.left / np.sqrt(power) if power > 0 else 0.0

    @property
    def fits(self) -> bool:
        """Whether the loop is a base to judge effects on.

        It is none where it leaves half of the output's rms.
        """
        return self.share_left**2 <= LOOSE

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
    hold = dataset.input_hold
    outputs = run_base(base, records, hold)
    compared = [Compared(*pair) for pair in zip(records, outputs, strict=True)]
    facts = tuple(facts_of(dataset, item) for item in compared)
    compared = [
        replace(item, record=replace(item.record, period_samples=about.period))
        for item, about in zip(compared, facts, strict=True)
    ]
    to_fit = [item for item in compared if item.record.use == "fit"]
    floor = noise_floor(to_fit, dataset.about.get("noise_rms"))
    left = rms(*(x.residual[x.record.counted] for x in to_fit))
    return Check(
        dataset,
        tuple(item.record for item in compared),
        facts,
        floor,
        left,
        tuple(_findings(dataset, records, facts, floor)),
        seen_effects(base, [item.record for item in to_fit], floor.rms, hold)
        if effects
        else (),
    )


def loop_of_plays(records: Sequence[Record]) -> Model:
    """Fit a gain, an offset and play operators to records, by least squares.

    ``y = g (u + sum_i w_i P_i[u]) + c``: a hysteresis that does not depend on the rate.

    Parameters
    ----------
    records : sequence of Record
        All of one input and output.

    Returns
    -------
    Model
        A ``prandtl-ishlinskii`` block and a ``gain``.
    """
    amplitude = max(float(np.abs(record.u).max()) for record in records)
    thresholds = amplitude * np.arange(PLAY_OPERATORS) / PLAY_OPERATORS
    tables, outputs = [], []
    for record in records:
        plays = play(record.u, thresholds)
        weight = 1 / np.sqrt(len(record))  # a record counts once, however long
        tables.append(weight * np.column_stack([np.ones(len(record)), plays]))
        outputs.append(weight * record.y)
    table, y = np.vstack(tables), np.concatenate(outputs)
    size = np.linalg.norm(table, axis=0)
    size[size == 0] = 1.0
    offset, *weights = np.linalg.lstsq(table / size, y, rcond=1e-6)[0] / size
    reach = max(float(np.ptp(r.y)) for r in records) / (2 * amplitude)
    gain = max(abs(sum(weights)), 1e-3 * reach)
    shares = np.array(weights) / gain
    shares[0] -= 1.0  # the block has the input itself beside its operators
    return Model(
        "loop of play operators",
        records[0].input,
        records[0].output,
        (
            block_class("prandtl-ishlinskii").from_mapping(
                {"thresholds": thresholds.tolist(), "weights": shares.tolist()}
            ),
            block_class("gain").from_mapping({"value": gain, "offset": float(offset)}),
        ),
    )


def _findings(
    dataset: Dataset, records: Sequence[Record], facts: Sequence[Facts], floor: Floor
) -> list[Finding]:
    """Say what a reader should know, what is refused first; words are in check.yaml."""
    both = list(zip(records, facts, strict=True))
    found = [each for pair in both for each in _still(dataset, *pair)]
    new = [item for item in facts if item.period and not item.declared]
    if new:
        told = ", ".join(f"{item.name} every {item.period} samples" for item in new)
        lines = [_entry(dataset, item.name, period_samples=item.period) for item in new]
        topic = "steady" if "noise_rms" in dataset.about else "periods"
        found.append(_finding(topic, told=told, paste=lines))
    found += [_finding("no period", **vars(x)) for x in facts if not x.repeats]
    found += [each for item in facts for each in _holes(item)]
    found += [
        _finding(
            "late" if by > 0 else "early",
            name=item.name,
            ms=1e3 * abs(by),
            samples=abs(by) / item.dt,
        )
        for item, by in late(facts)
    ]
    twice = same_inputs(records)
    if twice and floor.method == "upper-bound":
        found.append(_of_one_input(twice, records[0].output.unit))
    found += [
        _finding("apart", name=x.other, times=x.rms / floor.rms, **x._asdict())
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
    found += [_finding(topic) for topic, holds in on_the_whole.items() if holds]
    try:
        found += [_finding("doubt", line=line) for line in doubts(dataset, records)]
    except InputError as error:
        found.append(_finding("refused", line=str(error)))
    order = ("wrong", "missing", "note")
    return sorted(found, key=lambda item: order.index(item.kind))


def _of_one_input(twice: Sequence[SameInput], unit: str) -> Finding:
    """Say what noise the records tell that share an input."""
    noise = rms(np.array([item.noise for item in twice]))
    told = "; ".join(f"{x.first} and {x.other} have the same input" for x in twice)
    lines = [f"noise_rms: {noise:.3g}"]
    return _finding("same input", lines, told=told, noise=noise, unit=unit)


def _still(dataset: Dataset, record: Record, item: Facts) -> Iterator[Finding]:
    """Say which channels of a record are stuck or clipped."""
    if item.stuck:
        of_input = item.stuck.partition(": ")[2].startswith(record.input.name)
        channels = ["input" if of_input else "output"]
        line = _entry(dataset, item.name, stands_still=channels)
        yield _finding("stuck", paste=[line], **vars(item))
    given = ("input", record.input, record.u), ("output", record.output, record.y)
    for key, channel, values in given:
        on_purpose = key == "input" and item.input.kind in ("steps", "ramps")
        if item.stuck or on_purpose or key in dataset.stands_still(item.name):
            continue
        for flat in flats(values):
            said = vars(channel) | {"channel": channel.name, "name": item.name}
            made = _finding("flat", flat=flat, first=flat.first + 1, **said)
            yield replace(made, topic=f"{flat.kind} {key}")


def _holes(item: Facts) -> Iterator[Finding]:
    """Say of a record that samples are missing, or its clock is uneven."""
    if item.missing:
        far = " too far" * item.bridged_too_far
        yield replace(_finding(f"bridged{far}", **vars(item)), topic="missing")
    if item.jitter is not None and item.jitter > UNEVEN_SHARE:
        yield _finding("jitter", name=item.name, percent=100 * item.jitter)


def _finding(topic: str, paste: Sequence[str] = (), **told: Any) -> Finding:
    """Give a finding in the words of check.yaml, filled with what is told."""
    about = _words()[topic]
    lines = tuple(paste or about.get("paste", ()))
    text = about["text"].format(**told)
    return Finding(about["kind"], text, lines, topic, told.get("name", ""))


@cache
def _words() -> dict[str, Any]:
    found: dict[str, Any] = load_yaml(Path(__file__).with_suffix(".yaml"))
    return found


def _entry(dataset: Dataset, name: str, **more: Any) -> str:
    """Give a record's line of dataset.yaml with what it should say too."""
    return f"- {entry_text({**dataset.entry(name), **more})}"

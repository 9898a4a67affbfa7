"""The base that effects are judged beside, run on all records: a model, or a loop."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hystbench.blocks import block_class
from hystbench.dataset import Dataset
from hystbench.gap.bases.kinds import IDENTIFIED
from hystbench.gap.bases.lead import begun_beside, without_leads
from hystbench.gap.bases.linear import is_identified_linear
from hystbench.gap.bases.load import load_base
from hystbench.gap.bases.orders import LEAD
from hystbench.gap.bases.output_error import own_columns
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.records.evidence import evidence_of
from hystbench.gap.records.scored_samples import Compared, without
from hystbench.gap.thresholds import LOOSE
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.operators import play
from hystbench.record import FloatArray, Record

USES = ("fit", "hold-out")
LOOP = "the loop of play operators"
"""What sentences call a base that nobody gave."""
PLAY_OPERATORS = 10
"""Play operators, the first of threshold zero: the input itself."""


@dataclass(frozen=True, eq=False)
class Base:
    """A model on all records."""

    model: Model
    given: str
    """What ``--model`` says; empty of a loop of play operators that is fitted here."""
    note: str
    """Where a given model comes from."""
    whole: tuple[Compared, ...]
    """All records, as they were measured."""
    fit: tuple[Compared, ...]
    """Those to fit, as ``hystbench gap`` takes them: of a free mass cut in windows.
    A loop of play operators is fitted to no spoilt one."""

    behind: float | None = None
    """Rms of what an identified linear base leaves of what it was fitted to: the fit
    records behind the first tenth of each, without an offset of each, where it had
    one."""

    @property
    def identified(self) -> bool:
        """Whether it was identified from the records to fit."""
        return self.given in IDENTIFIED

    @property
    def called(self) -> str:
        """What sentences call it."""
        return f"the model {self.model.name!r}" if self.given else LOOP

    @cached_property
    def left(self) -> float:
        """Rms of what it leaves of the records to fit, in the output's unit."""
        return left_of(self.fit)

    @cached_property
    def moves(self) -> float:
        """Rms of the outputs to fit, each about its mean."""
        outputs = (item.record.y[item.record.counted] for item in self.fit)
        return rms(*(np.asarray(y - y.mean()) for y in outputs))

    @property
    def share_left(self) -> float:
        """Share of the rms of the outputs to fit that it leaves."""
        return self.left / self.moves if self.moves > 0 else 0.0

    @property
    def fits(self) -> bool:
        """Whether it leaves less than half of the output's rms."""
        return self.share_left**2 <= LOOSE


def left_of(compared: Sequence[Compared]) -> float:
    """Give the rms of what is left of records, in the output's unit."""
    return rms(*(item.residual[item.record.counted] for item in compared))


def base_of(
    dataset: Dataset,
    records: Sequence[Record],
    given: str = "",
    spoilt: Collection[str] = (),
) -> Base:
    """Give the base of a check, run once on all records.

    Parameters
    ----------
    dataset : Dataset
    records : sequence of Record
        All of the dataset, as they were read.
    given : str
        As of ``hystbench gap --model``; by default a loop of play operators is fitted.
    spoilt : collection of str
        Names of records that this loop is not fitted to: it would fit no other.

    Raises
    ------
    InputError
        If the model is none of these records, or does not stay bounded on one.
    """
    hold = dataset.input_hold
    if not given:
        to_fit = [record for record in records if record.use == "fit"]
        sound = [record for record in to_fit if record.name not in spoilt] or to_fit
        base = loop_of_plays(sound)
        outputs = run_base(base, tuple(records), hold)
        pairs = zip(records, outputs, strict=True)
        whole = tuple(Compared(record, y) for record, y in pairs)
        chosen = {record.name for record in sound}
        fit = tuple(item for item in whole if item.record.name in chosen)
        return Base(base, given, "", whole, fit)
    evidence = evidence_of(dataset, records)
    base, note = load_base(given, evidence)
    begun = tuple(
        item
        for use in (evidence.fit, evidence.hold_out)
        for item in without_leads(begun_beside(base, use), base, evidence)
    )
    outputs = run_base(base, begun, hold)
    compared = [
        Compared(item.as_measured, y[item.past :])
        for item, y in zip(begun, outputs, strict=True)
    ]
    fit = tuple(compared[: len(evidence.fit)])
    behind = None
    if is_identified_linear(base):
        behind = rms(*(_behind(item, evidence.own_offsets) for item in fit))
    whole = tuple(_put_together(records, compared))
    return Base(base, given, note, whole, fit, behind)


def _behind(item: Compared, own_offsets: bool) -> FloatArray:
    """Give what is left of a record behind its first tenth and apart from its own."""
    record = item.record
    late = record.counted & (np.arange(len(record)) >= LEAD * len(record))
    (own,) = own_columns([record], own_offsets)
    return without((record.y - item.simulated)[late], own[late])


def _put_together(
    records: Sequence[Record], parts: Sequence[Compared]
) -> Iterator[Compared]:
    """Give whole records of the windows that they were cut into, if they were.

    One that was not cut keeps what scores leave out of its beginning.
    """
    left = {use: iter([x for x in parts if x.record.use == use]) for use in USES}
    for record in records:
        simulated: list[FloatArray] = []
        begun = record
        while sum(map(len, simulated)) < len(record):
            part = next(left[record.use])
            if len(part.record) == len(record):
                lead, poles = part.record.lead, part.record.start_poles
                begun = replace(record, lead=lead, start_poles=poles)
            first = sum(map(len, simulated))
            zero = record.y[first] - part.record.y[0]
            simulated.append(part.simulated + zero)
        yield Compared(begun, np.concatenate(simulated))


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

"""What looks wrong of a model that is given: how much it leaves, and why it may."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.base import Block
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import OUTPUTS, Mechanism
from hystbench.blocks.structure import Structure
from hystbench.dataset import Dataset
from hystbench.errors import InputError
from hystbench.gap.bases.kinds import kind_of_base
from hystbench.gap.bases.lead import lead_warnings
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.thresholds import AS_GOOD, LOOSE, WORTH_A_WORD
from hystbench.inspection.base import Base, left_of
from hystbench.inspection.entries import flow
from hystbench.inspection.findings import Finding, finding
from hystbench.model import Model
from hystbench.record import FloatArray
from hystbench.sentences import listed
from hystbench.units import by_thousands

REPEATING = "repeating"
"""The start of a block on whole periods, in a steady state."""


def model_findings(dataset: Dataset, base: Base) -> Iterator[Finding]:
    """Say what looks wrong of a given model.

    Parameters
    ----------
    dataset : Dataset
    base : Base
        Of a loop that is fitted to the records nothing is said.
    """
    if not base.given:
        return
    yield from _another_quantity(dataset, base)
    records = [item.record for item in base.whole]
    for line in lead_warnings(records):
        yield finding("begun", line=line)
    if not base.fits:
        yield _misfit(dataset, base)
    if kind_of_base(base.given) == "file":
        yield from _start(dataset, base)


def _start(dataset: Dataset, base: Base) -> Iterator[Finding]:
    """Say that a model begins otherwise than records in a steady state do."""
    if not any(item.record.repeats for item in base.fit):
        return
    labels, chain = [], []
    for label, block in base.model.labelled():
        begun = _repeating(block)
        chain.append(begun)
        if begun is not block:
            labels.append(label)
    if not labels:
        return
    other = replace(base.model, chain=tuple(chain))
    records = tuple(item.record for item in base.fit)
    outputs = run_base(other, records, dataset.input_hold)
    left = left_of([Compared(*pair) for pair in zip(records, outputs, strict=True)])
    if left**2 <= (1 - WORTH_A_WORD) * base.left**2:
        yield finding(
            "start",
            blocks=listed(labels),
            left=f"{left:.3g} {records[0].output.unit}",
            now=f"{base.left:.3g} {records[0].output.unit}",
        )


def _repeating(block: Block) -> Block:
    """Give a block as it begins in a steady state, or itself where it cannot."""
    if getattr(block, "start", REPEATING) == REPEATING:
        return block
    try:
        return replace(block, start=REPEATING)  # type: ignore[call-arg]
    except InputError:
        return block


def _another_quantity(dataset: Dataset, base: Base) -> Iterator[Finding]:
    """Say that a mechanism gives another quantity than the records hold."""
    wanted = dataset.quantities.output
    given = _quantity_given(base.model)
    if given is None or wanted not in OUTPUTS or given[1] == wanted:
        return
    label, quantity, may_be_set = given
    lines = [f"output: {wanted}"] if may_be_set else []
    output = base.fit[0].record.output
    yield finding(
        "quantity" if may_be_set else "only force",
        lines,
        block=label,
        given=quantity,
        channel=output.label,
        wanted=wanted,
    )


def _quantity_given(model: Model) -> tuple[str, str, bool] | None:
    """Give the block whose output ends a chain, its quantity, and if that may be set.

    None where a block behind it may make another quantity of it: a sensor only spoils
    what it measures, and so does a curve or a delay; a gain converts.
    """
    for label, block in reversed(list(model.labelled())):
        if isinstance(block, Mechanism | Structure):
            return label, block.output, True
        if isinstance(block, Impedance):
            return label, "force", False
        if not isinstance(block, AttachedBlock) and block.place != "sensor":
            return None
    return None


def _misfit(dataset: Dataset, base: Base) -> Finding:
    """Say that a model leaves more than half, and what would mend it, if that shows.

    It mends what leaves at most half of that: else an effect may be missing.
    """
    nothing = base.share_left**2 >= 1 - AS_GOOD
    output = base.fit[0].record.output
    told: dict[str, Any] = {
        "model": base.called,
        "left": f"{base.left:.3g} {output.unit}",
        "moves": f"{base.moves:.3g} {output.unit}",
        "explains": "explains nothing: it " * nothing,
        "share": 100 * base.share_left,
    }
    if base.identified:  # neither its units nor its start are a user's
        return finding("misfit identified", **told)
    for topic in ("offset", "units", "rate"):
        numbers, left = _would_leave(base, topic)
        if left**2 <= LOOSE * base.left**2:
            told |= {"would": 100 * left / base.moves, "unit": output.unit}
            told |= dict(zip(("offset", "gain"), numbers, strict=False))
            told["added"] = ""
            if topic == "units" and _needs_offset(base, left):
                told["added"] = f", with {told['offset']:.3g} {output.unit} added"
            if topic == "units" and told["gain"] > 0:
                likely = by_thousands(output.unit, told["gain"])
                if likely is not None:
                    about = {**dataset.about["output"], "unit": likely, "meant": True}
                    lines = [f"output: {flow(about)}"]
                    return finding("misfit header", lines, likely=likely, **told)
            return finding(f"misfit {topic}", **told)
    return finding("misfit", **told)


def _needs_offset(base: Base, left: float) -> bool:
    """Tell whether another gain leaves less with an offset, by what is worth a word."""
    alone = _would_leave(base, "gain")[1]
    return left**2 <= (1 - WORTH_A_WORD) * alone**2


def _would_leave(base: Base, topic: str) -> tuple[list[float], float]:
    """Give the numbers with which a model would leave least, and how much that is."""
    tables, outputs, fixed = [], [], []
    for item in base.fit:
        counted = item.record.counted
        shape = item.simulated
        if topic == "rate":
            shape = np.gradient(shape, item.record.dt)
        columns = [np.ones(len(shape)), shape]
        held = np.zeros(len(shape))
        if topic == "offset":
            columns, held = columns[:1], shape
        if topic == "gain":
            columns = columns[1:]
        tables.append(np.column_stack(columns)[counted])
        outputs.append(item.record.y[counted])
        fixed.append(held[counted])
    return _fitted(np.vstack(tables), np.concatenate(outputs) - np.concatenate(fixed))


def _fitted(table: FloatArray, wanted: FloatArray) -> tuple[list[float], float]:
    size = np.sqrt(np.mean(table**2, axis=0))
    size[size == 0] = 1.0
    numbers = np.linalg.lstsq(table / size, wanted, rcond=1e-10)[0] / size
    left = wanted - table @ numbers
    return numbers.tolist(), float(np.sqrt(np.mean(left**2)))

"""The base of a run: the file or function that is given, or a model identified."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.calls import current
from hystbench.blocks.command import Command
from hystbench.blocks.external import External
from hystbench.blocks.fmu import Fmu
from hystbench.blocks.onnx import Onnx
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.blocks.simulator import Simulator
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases.gpi import IdentifiedGpi, identified_gpi
from hystbench.gap.bases.kinds import COMMAND, IDENTIFIED, kind_of_base
from hystbench.gap.bases.linear import (
    NO_SIGN,
    IdentifiedModel,
    how_found,
    identified_linear,
    with_its_numbers_free,
)
from hystbench.gap.bases.split_linear import split_given
from hystbench.gap.cache import records_digest, remembered
from hystbench.gap.records.evidence import Evidence, check_units
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model, check_bounded, load_model


def load_base(text: str | Model, evidence: Evidence) -> tuple[Model, str]:
    """Give the base that ``--model`` asks for.

    Parameters
    ----------
    text : str or Model
        A model file; ``gpi`` or ``linear`` to identify one from the fit records;
        ``column`` for the simulated output beside them; a simulator, as
        ``package.module:function``, ``command: ...`` or a file .fmu or .onnx; or a
        model itself.
    evidence : Evidence
        Of its hold-out records a base that is a column takes its own values. Nothing
        is identified with them in hand.

    Returns
    -------
    Model
    str
        One sentence: where it comes from.

    Raises
    ------
    InputError
        If the text is none of these, units differ, or the base cannot be had.
    """
    deciding = evidence.deciding
    if isinstance(text, Model):
        model, note = checked_base(text, text.name, evidence), f"base {text.name}"
    elif text in IDENTIFIED:
        of = IdentifiedModel if text == "linear" else IdentifiedGpi
        return _kept(["base", text], deciding, lambda: _identified(text, deciding), of)
    else:
        model, note = given_base(text, evidence)
    if not isinstance(model.chain[0], TransferFunction):
        return model, note
    about = ["split", json.dumps(model.to_mapping(), sort_keys=True)]
    model, more = _kept(about, deciding, lambda: split_given(model, deciding))
    return model, note + more


def _kept(
    about: list[str],
    evidence: Evidence,
    compute: Callable[[], tuple[Model, str]],
    of: type[Model] = Model,
) -> tuple[Model, str]:
    """Compute a base from the fit records, or look up what an earlier run computed."""
    return remembered(
        lambda: [
            *about,
            records_digest(evidence.fit),
            evidence.input_hold,
            evidence.identification,
        ],
        compute,
        lambda found: [found[0].to_mapping(), found[1], how_found(found[0])],
        lambda kept: (_given_back(of, kept[0], kept[2]), kept[1]),
    )


def _given_back(of: type[Model], content: Any, how: dict[str, Any]) -> Model:
    """Give a base that was kept, and how it was found."""
    return replace(of.from_mapping(content, "a base that was kept"), **how)


def _identified(word: str, evidence: Evidence) -> tuple[Model, str]:
    """Identify a base from the fit records."""
    if word == "gpi":
        return identified_gpi(evidence)
    found = identified_linear(evidence)
    # Re-tuned without a sign it would be another model.
    if found.model.found_with == NO_SIGN:
        return found.model, found.note
    return with_its_numbers_free(found.model), found.note


def given_base(text: str, evidence: Evidence) -> tuple[Model, str]:
    """Give a base that is not identified, as it is given.

    Parameters
    ----------
    text : str
        As for :func:`load_base`, but none of ``IDENTIFIED``.
    evidence : Evidence

    Returns
    -------
    Model
    str
        One sentence: where it comes from.

    Raises
    ------
    InputError
        If the text is no base, units differ, or the base cannot be had.
    """
    if text == "column":
        return _column(evidence)
    if kind_of_base(text) == "file":
        path = Path(text)
        model = checked_base(load_model(path), str(path), evidence)
        return model, f"base {model.name} from {text}"
    return _simulator(text, evidence)


def checked_base(model: Model, place: str, evidence: Evidence) -> Model:
    """Give a model as a base, once it has been held against the records.

    Parameters
    ----------
    model : Model
    place : str
        Where it comes from, for messages.
    evidence : Evidence

    Raises
    ------
    InputError
        If it is no model of these records, or does not stay bounded on them.
    """
    check_units(evidence, model, place)
    try:
        model = model.with_records(
            (*evidence.fit, *evidence.hold_out), evidence.simulated_column
        )
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
    held = model.with_hold(evidence.input_hold)
    for record in evidence.fit:
        with np.errstate(over="ignore", invalid="ignore"):  # said in our own words
            y = held.simulate(record.u, record.dt)
        check_bounded(place, y, record.dt, f"record {record.name}")
    _check_repeats(held, evidence)
    return model


def _simulator(text: str, evidence: Evidence) -> tuple[Model, str]:
    """Take a simulator as the base, and try it on the fit records.

    Units of the records are taken to be its own.
    """
    kind = kind_of_base(text)
    block: Simulator
    if kind == "command":
        text = text.removeprefix(COMMAND).strip()
        block = Command(command=text)
    elif kind == "fmu":
        block = Fmu(file=text)
    elif kind == "onnx":
        block = Onnx(file=text)
    else:
        block = External(function=text)
    model = Model(text, evidence.input, evidence.output, (block,))
    _check_repeats(model, evidence)
    units = f"from {evidence.input.unit} to {evidence.output.unit}"
    return model, f"base {text}, taken to be {units}"


def _check_repeats(model: Model, evidence: Evidence) -> None:
    """Refuse a model with a function that gives another output when called again.

    The function runs on all fit records, and on the first of them once more: so one
    that draws at random is found, and one that goes on from where it was left.
    """
    first = evidence.fit[0]
    for k, block in enumerate(model.chain):
        if not isinstance(block, Simulator):
            continue
        inputs = [
            Simulation(model.chain[:k], (item,), evidence.input_hold).output[0]
            if k
            else item.u
            for item in evidence.fit
        ]
        pairs = zip(inputs, evidence.fit, strict=True)
        outputs = [block.simulate(z, item.u, item.dt) for z, item in pairs]
        again = current().fresh(block, inputs[0], first.dt)
        if not np.array_equal(again, outputs[0]):
            raise InputError(
                f"{block.label}: called again with record {first.name} it gave "
                "another output; expected the same one every time, with no state kept "
                "from call to call and nothing drawn at random"
            )


def _column(evidence: Evidence) -> tuple[Model, str]:
    """Take the simulated output beside the records as the base: a block holds them."""
    column = evidence.simulated_column
    if column is None:
        raise InputError(
            f"--model: column: {evidence.name} has no simulated output; expected "
            "'simulated: {column: .., unit: ..}' in its dataset.yaml"
        )
    block = SimulatedColumn(column=column, records=(*evidence.fit, *evidence.hold_out))
    model = Model(column, evidence.input, evidence.output, (block,))
    note = (
        f"base from the column {column!r}; what acts before it declines, since it "
        "needs a simulator that can be run again"
    )
    return model, note

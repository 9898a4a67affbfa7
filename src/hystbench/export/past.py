"""Start exported code as if a given record had come before.

``start: settled`` of play operators, ``start: moving`` and ``start: repeating`` are
about samples to come: a record that passes twice, or one that is turned about its first
sample. Code that runs sample by sample knows none of them. It can start as on a record
that is at hand.
"""

from dataclasses import replace

import numpy as np

from hystbench.blocks.step import PASSED, TURNED
from hystbench.errors import InputError
from hystbench.export import python
from hystbench.export.described import Described, Piece, describe
from hystbench.model import Model
from hystbench.record import FloatArray


def begun(described: Described, model: Model, past: FloatArray) -> Described:
    """Give the code the states that the simulation of a record begins with.

    Parameters
    ----------
    described : Described
        Of the model.
    model : Model
    past : ndarray, shape (n,)
        Input of the record, with the interval of the code.

    Raises
    ------
    InputError
        If the start of no block depends on a record.
    """
    starts: dict[str, FloatArray] = {}
    z = past
    for piece, step in zip(described.pieces, model.steps, strict=True):
        for part in piece.all_inside():
            if part.step.past:
                starts |= _states(replace(described, pieces=(piece,)), part, z)
        z = step.simulate(z, past, described.sampling.dt)
    if not starts:
        raise InputError(
            "--past: expected none, as no block of this model starts with a record: "
            "'start' is 'settled' in no play operators, and nowhere "
            "'moving' or 'repeating'"
        )
    return replace(described, starts=starts)


def begun_inverse(described: Described, model: Model, past: FloatArray) -> Described:
    """Give the code of an inverse the plays' states that a record leaves.

    Parameters
    ----------
    described : Described
        Of the model's inverse.
    model : Model
    past : ndarray, shape (n,)
        Input of the record, with the interval of the code.

    Raises
    ------
    InputError
        If no play operators of the model start with a record.
    """
    sampling = replace(described.sampling, delay=0)
    forward = begun(describe(model, sampling), model, past)
    known = dict(described.all_states())
    starts = {name: value for name, value in forward.starts.items() if name in known}
    if not starts:
        raise InputError(
            "--past: expected none with --inverse, as no play operators of this model "
            "say 'start: settled'"
        )
    return replace(described, starts=starts)


def _states(alone: Described, part: Piece, z: FloatArray) -> dict[str, FloatArray]:
    """Run a piece over what came before it, and give the states that are left."""
    machine = python.loaded(alone)
    before, kept = z, list(part.step.states)
    if part.step.past == TURNED:
        before = 2 * z[0] - z[:0:-1]
    elif part.step.past == PASSED:
        # Samples to come are those of the record turned about its end.
        ahead = alone.pieces[0].step.constants.get("ahead", 0)
        before, kept = np.concatenate([z, 2 * z[-1] - z[-2 : -2 - ahead : -1]]), ["w"]
    machine.simulate(before)
    names = [f"{part.label}_{state}" for state in kept]
    return {name: np.array(getattr(machine.state, name)) for name in names}

"""Exported code and a record at hand: it starts as on one, or is held against one.

``start: settled`` of play operators, ``start: moving`` and ``start: repeating`` are
about samples to come: a record that passes twice, or one that is turned about its first
sample. Code that runs sample by sample knows none of them. It can start as on a record
that is at hand.
"""

from dataclasses import dataclass, replace

import numpy as np

from hystbench.blocks.step import PASSED, TURNED
from hystbench.errors import InputError
from hystbench.export.code import loaded
from hystbench.export.described import Described, Piece, describe
from hystbench.metrics import rms
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
    machine = loaded(alone)
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


@dataclass(frozen=True)
class Off:
    """Difference of exported code from the simulation of a record."""

    largest: float
    rms: float
    """Largest and rms difference, as shares of the simulated output's range."""
    time_s: float
    """Time in the record at which it is largest."""

    @property
    def words(self) -> str:
        """Say it in a sentence that begins with the record."""
        return (
            f"the code is at most {self.largest:.2g} of the output's range from the "
            f"simulation, at {self.time_s:.6g} s; in rms {self.rms:.2g}"
        )


def off(code: Described, model: Model, u: FloatArray) -> Off:
    """Feed a record to the exported code, and hold it against the simulation.

    Parameters
    ----------
    code : Described
        Of the model; where its output is late, the simulation is taken so many samples
        before.
    model : Model
    u : ndarray, shape (n,)
        Input of the record, with the interval of the code.

    Raises
    ------
    InputError
        If the simulation does not move or is not finite, or the record is shorter than
        the delay.
    """
    dt, delay = code.sampling.dt, code.sampling.delay
    wanted = model.simulate(u, dt)
    size = float(np.ptp(wanted)) if len(u) > delay else 0.0
    if not 0 < size < np.inf:
        raise InputError(
            f"a record of {len(u)} samples, on which the model's output has the range "
            f"{size:g}; expected a finite one above 0, and more samples than the delay"
        )
    made = loaded(code).simulate(u)[delay:]
    apart = np.abs(made - wanted[: len(made)]) / size
    place = int(np.argmax(apart))
    return Off(float(apart[place]), rms(apart), place * dt)

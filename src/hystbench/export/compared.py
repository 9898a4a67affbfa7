"""How far exported code is from the simulation of a record that is at hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export import python
from hystbench.export.described import Described, describe, exact_delay
from hystbench.export.past import begun
from hystbench.model import Model
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class Off:
    """Difference of exported code from the simulation of a record.

    Parameters
    ----------
    largest, rms : float
        As shares of the simulated output's range.
    time_s : float
        Where in the record it is largest.
    """

    largest: float
    rms: float
    time_s: float

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
    made = python.loaded(code).simulate(u)[delay:]
    apart = np.abs(made - wanted[: len(made)]) / size
    place = int(np.argmax(apart))
    return Off(float(apart[place]), float(np.sqrt(np.mean(apart**2))), place * dt)


SAMPLES = 5000
"""Samples of a record that are compared, at most."""

#: Ways to export: options, and samples of delay, if the code gains by so many.
WAYS = {
    "no option": (Sampling(1.0), 0),
    "--points 2": (Sampling(1.0, points=2), 0),
    "--delay 1": (Sampling(1.0), 1),
    "--delay 4": (Sampling(1.0), 4),
    "--delay exact": (Sampling(1.0), None),
}
COLUMNS = ("dataset", "blocks", "records", *WAYS)


def row(dataset: str, model: Model, records: Sequence[Record]) -> dict[str, str]:
    """Give the largest and rms difference over some records, for each way to export."""
    blocks = ", ".join(label for label, _ in model.labelled())
    cells = {"dataset": dataset, "blocks": blocks, "records": str(len(records))}
    for way, (asked, delay) in WAYS.items():
        try:
            found = [_off(model, record, asked, delay) for record in records]
        except InputError as error:
            cells[way] = f"refused: {error}"
            continue
        rms = float(np.sqrt(np.mean([each.rms**2 for each in found])))
        cells[way] = f"{max(each.largest for each in found):.1g} (rms {rms:.1g})"
    return cells


def _off(model: Model, record: Record, asked: Sampling, delay: int | None) -> Off:
    """Export with a delay, if anything gains by it, and with the record's past."""
    u, dt = record.u[:SAMPLES], record.dt
    sampling = replace(asked, dt=dt, duration_s=(len(u) - 1) * dt)
    code = describe(model, sampling)
    most = exact_delay(code)
    late = most if delay is None else min(delay, most)
    if late:
        code = describe(model, replace(sampling, delay=late))
    if any(piece.step.past for piece in code.all_pieces()):
        code = begun(code, model, u)
    return off(code, model, u)

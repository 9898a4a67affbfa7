"""How far exported code is from the simulation of a record that is at hand."""

from dataclasses import dataclass

import numpy as np

from hystbench.errors import InputError
from hystbench.export import python
from hystbench.export.described import Described
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Off:
    """Difference of exported code from the simulation of a record."""

    largest: float
    rms: float
    """As shares of the simulated output's range."""
    time_s: float
    """Where in the record it is largest."""

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
    return Off(float(apart[place]), rms(apart), place * dt)

"""Models that run away on a hold-out record: told by name, and nothing of it counts.

A spring that softens, say, fits the records that it was fitted to and has no bounded
motion beyond their amplitudes; a simulator of somebody's own may refuse what an effect
sends it there. What was decided stays: hold-out records decide nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from hystbench.record import FloatArray, Record

FAR = 1e6
"""Times as far as the base ever goes: an output beyond it runs away, finite or not."""


class RunsAway(NamedTuple):
    """A record on which a model has no bounded output, and from when on."""

    model: str
    record: str
    from_s: float
    refused: str | None = None
    """What the simulator said that refused the record, if one did."""

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``runs_away``."""
        what = (
            f"runs away on {self.record} from {self.from_s:g} s on: there its output "
            "is not bounded"
        )
        if self.refused is not None:
            what = f"cannot be run on {self.record}: {self.refused}"
        told = f"{self.model} {what}, and nothing of the gap counts as closed."
        return {
            "record": self.record,
            "from_s": self.from_s,
            "refused": self.refused,
            "sentence": told,
        }


def reach(outputs: Sequence[FloatArray], floor_rms: float) -> float:
    """Give how far a base's outputs go on all records, and the noise."""
    return max(float(np.abs(output).max()) for output in outputs) + floor_rms


def bounded(
    model: str,
    records: Sequence[Record],
    outputs: Sequence[FloatArray],
    usual: float,
    refused: Mapping[str, str] | None = None,
) -> tuple[list[FloatArray | None], list[RunsAway]]:
    """Tell on which records a model runs away.

    Parameters
    ----------
    model : str
        What it is called.
    records : sequence of Record
    outputs : sequence of ndarray, shape (n,) each
    usual : float
        How far the base goes.
    refused : mapping of str to str, optional
        By record, why there is no output, which is NaN there.

    Returns
    -------
    outputs : list of ndarray or None
        None where the model runs away.
    found : list of RunsAway
    """
    kept: list[FloatArray | None] = []
    found = []
    for record, output in zip(records, outputs, strict=True):
        # What is no number is not within either.
        beyond = np.flatnonzero(~(np.abs(output) <= FAR * usual))
        kept.append(None if len(beyond) else output)
        if len(beyond):
            why = (refused or {}).get(record.name)
            start = float(beyond[0] * record.dt)
            found.append(RunsAway(model, record.name, start, why))
    return kept, found

"""Block ``simulated-column``: the output of a simulator that ran elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import text
from hystbench.errors import InputError
from hystbench.record import FloatArray, Record

NEEDS_RERUN = "needs a simulator that can be run again"


class SimulatedColumn(Block, name="simulated-column", place="base"):
    """The stored output of a simulator, a column beside each record's input.

    It answers to the inputs of its records alone, from their first sample on: what
    changes the input before it would need another run of the simulator.

    Parameters
    ----------
    column : str
        Name of the column in the records' files.
    records : tuple of Record
        Where the samples are; no part of a model file.

    References
    ----------
    By definition.
    """

    reruns = False
    seen = False
    no_step = (
        "stored output cannot be turned into code; expected --part behind: what "
        "stands there takes the simulator's output"
    )

    column: str = text("the name of a column of simulated output")
    records: tuple[Record, ...] = field(default=(), kw_only=True, repr=False)

    def __eq__(self, other: object) -> bool:
        """Two are equal that stand for the same column of the same records."""
        return isinstance(other, SimulatedColumn) and self._key == other._key

    def __hash__(self) -> int:
        """Hash the column and the records themselves."""
        return hash(self._key)

    @property
    def _key(self) -> tuple[str, tuple[int, ...]]:
        return self.column, tuple(map(id, self.records))

    def bound(
        self, records: Sequence[Record], column: str | None = None
    ) -> SimulatedColumn:
        """Give the block with the records that hold its output.

        Parameters
        ----------
        records : sequence of Record
        column : str, optional
            Where their simulated output was read, if that is known.

        Raises
        ------
        InputError
            If one of them has no simulated output, or it is another column's.
        """
        if column is not None and column != self.column:
            raise InputError(
                f"{self.name}: column: {self.column!r}; expected {column!r}, the one "
                "that the dataset names under 'simulated'"
            )
        for record in records:
            if record.simulated is None:
                raise InputError(
                    f"record {record.name}: no simulated output; expected a column "
                    f"{self.column!r}, named under 'simulated' in dataset.yaml"
                )
        return SimulatedColumn(column=self.column, records=tuple(records))

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Give the stored output for the input of one of the records.

        Raises
        ------
        InputError
            If it is of none of them.
        """
        # The array itself first: repeats of one input may have been simulated each.
        alike = [
            (record.u, record.simulated)
            for record in self.records
            if record.simulated is not None and record.dt == dt
        ]
        itself = [pair for pair in alike if pair[0] is z]
        for u, simulated in itself or alike:
            if itself or np.array_equal(z, u[: len(z)]):
                return simulated[: len(z)]
        if not self.records:
            raise InputError(
                f"{self.name}: expected records with the column {self.column!r}, "
                "got none"
            )
        names = ", ".join(record.name for record in self.records)
        raise InputError(
            f"{self.name}: its input is that of no record ({names}); any other "
            f"{NEEDS_RERUN}"
        )

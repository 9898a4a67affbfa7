"""A model: a chain of blocks from input u to output y, kept in a YAML file.

The plant, a simulator that a user brings and an augmented model are all the same
thing. The format is told in docs/model-files.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.attached import Simulated, attached, through_near
from hystbench.blocks.base import Block
from hystbench.blocks.held import HOLDS, HeldBlock, Hold
from hystbench.blocks.parameter import Value
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.blocks.starts import begun_once
from hystbench.errors import InputError, nearest, placed, refuse_unknown
from hystbench.files import write_text
from hystbench.model_content import Provenance, place_of, read_content
from hystbench.record import Channel, FloatArray, Record
from hystbench.yaml_files import load_yaml, yaml_text


@dataclass(frozen=True)
class Model:
    """A chain of blocks from input to output.

    A parameter is named ``block.parameter``; the second block of one kind in the
    chain is ``block#2.parameter``.

    Parameters
    ----------
    name : str
    input, output : Channel
        What goes in and comes out, with units.
    chain : tuple of Block
        In the order of the signal's way.
    free : tuple of str
        Names of the parameters that identification may change.
    tolerances : mapping of str to float
        By how much some of them are expected to change at most, as a share of their
        value; the others are free altogether.
    provenance : mapping of str to Provenance
        By parameter name.
    exact : bool
        Whether it says that none is free: ``free: []``.
    """

    name: str
    input: Channel
    output: Channel
    chain: tuple[Block, ...]
    free: tuple[str, ...] = ()
    provenance: Mapping[str, Provenance] = field(default_factory=dict)
    tolerances: Mapping[str, float] = field(default_factory=dict)
    exact: bool = False

    def __post_init__(self) -> None:
        """Refuse a chain that does not fit together and names that it lacks."""
        if not self.chain:
            raise InputError("chain: expected at least one block, got none")
        _ = self.steps
        for key, names in (("free", self.free), ("provenance", self.provenance)):
            for name in names:
                with placed(f"{key}: "):
                    self._find(name)
        for name, share in self.tolerances.items():
            refuse_unknown(
                name, self.free, f"free: a tolerance for {name!r}, which is not free"
            )
            number = isinstance(share, int | float) and not isinstance(share, bool)
            if not (number and 0 < share < np.inf):
                raise InputError(
                    f"free: {name}: expected a tolerance above 0, as a share of the "
                    f"value, got {share!r}"
                )

    def __repr__(self) -> str:
        """Tell the channels and the chain, block by block, with what is free."""
        lines = [f"Model {self.name}: {self.input.label} to {self.output.label}"]
        for label, block in self.labelled():
            numbers = ", ".join(
                _shown(f"{label}.{key}" in self.free, key, getattr(block, key))
                for key in block.parameters()
            )
            lines.append(f"  {label}: {numbers}")
        return "\n".join(lines)

    def simulate(
        self, u: FloatArray, dt: float, rng: np.random.Generator | None = None
    ) -> FloatArray:
        """Compute the output from rest.

        Parameters
        ----------
        u : ndarray, shape (n,)
            Input, in the unit of ``input``.
        dt : float
            Sampling interval in seconds.
        rng : numpy.random.Generator, optional
            Source of the sensor's noise. Without it none is added and
            the result is the same every time.

        Returns
        -------
        ndarray, shape (n,)
            Output, in the unit of ``output``.
        """
        u = np.ascontiguousarray(u, dtype=np.float64)
        y = u
        for step in self.steps:
            y = step.simulate(y, u, dt)
            if rng is not None and hasattr(step, "draw"):
                y = y + step.draw(len(y), rng)
        return y

    def simulate_near(
        self, others: Sequence[Model], u: FloatArray, dt: float
    ) -> list[FloatArray]:
        """Compute the output, and those of models of the same blocks with numbers near.

        Parameters
        ----------
        others : sequence of Model
        u, dt
            Those of :meth:`simulate`.

        Returns
        -------
        list of ndarray, shape (n,)
            Its own first.
        """
        u = np.ascontiguousarray(u, dtype=np.float64)
        chains = [self.steps, *(item.steps for item in others)]
        return [y for (y,) in through_near(chains, (u,), (dt,))]

    @cached_property
    def steps(self) -> tuple[Simulated, ...]:
        """What the signal passes: the chain, a block and what is attached as one."""
        return tuple(attached(self.chain))

    def with_hold(self, hold: Hold) -> Model:
        """Return the model with a hold for the blocks that do not set one.

        A staircase is smooth behind the first block that is dynamic: with
        ``zero-order`` those after it take straight lines.

        Parameters
        ----------
        hold : {"zero-order", "linear", "band-limited"}
            How the model's input moves between two samples.

        Raises
        ------
        InputError
            If there is no such hold.
        """
        refuse_unknown(hold, HOLDS, f"hold: {hold!r} is unknown")
        chain = []
        for block in self.chain:
            if isinstance(block, HeldBlock):
                if block.hold == "default":
                    block = replace(block, hold=hold)
                if block.smooths and hold == "zero-order":
                    hold = "linear"
            chain.append(block)
        return replace(self, chain=tuple(chain))

    def with_records(
        self, records: Sequence[Record], column: str | None = None
    ) -> Model:
        """Return the model with the records that hold a block's simulated output.

        Parameters
        ----------
        records : sequence of Record
        column : str, optional
            Where their simulated output was read, if that is known.

        Raises
        ------
        InputError
            If the chain has a ``simulated-column`` and a record has none, or another.
        """
        chain = tuple(
            block.bound(records, column)
            if isinstance(block, SimulatedColumn)
            else block
            for block in self.chain
        )
        return replace(self, chain=chain)

    def begun_on(self, record: Record) -> Model:
        """Return the model as it begins on a record: only whole periods repeat."""
        return self if record.repeats else self.begun_once()

    def begun_once(self) -> Model:
        """Return the model on a record that does not repeat: nothing ``repeating``."""
        return replace(self, chain=tuple(map(begun_once, self.chain)))

    def parameter_names(self) -> tuple[str, ...]:
        """Return the names of all parameters in the chain's order."""
        return tuple(
            f"{label}.{parameter}"
            for label, block in self.labelled()
            for parameter in block.parameters()
        )

    def value(self, name: str) -> Value:
        """Return the value of a parameter.

        Raises
        ------
        InputError
            If the chain has no such parameter.
        """
        position, parameter = self._find(name)
        value: Value = getattr(self.chain[position], parameter)
        return value

    def with_values(self, values: Mapping[str, Value | Sequence[float]]) -> Model:
        """Return the model with other values of some parameters.

        Raises
        ------
        InputError
            If the chain has no such parameter or a value does not fit it.
        """
        changes: dict[int, dict[str, Any]] = {}
        for name, value in values.items():
            position, parameter = self._find(name)
            changes.setdefault(position, {})[parameter] = value
        chain = list(self.chain)
        for position, change in changes.items():
            with placed(place_of(position, chain[position].name)):
                chain[position] = replace(chain[position], **change)
        return replace(self, chain=tuple(chain))

    @classmethod
    def from_mapping(cls, content: object, place: str) -> Model:
        """Make a model from what a YAML file holds.

        Parameters
        ----------
        content : mapping
        place : str
            Name of the file, for messages.

        Raises
        ------
        InputError
            If a key, block or parameter is unknown or missing, or a value is of the
            wrong type or out of bounds.
        """
        with placed(f"{place}: "):
            return cls(**read_content(content))

    def to_mapping(self) -> dict[str, Any]:
        """Return the model as a YAML file holds it."""
        content: dict[str, Any] = {
            "name": self.name,
            "input": {"name": self.input.name, "unit": self.input.unit},
            "output": {"name": self.output.name, "unit": self.output.unit},
        }
        if self.tolerances:
            content["free"] = {name: self.tolerances.get(name) for name in self.free}
        elif self.free or self.exact:
            content["free"] = list(self.free)
        content["chain"] = [{block.name: block.to_mapping()} for block in self.chain]
        if self.provenance:
            content["provenance"] = {
                name: {"source": item.source, "note": item.note}
                for name, item in self.provenance.items()
            }
        return content

    def to_yaml(self) -> str:
        """Return the text of the model's YAML file."""
        return yaml_text(self.to_mapping())

    def save(self, path: str | Path) -> None:
        """Write the model's YAML file, all of it or nothing."""
        write_text(path, self.to_yaml())

    def labelled(self) -> Iterator[tuple[str, Block]]:
        """Give every block with its label: its name, and ``#2`` for the second one."""
        seen: dict[str, int] = {}
        for block in self.chain:
            seen[block.name] = seen.get(block.name, 0) + 1
            count = seen[block.name]
            yield (block.name if count == 1 else f"{block.name}#{count}"), block

    def _find(self, name: str) -> tuple[int, str]:
        label, _, parameter = str(name).rpartition(".")
        told = ""
        for position, (known, block) in enumerate(self.labelled()):
            parameters = block.parameters()
            if known == label and parameter in parameters:
                return position, parameter
            for whole, about in parameters.items():
                if known == label and parameter in about.names:
                    told = f"it is one of {known}.{whole}, which goes as a whole"
        told = told or nearest(name, self.parameter_names())
        raise InputError(f"unknown parameter {name!r}; {told}")


def load_model(path: str | Path) -> Model:
    """Read a model file.

    Raises
    ------
    InputError
        If there is no such file, or it does not hold a model.
    """
    return Model.from_mapping(load_yaml(path, "a model file"), str(path))


def check_bounded(name: str, y: FloatArray, dt: float, record: str) -> None:
    """Refuse an output of a model that is not finite throughout.

    Raises
    ------
    InputError
        With the names of model and record, and the time.
    """
    lost = np.flatnonzero(~np.isfinite(y))
    if len(lost):
        raise InputError(
            f"{name}: the output is not finite from {lost[0] * dt:g} s of {record} on; "
            "expected a model that stays bounded"
        )


def _shown(free: bool, name: str, value: Value) -> str:
    """Say a parameter shortly, and whether it may be changed."""
    if isinstance(value, tuple):
        text = f"{len(value)} numbers"
    else:
        text = value if isinstance(value, str) else f"{value:.4g}"
    return f"{name} {text}{' (free)' if free else ''}"

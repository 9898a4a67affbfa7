"""What a block is: one physical effect that maps a signal to a signal."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from functools import cache
from typing import Any, ClassVar, Literal, dataclass_transform

import numpy as np

from hystbench.blocks.parameter import Parameter
from hystbench.blocks.step import Sampling, Step, polynomial
from hystbench.errors import InputError, refuse_unknown
from hystbench.record import FloatArray

Place = Literal["base", "drive", "material", "inside", "mechanics", "sensor"]


@dataclass_transform(frozen_default=True, kw_only_default=True)
@dataclass(frozen=True)
class Block(ABC):
    """One physical effect in the chain from input u to output y.

    A subclass is made a frozen dataclass. Its fields are declared with
    :func:`~hystbench.blocks.parameter.number` and its kin; it says its name and
    place in the line of its class, and in its docstring what it computes and after
    whom.
    """

    name: ClassVar[str]
    place: ClassVar[Place]
    hysteretic: ClassVar[bool] = False
    """Whether a block that wraps hysteresis may follow."""
    reruns: ClassVar[bool] = True
    """Whether the block takes any input, or only one whose output is stored."""

    seen: ClassVar[bool] = True
    """Whether it says what it does inside, or is a whole simulator of somebody's."""

    curve: ClassVar[str] = ""
    """Function of the step of a block without memory, which takes its parameters."""

    no_step: ClassVar[str] = "has no step that could be exported"
    """Why the block cannot be exported, if it cannot."""

    one_of: ClassVar[tuple[str, ...]] = ()
    """Parameters with a default of which a model file states one at least."""

    def __init_subclass__(
        cls, name: str = "", place: Place | None = None, curve: str = ""
    ) -> None:
        """Make a subclass a dataclass, and keep what the line of its class says."""
        super().__init_subclass__()
        for key, said in (("name", name), ("place", place), ("curve", curve)):
            if said:
                setattr(cls, key, said)
        dataclass(frozen=True)(cls)

    @classmethod
    @cache
    def parameters(cls) -> Mapping[str, Parameter]:
        """Return the declared parameters by name, those with a default last."""
        own = [item for item in fields(cls) if "parameter" in item.metadata]
        declared = sorted(own, key=lambda item: item.default is not MISSING)
        return {item.name: item.metadata["parameter"] for item in declared}

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Block:
        """Make a block from parameter names and values.

        Raises
        ------
        InputError
            If a parameter is unknown, missing, of the wrong type or out of bounds.
        """
        known = cls.parameters()
        for key in values:
            refuse_unknown(key, known, f"unknown parameter {key!r}")
        if cls.one_of and not any(name in values for name in cls.one_of):
            wanted = " or ".join(map(repr, cls.one_of))
            raise InputError(f"missing parameter {wanted}; expected one at least")
        for item in fields(cls):
            if item.name not in values and item.default is MISSING:
                about = item.metadata["parameter"]
                raise InputError(
                    f"missing parameter {item.name!r} ({about.unit}): {about.meaning}"
                )
        return cls(**values)

    def __post_init__(self) -> None:
        """Check every value against its declaration, then all of them together."""
        declared = self.parameters()
        for key, about in declared.items():
            given = getattr(self, key)
            checked = about.check(key, given)
            if checked is not given:
                object.__setattr__(self, key, checked)
        for key, about in declared.items():
            if not (other := about.as_many_as):
                continue
            count, wanted = len(getattr(self, key)), len(getattr(self, other))
            if count != wanted and (count or not about.may_be_empty):
                raise InputError(
                    f"{key}: expected {wanted} numbers, as many as {other}, got {count}"
                )
        self.check()

    def check(self) -> None:  # noqa: B027
        """Check what no single parameter shows; a subclass raises InputError."""

    def to_mapping(self) -> dict[str, Any]:
        """Return the parameters as a model file holds them; defaults are left out."""
        defaults = {item.name: item.default for item in fields(self)}
        declared = self.parameters()
        told = [name for name in declared if getattr(self, name) != defaults[name]]
        if not set(self.one_of) & set(told):
            told += self.one_of
        return {name: declared[name].plain(getattr(self, name)) for name in told}

    def step(self, sampling: Sampling) -> Step:
        """Say what the block does at one sample, for code that runs elsewhere.

        Parameters
        ----------
        sampling : Sampling

        Raises
        ------
        InputError
            If it cannot be said.
        """
        if not self.curve:
            raise InputError(f"{self.name}: {self.no_step}")
        return Step(self.curve, self.constants(*self.parameters()))

    def constants(self, *names: str) -> dict[str, Any]:
        """Give parameters as constants of a step, a sequence as an array."""
        values = {name: getattr(self, name) for name in names}
        return {
            name: np.array(value) if isinstance(value, tuple) else value
            for name, value in values.items()
        }

    @abstractmethod
    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the block's output.

        Parameters
        ----------
        z : ndarray, shape (n,)
            Output of the block before; the model's input for the first block.
        u : ndarray, shape (n,)
            The model's input, which heat and friction depend on.
        dt : float
            Sampling interval in seconds.

        Returns
        -------
        ndarray, shape (n,)
        """


class PolynomialBlock(Block):
    """A block whose output is a polynomial of what enters it."""

    terms: ClassVar[tuple[float | str, ...]]
    """Its coefficients, the constant first: numbers, or names of parameters."""

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Those of the polynomial, the constant first."""
        return tuple(
            getattr(self, term) if isinstance(term, str) else term
            for term in self.terms
        )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the polynomial by Horner's scheme."""
        constant, *higher = self.coefficients
        if not higher:
            return np.full(len(z), constant)
        *between, highest = higher
        y: FloatArray = highest * z
        for coefficient in reversed(between):
            y += coefficient
            y *= z
        return y + constant if constant else y

    def step(self, sampling: Sampling) -> Step:
        """Give the polynomial."""
        return polynomial(*self.coefficients)

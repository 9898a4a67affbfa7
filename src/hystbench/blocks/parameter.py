"""Parameters of blocks: unit, meaning and bounds, stated where they are defined."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import MISSING, dataclass, field
from typing import Any, Literal

from hystbench.errors import InputError, nearest

Kind = Literal["number", "numbers", "choice"]
Value = float | tuple[float, ...] | str


@dataclass(frozen=True)
class Parameter:
    """What one parameter of a block means and which values it may take.

    Parameters
    ----------
    kind : {"number", "numbers", "choice"}
        One number, a sequence of numbers, or a word out of ``options``.
    unit : str
        Unit; ``U`` and ``Y`` stand for the units of the model's input and of the
        block's output, ``-`` for none.
    meaning : str
        One sentence.
    low, high : float
        Closed bounds of each number; they bound identification as well.
    length : int or None
        Length of a sequence, where it is fixed.
    options : tuple of str
        Words that a choice may take.
    """

    kind: Kind
    unit: str
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    length: int | None = None
    options: tuple[str, ...] = ()

    def check(self, name: str, value: object) -> Value:
        """Return the value as float, tuple of float or word.

        Raises
        ------
        InputError
            If the value has the wrong type or length, or lies out of bounds.
        """
        if self.kind == "choice":
            if value not in self.options:
                raise InputError(
                    f"{name}: {value!r} is unknown; {nearest(value, self.options)}"
                )
            return str(value)
        if self.kind == "number":
            return self._number(name, value)
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise InputError(f"{name}: expected a list of numbers, got {value!r}")
        if self.length is not None and len(value) != self.length:
            raise InputError(
                f"{name}: expected {self.length} numbers, got {len(value)}"
            )
        if not value:
            raise InputError(f"{name}: expected at least one number, got none")
        return tuple(self._number(f"{name}[{i}]", item) for i, item in enumerate(value))

    def _number(self, name: str, value: object) -> float:
        # bool is an int to Python, but `true` is no number in a model file.
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise InputError(f"{name}: expected a number, got {value!r}")
        if not math.isfinite(value):
            raise InputError(f"{name}: expected a finite number, got {value!r}")
        if not self.low <= value <= self.high:
            raise InputError(
                f"{name}: {value:g} is out of bounds, "
                f"expected {self.low:g} to {self.high:g} {self.unit}"
            )
        return float(value)


def number(
    unit: str,
    meaning: str,
    low: float = -math.inf,
    high: float = math.inf,
    default: object = MISSING,
) -> Any:
    """Declare a parameter that is one number."""
    return _declare(Parameter("number", unit, meaning, low, high), default)


def numbers(
    unit: str,
    meaning: str,
    low: float = -math.inf,
    high: float = math.inf,
    length: int | None = None,
) -> Any:
    """Declare a parameter that is a sequence of numbers."""
    return _declare(Parameter("numbers", unit, meaning, low, high, length), MISSING)


def choice(meaning: str, options: tuple[str, ...], default: str) -> Any:
    """Declare a parameter that is one word out of several."""
    return _declare(Parameter("choice", "-", meaning, options=options), default)


def _declare(parameter: Parameter, default: object) -> Any:
    return field(default=default, kw_only=True, metadata={"parameter": parameter})

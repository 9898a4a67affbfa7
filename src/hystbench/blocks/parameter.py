"""Parameters of blocks: unit, meaning and bounds, stated where they are defined."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, field
from typing import Any, Literal, TypeGuard

from hystbench.errors import InputError, refuse_unknown, short

Kind = Literal["number", "numbers", "choice", "text"]
Value = float | tuple[float, ...] | str

HUGE, TINY = 1e30, 1e-30
"""Bounds of what has the unit of an input or output, which may be any: a narrower one
would let the choice of micrometres or metres decide what a record can mean."""


SETTINGS = ("hold", "start", "lead_s")
"""Parameters that say how a signal moves and what was before it: no numbers of an
effect, so no table of them has these."""


@dataclass(frozen=True)
class Parameter:
    """What one parameter of a block means and which values it may take."""

    kind: Kind
    """One number, a sequence of numbers, a word out of ``options``, or any text."""
    unit: str
    """Unit; ``U`` and ``Y`` stand for the units of the model's input and of the block's
    output, ``-`` for none."""
    meaning: str
    """One sentence."""
    low: float = -HUGE
    high: float = HUGE
    """Closed bounds of each number; they bound identification as well."""
    names: tuple[str, ...] = ()
    """Names of the numbers of a sequence; a model file then holds them by name."""
    options: tuple[str, ...] = ()
    """Words that a choice may take."""
    may_be_empty: bool = False
    """Whether a sequence may have no numbers at all."""
    as_many_as: str = ""
    """Another sequence of the block, of as many numbers; none for any count."""
    whole: bool = False
    """Whether a number counts something: no fit may change it."""

    def check(self, name: str, value: object) -> Value:
        """Return the value as float, tuple of float or text.

        Raises
        ------
        InputError
            If the value has the wrong type or length, or lies out of bounds.
        """
        if self._is_checked(value):
            return value
        if self.kind == "choice":
            refuse_unknown(value, self.options, f"{name}: {short(value)} is unknown")
            return str(value)
        if self.kind == "text":
            if not isinstance(value, str) or not (value.strip() or self.may_be_empty):
                raise InputError(f"{name}: expected {self.meaning}, got {short(value)}")
            return value
        if self.kind == "number":
            return self._number(name, value)
        if self.names and isinstance(value, Mapping):
            value = self._in_order(name, value)
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise InputError(f"{name}: expected a list of numbers, got {short(value)}")
        if self.names and len(value) != len(self.names):
            raise InputError(
                f"{name}: expected {len(self.names)} numbers, got {len(value)}"
            )
        if not value and not self.may_be_empty:
            raise InputError(f"{name}: expected at least one number, got none")
        return tuple(self._number(f"{name}[{i}]", item) for i, item in enumerate(value))

    def _is_checked(self, value: object) -> TypeGuard[float | tuple[float, ...]]:
        """Tell at once of numbers within bounds: a fit makes many blocks of them."""
        if self.whole:
            return False
        if self.kind == "number":
            return type(value) is float and self.low <= value <= self.high
        if type(value) is not tuple or not value or self.names:
            return False
        low, high = self.low, self.high
        return not any(type(x) is not float or not low <= x <= high for x in value)

    def plain(self, value: Value) -> object:
        """Return a value as a model file holds it."""
        if not isinstance(value, tuple):
            return value
        if self.names:
            return dict(zip(self.names, value, strict=True))
        return list(value)

    def _in_order(self, name: str, value: Mapping[str, object]) -> list[object]:
        for key in value:
            refuse_unknown(key, self.names, f"{name}: unknown key {key!r}")
        for key in self.names:
            if key not in value:
                raise InputError(f"{name}: expected the key {key!r}")
        return [value[key] for key in self.names]

    def _number(self, name: str, value: object) -> float:
        # bool is an int to Python, but `true` is no number in a model file.
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise InputError(f"{name}: expected a number, got {short(value)}")
        if not math.isfinite(value):
            raise InputError(f"{name}: expected a finite number, got {short(value)}")
        if not self.low <= value <= self.high:
            raise InputError(
                f"{name}: {value:g} is out of bounds, "
                f"expected {self.low:g} to {self.high:g} {self.unit}"
            )
        if self.whole and value != int(value):
            raise InputError(f"{name}: expected a whole number, got {value:g}")
        return float(value)


def number(
    unit: str,
    meaning: str,
    low: float = -HUGE,
    high: float = HUGE,
    default: object = MISSING,
    whole: bool = False,
) -> Any:
    """Declare a parameter that is one number; without bounds it may be any."""
    about = Parameter("number", unit, meaning, low, high, whole=whole)
    return _declare(about, default)


def numbers(
    unit: str,
    meaning: str,
    low: float = -HUGE,
    high: float = HUGE,
    names: tuple[str, ...] = (),
    optional: bool = False,
    as_many_as: str = "",
) -> Any:
    """Declare a parameter that is a sequence of numbers; an optional one may be ()."""
    about = Parameter(
        "numbers", unit, meaning, low, high, names, (), optional, as_many_as
    )
    return _declare(about, () if optional else MISSING)


def choice(meaning: str, options: tuple[str, ...], default: str) -> Any:
    """Declare a parameter that is one word out of several."""
    return _declare(Parameter("choice", "-", meaning, options=options), default)


def text(meaning: str, default: object = MISSING) -> Any:
    """Declare a parameter that is any text; one with a default may be empty."""
    empty = default is not MISSING
    return _declare(Parameter("text", "-", meaning, may_be_empty=empty), default)


def a_threshold(unit: str, name: str, optional: bool = True) -> Any:
    """Declare weights of play operators, one a threshold; optional ones may be ()."""
    meaning = f"{name}, one a threshold{' or none' if optional else ''}"
    return numbers(unit, meaning, optional=optional, as_many_as="thresholds")


def _declare(parameter: Parameter, default: object) -> Any:
    return field(default=default, kw_only=True, metadata={"parameter": parameter})

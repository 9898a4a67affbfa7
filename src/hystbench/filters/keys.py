"""Keys of config.yaml that a filter has, declared where its parameters are."""

import math
from collections.abc import Sequence
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

from hystbench.errors import InputError, refuse_unknown, short


@dataclass(frozen=True)
class Key:
    """A key of ``filters`` in config.yaml, for a field of a filter."""

    field: str
    """The filter's field that it sets."""
    meaning: str
    """What it means, in one sentence."""
    default: Any
    """Value where config.yaml leaves it out; ``dataclasses.MISSING`` where it must
    not."""
    least: float = -math.inf
    most: float = math.inf
    """Closed bounds of a number."""
    words: tuple[str, ...] = ()
    """Words of which it takes one; empty for a number."""

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema of its values."""
        if self.words:
            return {"description": self.meaning, "enum": list(self.words)}
        bounds = {"minimum": self.least, "maximum": self.most}
        finite = {name: end for name, end in bounds.items() if math.isfinite(end)}
        return {"description": self.meaning, "type": "number", **finite}

    def check(self, name: str, value: object) -> None:
        """Refuse a value that is not one of its words or out of its bounds."""
        if self.words:
            refuse_unknown(value, self.words, f"{name}: {short(value)} unknown")
            return
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise InputError(f"{name}: expected a number, got {short(value)}")
        if not math.isfinite(value) or not self.least <= value <= self.most:
            raise InputError(
                f"{name}: {value:g} given, {self.least:g} to {self.most:g} expected"
            )


def number(
    meaning: str,
    least: float = -math.inf,
    most: float = math.inf,
    *,
    default: object = MISSING,
    key: str = "",
) -> Any:
    """Declare a field that a number in config.yaml sets.

    Parameters
    ----------
    meaning : str
        What it means, in one sentence.
    least, most : float
        Closed bounds.
    default : object, optional
        Where nothing sets it; without one config.yaml must.
    key : str
        Its name in config.yaml; by default that of the field.
    """
    return _declared(default, key, meaning=meaning, least=least, most=most)


def choice(
    meaning: str, words: Sequence[str], *, default: object = MISSING, key: str = ""
) -> Any:
    """Declare a field that one word out of several in config.yaml sets.

    Parameters are those of :func:`number`, but for the words.
    """
    return _declared(default, key, meaning=meaning, words=tuple(words))


def _declared(default: object, key: str, **about: Any) -> Any:
    return field(default=default, metadata={"key": key, "about": about})


def keys_of(filter_class: type) -> dict[str, Key]:
    """Give a filter's own keys of config.yaml, by name, in the order of its fields."""
    return {
        item.metadata["key"] or item.name: Key(
            item.name, default=item.default, **item.metadata["about"]
        )
        for item in fields(filter_class)
        if "about" in item.metadata
    }

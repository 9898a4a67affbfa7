"""What a model file holds: read key by key, with where each parameter comes from."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

from hystbench.blocks import blocks
from hystbench.blocks.base import Block
from hystbench.errors import InputError, nearest, placed, refuse_unknown, short
from hystbench.record import Channel
from hystbench.units import check_known

Source = Literal["published", "derived", "calibrated"]
SOURCES: tuple[str, ...] = get_args(Source)


@dataclass(frozen=True)
class Provenance:
    """Where the value of a parameter comes from."""

    source: str
    """``published``; ``derived`` from what is published; or ``calibrated``: fitted."""
    note: str
    """One sentence."""

    def __post_init__(self) -> None:
        """Refuse a source that is none of the three."""
        refuse_unknown(self.source, SOURCES, f"source: {self.source!r} is unknown")
        if not isinstance(self.note, str) or not self.note.strip():
            raise InputError(f"note: expected a sentence, got {short(self.note)}")


REQUIRED = ("name", "input", "output", "chain")
KEYS = ("name", "input", "output", "free", "chain", "provenance")


def read_content(content: object) -> dict[str, Any]:
    """Read what a model file holds, as a model takes it.

    Raises
    ------
    InputError
        As :meth:`hystbench.model.Model.from_mapping`, without the file's name.
    """
    content = _mapping(content, "", required=REQUIRED, known=KEYS)
    name = content["name"]
    if not isinstance(name, str):
        raise InputError(f"name: expected a word, got {short(name)}")
    chain = content["chain"]
    if not isinstance(chain, list):
        raise InputError(f"chain: expected a list of blocks, got {short(chain)}")
    free = content.get("free", [])
    if not isinstance(free, list | dict):
        raise InputError(
            "free: expected a list of parameters, or a mapping of each to its "
            f"tolerance, got {short(free)}"
        )
    shares = free if isinstance(free, dict) else {}
    provenance = _mapping(content.get("provenance", {}), "provenance: ")
    return {
        "name": name,
        "input": _channel(content["input"], "input: "),
        "output": _channel(content["output"], "output: "),
        "chain": tuple(_block(item, position) for position, item in enumerate(chain)),
        "free": tuple(free),
        "exact": "free" in content and not free,
        "tolerances": {key: item for key, item in shares.items() if item is not None},
        "provenance": {
            key: _provenance(item, f"provenance: {key}: ")
            for key, item in provenance.items()
        },
    }


def _mapping(
    content: object,
    place: str,
    required: tuple[str, ...] = (),
    known: tuple[str, ...] = (),
) -> dict[str, Any]:
    if not isinstance(content, dict):
        raise InputError(f"{place}expected a mapping of keys, got {short(content)}")
    for key in content:
        if known and key not in known:
            raise InputError(f"{place}unknown key {key!r}; {nearest(key, known)}")
    for key in required:
        if key not in content:
            raise InputError(f"{place}missing key {key!r}")
    return content


def _channel(content: object, place: str) -> Channel:
    keys = ("name", "unit")
    content = _mapping(content, place, required=keys, known=keys)
    for key in keys:
        if not isinstance(content[key], str):
            raise InputError(
                f"{place}{key}: expected a word, got {short(content[key])}"
            )
    check_known(f"{place}unit", content["unit"])
    return Channel(**content)


def _provenance(content: object, place: str) -> Provenance:
    keys = ("source", "note")
    content = _mapping(content, place, required=keys, known=keys)
    with placed(place):
        return Provenance(**content)


def place_of(position: int, name: str) -> str:
    """Name a block's place in the chain, for messages."""
    return f"chain: block {position + 1} ({name}): "


_BLOCK = "one block and its parameters, such as '- gain: {value: 2.0}'"


def _block(content: object, position: int) -> Block:
    where = f"chain: block {position + 1}: "
    if isinstance(content, str):
        content = {content: None}  # a block without parameters may stand as a word
    if not isinstance(content, dict) or not content:
        raise InputError(f"{where}{short(content)}; expected {_BLOCK}")
    first = next(iter(content))
    known = blocks(first)
    refuse_unknown(first, known, f"{where}unknown block {short(first)}")
    if len(content) > 1:
        raise InputError(
            f"{where}{len(content)} keys ({', '.join(map(str, content))}); expected "
            f"{_BLOCK}: its parameters deeper than its name"
        )
    ((name, values),) = content.items()
    place = place_of(position, name)
    values = _mapping({} if values is None else values, place)
    with placed(place):
        return known[name].from_mapping(values)

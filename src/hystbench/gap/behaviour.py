"""What effects are called in words, and what causes them in the device at hand.

A name in gap.json, in a model file and behind ``--without`` is that of a block. Where
that is the name of one cause among several, sentences call it by what it does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from hystbench.device_kinds import BEHAVIOURS, DeviceKind, behaviour_of, causes_of
from hystbench.gap.progress import Say
from hystbench.quantities import Quantities

_NAMED_BY_A_CAUSE = re.compile(rf"(?<![\w-])({'|'.join(BEHAVIOURS)})(?![\w-])")
#: Keys of gap.json that hold sentences.
_SENTENCES = ("reason", "sentence", "why")
#: Parts of gap.json that hold names of the user's.
_OF_THE_USER = (
    *("dataset", "model", "command", "simulator", "warnings", "records"),
    *("record_values", "runs_away", "black_box", "base_parameters"),
)


def in_words(text: str) -> str:
    """Call effects by what they do, in a sentence or where one name stands."""
    return _NAMED_BY_A_CAUSE.sub(lambda found: behaviour_of(found[1]), text)


def say_in_words(say: Say) -> Say:
    """Tell a line of progress in words."""
    return lambda line: say(in_words(line))


def for_readers(content: Mapping[str, Any]) -> dict[str, Any]:
    """Give what gap.json holds as the page shows it: every name in words."""
    return {
        key: value if key in _OF_THE_USER else _each_text(value, in_words)
        for key, value in content.items()
    }


def with_device(
    content: Mapping[str, Any], kind: DeviceKind | None, quantities: Quantities
) -> dict[str, Any]:
    """Tell what the device is, and what causes the effects in it.

    Parameters
    ----------
    content : mapping
        What gap.json holds.
    kind : str, optional
        Kind of the device, where it is known.
    quantities : Quantities

    Returns
    -------
    dict
        With ``device``, with ``behaviour`` and ``causes`` of each effect, and with
        sentences that call effects by what they do.
    """
    told = {key: _sentences(value, key) for key, value in content.items()}
    told.pop("device", None)  # told where the fit records decided: it goes last
    told["effects"] = _with_causes(told["effects"], kind)
    for part in ("withdrawn", "built_in"):
        if told.get(part):
            own = _with_causes(told[part]["effects"], kind)
            told[part] = told[part] | {"effects": own}
    told["device"] = {
        "kind": kind,
        "input": quantities.input,
        "output": quantities.output,
        "causality": quantities.causality,
    }
    return told


def _with_causes(effects: list[dict[str, Any]], kind: DeviceKind | None) -> list[Any]:
    return [
        item
        | {
            "behaviour": behaviour_of(item["name"]),
            "causes": list(causes_of(item["name"], kind)),
        }
        for item in effects
    ]


def _sentences(value: Any, key: str = "") -> Any:
    """Word the sentences at any depth; names stay."""
    if isinstance(value, Mapping):
        return {name: _sentences(item, name) for name, item in value.items()}
    if isinstance(value, list):
        return [_sentences(item, key) for item in value]
    worded = isinstance(value, str) and key in _SENTENCES
    return in_words(value) if worded else value


def _each_text(value: Any, change: Callable[[str], str]) -> Any:
    if isinstance(value, Mapping):
        return {name: _each_text(item, change) for name, item in value.items()}
    if isinstance(value, list):
        return [_each_text(item, change) for item in value]
    return change(value) if isinstance(value, str) else value

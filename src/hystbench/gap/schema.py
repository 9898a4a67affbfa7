"""What gap.json holds, as a JSON Schema: the contract with readers and judges.

What each key means, and when it is null, stands in ``docs/gap-json.md``; a test holds
the two together.
"""

from __future__ import annotations

from typing import Any, get_args

from hystbench.device_kinds import DEVICE_KINDS
from hystbench.gap.view_kinds import ViewKind
from hystbench.quantities import QUANTITIES

Part = dict[str, Any]

NUMBER = {"type": "number"}
SHARE = {"type": "number", "minimum": 0, "maximum": 1}
OPTIONAL = {"type": ["number", "null"]}
FLAG = {"type": "boolean"}
WORDS = {"type": "string"}
WORDS_OR_NULL = {"type": ["string", "null"]}


def _whole(least: int) -> Part:
    return {"type": "integer", "minimum": least}


def _one_of(*words: str | None) -> Part:
    return {"enum": list(words)}


def _list(items: Part, **more: int) -> Part:
    return {"type": "array", "items": items} | more


def _named(values: Part) -> Part:
    """Give an object of any keys."""
    return {"type": "object", "additionalProperties": values}


def _or_null(part: Part) -> Part:
    return {"oneOf": [part, {"type": "null"}]}


def _object(required: Part, **optional: Any) -> Part:
    return {
        "type": "object",
        "required": list(required),
        "additionalProperties": False,
        "properties": required | optional,
    }


NAMES = _list(WORDS)
VERDICT = _one_of("named", "parameters", "no-gap", "unnamed")
INTERVAL = _list(NUMBER, minItems=2, maxItems=2)
# A range where the floor is only an upper bound.
EXPLAINED = {"oneOf": [OPTIONAL, _list(NUMBER, minItems=2)]}

VALUE = _object(
    {
        "value": {"type": ["number", "string", "array"]},
        "standard_error": {"type": ["number", "null", "array"]},
        "unit": WORDS,
    }
)
EFFECT = _object(
    {
        "name": WORDS,
        "place": WORDS,
        "parameters": _named(VALUE),
        "confidence": SHARE,
        "cannot_be_told_from": NAMES,
    },
    size_error=OPTIONAL,
    blocks=NAMES,
    behaviour=WORDS,
    causes=NAMES,
)
VIEW = _object(
    {
        "view": _one_of(*get_args(ViewKind)),
        "axis": WORDS,
        "from": {"type": ["number", "string"]},
        "to": {"type": ["number", "string"]},
        "unit": WORDS,
        "share_of_gap_power": NUMBER,
        "p_value": SHARE,
        "sentence": WORDS,
    }
)

GAP = _object(
    {
        "before": NUMBER,
        "after": OPTIONAL,
        "noise_floor": NUMBER,
        "floor_method": _one_of("repeats", "declared", "upper-bound"),
        "explained": EXPLAINED,
    },
    before_interval=INTERVAL,
    after_interval=INTERVAL,
    interval=INTERVAL,
)
FIT = _object(
    {
        "before": NUMBER,
        "after": NUMBER,
        "explained": OPTIONAL,
        "new_in_every_record": NUMBER,
        "noise": NUMBER,
        "step_error": OPTIONAL,
        "floor": NUMBER,
        "left": NUMBER,
        "lone_share": NUMBER,
        "unrepeated": OPTIONAL,
    }
)
HOLD_OUT = {"name": WORDS, "before": NUMBER, "after": OPTIONAL}
RUNG = _object({"name": WORDS, "rms": OPTIONAL})
AWAY = _object(
    {"record": WORDS, "from_s": NUMBER, "refused": WORDS_OR_NULL, "sentence": WORDS}
)
WITHDRAWN = _object(
    {
        "names": NAMES,
        "verdict": VERDICT,
        "effects": _list(EFFECT),
        "before": NUMBER,
        "after": OPTIONAL,
        "records": _list(_object(HOLD_OUT)),
        "why": WORDS,
    }
)
SHORTFALL = _object({"fit": OPTIONAL, "hold_out": OPTIONAL, "sentence": WORDS})
BLACK_BOX = _object(
    {},
    explained_on_folds=OPTIONAL,
    after=OPTIONAL,
    explained=EXPLAINED,
    after_interval=INTERVAL,
    interval=INTERVAL,
    records=_list(
        _object(HOLD_OUT | {"named": OPTIONAL, "outside": NAMES}, explained=EXPLAINED)
    ),
    outside=_or_null(_object({"before": NUMBER, "after": OPTIONAL, "named": OPTIONAL})),
)

UNNAMED = _object(
    {
        "allowed": NUMBER,
        "structured": NUMBER,
        "by_chance": NUMBER,
        "changing": OPTIONAL,
        "unrelated": NUMBER,
        "sort": _one_of(
            *("strength", "gain", "path", "history", "memory", "curve", "unrelated"),
            None,
        ),
        "sentence": WORDS_OR_NULL,
        "factors": _list(NUMBER),
    }
)
RECORD_VALUES = _object(
    {
        "kinds": _list(_one_of("delay", "gain", "offset"), minItems=1),
        "records": _list(
            _object(
                {"name": WORDS, "delay_s": NUMBER, "gain": NUMBER, "offset": NUMBER}
            )
        ),
        "share_of_gap_power": NUMBER,
        "sentence": WORDS,
    }
)

TESTED = _object(
    {
        "place": WORDS,
        "form": WORDS,
        "position": {"type": ["integer", "null"], "minimum": 0},
        "score": NUMBER,
    }
)
TAKEN_OUT = _object({"name": WORDS, "reason": WORDS})
RANK = _object(
    {
        "round": _whole(1),
        "look": _whole(0),
        "instead_of": WORDS_OR_NULL,
        "beside": NAMES,
        "name": WORDS,
        "place": WORDS,
        "taken": FLAG,
        "refitted": FLAG,
        "held_back": OPTIONAL,
    },
    form=WORDS,
    score=NUMBER,
    gain=NUMBER,
    declined=WORDS,
    variants=_list(TESTED),
)

SETTING = _object(
    {"value": {"type": ["number", "array"], "items": NUMBER}, "unit": WORDS}
)
PAIR = _object(
    {
        "of": WORDS,
        "names": _list(WORDS, minItems=2, maxItems=2),
        "separation": NUMBER,
        "existing_separation": NUMBER,
        "largest_separation": NUMBER,
    }
)
EXPERIMENT = _object(
    {
        "excitation": WORDS,
        "parameters": _named(SETTING),
        "sampling_interval_s": NUMBER,
        "separation": NUMBER,
        "existing_separation": NUMBER,
        "pairs": _list(PAIR),
        "left_out": _list(_object({"of": WORDS, "name": WORDS})),
        "sentence": WORDS,
    }
) | {"type": ["object", "null"]}

PUT_IN = _object(
    {"name": WORDS, "place": WORDS, "form": WORDS, "parameters": _named(VALUE)},
    behaviour=WORDS,
    causes=NAMES,
)
BUILT_IN = _object(
    {"effects": _list(PUT_IN), "before": NUMBER, "after": NUMBER, "sentence": WORDS}
)
DEVICE = _object(
    {
        "kind": _one_of(*DEVICE_KINDS, None),
        "input": _one_of(*QUANTITIES),
        "output": _one_of(*QUANTITIES),
        "causality": WORDS,
    }
)
CHANNEL = _object({"name": WORDS, "unit": WORDS})
SIMULATOR = _object(
    {
        "input": CHANNEL,
        "output": CHANNEL,
        "functions": NAMES,
        "runs_again": FLAG,
        "sampling_interval_s": NUMBER,
    }
)

SCHEMA = _object(
    {
        "dataset": WORDS,
        "model": WORDS,
        "unit": WORDS,
        "verdict": VERDICT,
        "reason": WORDS,
        "effects": _list(EFFECT),
        "where": _list(VIEW),
        "gap": GAP,
        "ranking": _list(RANK),
        "next_experiment": EXPERIMENT,
    },
    records=_list(_object(HOLD_OUT, explained=EXPLAINED)),
    ladder=_list(RUNG),
    fit=FIT,
    unnamed=UNNAMED,
    runs_away=_list(AWAY),
    record_values=_or_null(RECORD_VALUES),
    withdrawn=_or_null(WITHDRAWN),
    asked=_object(
        {"without": NAMES, "with": NAMES, "sentence": WORDS}, impossible=NAMES
    ),
    device=DEVICE,
    built_in=BUILT_IN,
    command=_object({"dataset": WORDS, "model": WORDS, "out": WORDS}),
    not_tried=NAMES,
    taken_out=_list(TAKEN_OUT),
    shortfall=_or_null(SHORTFALL),
    black_box=_or_null(BLACK_BOX),
    base_parameters={"type": "object"},
    simulator=SIMULATOR,
    calls_used_up=_object({"bound": {"type": "integer"}, "sentence": WORDS}),
    warnings=NAMES,
    no_experiment=WORDS,
    observer=_object(
        {
            "damper": NUMBER,
            "free_run_left": NUMBER,
            "errors_grow": NUMBER,
            "sentence": WORDS,
        }
    ),
)

_NOTHING: dict[str, Any] = {"array": [], "string": ""}
LEFT_OUT = {
    key: _NOTHING.get(part.get("type"))
    for key, part in SCHEMA["properties"].items()
    if key not in SCHEMA["required"]
}
"""What stands for each key that gap.json may leave out."""

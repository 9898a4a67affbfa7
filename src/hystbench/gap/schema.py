"""What gap.json holds, as a JSON Schema: the contract with readers and judges."""

from __future__ import annotations

from typing import Any, get_args

from hystbench.device_kinds import DEVICE_KINDS
from hystbench.gap.view_kinds import ViewKind
from hystbench.quantities import QUANTITIES

NUMBER = {"type": "number"}
OPTIONAL = {"type": ["number", "null"]}
WORDS = {"type": "string"}
NAMES = {"type": "array", "items": {"type": "string"}}


def _object(required: dict[str, Any], **optional: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "required": list(required),
        "additionalProperties": False,
        "properties": required | optional,
    }


VALUE = _object(
    {
        "value": {"type": ["number", "string", "array"]},
        "standard_error": {"type": ["number", "null", "array"]},
        "unit": {"type": "string"},
    }
)

EFFECT = _object(
    {
        "name": {"type": "string"},
        "place": {"type": "string"},
        "parameters": {"type": "object", "additionalProperties": VALUE},
        "confidence": {"type": "number", "minimum": 0, "maximum": 1},
        "cannot_be_told_from": NAMES,
    },
    # Standard error of what it adds to the output, in times of it; null where that
    # cannot be told.
    size_error=OPTIONAL,
    # Labels of the blocks of model.yaml that stand for it.
    blocks=NAMES,
    # What it is called by what it does, and what usually causes it: in such a device,
    # where its kind is known.
    behaviour=WORDS,
    causes=NAMES,
)

VIEW = _object(
    {
        "view": {"enum": list(get_args(ViewKind))},
        "axis": {"type": "string"},
        "from": {"type": ["number", "string"]},
        "to": {"type": ["number", "string"]},
        "unit": {"type": "string"},
        "share_of_gap_power": NUMBER,
        "p_value": {"type": "number", "minimum": 0, "maximum": 1},
        "sentence": {"type": "string"},
    }
)

# Share of the power above the floor that is gone; a range where the floor is only an
# upper bound; null where there is no power above it; zero where the model runs away on
# a hold-out record.
EXPLAINED = {"oneOf": [OPTIONAL, {"type": "array", "items": NUMBER, "minItems": 2}]}

INTERVAL = {"type": "array", "items": NUMBER, "minItems": 2, "maxItems": 2}

GAP = _object(
    {
        "before": NUMBER,
        # Null where the model runs away on a hold-out record: it has no bound there.
        "after": OPTIONAL,
        "noise_floor": NUMBER,
        "floor_method": {"enum": ["repeats", "declared", "upper-bound"]},
        "explained": EXPLAINED,
    },
    # 95 % of the draws of one bootstrap: of both rms, and of what is explained.
    before_interval=INTERVAL,
    after_interval=INTERVAL,
    interval=INTERVAL,
)

# A hold-out record on which the model with its effects has no bounded output.
AWAY = _object(
    {
        "record": {"type": "string"},
        "from_s": NUMBER,
        # What a simulator of somebody's own said that refused the record.
        "refused": {"type": ["string", "null"]},
        "sentence": WORDS,
    }
)

FIT = _object(
    {
        # RMS over the fit records alike, of the base and of the model with its effects.
        "before": NUMBER,
        "after": NUMBER,
        # The share of the power above the floor that is gone there, and how much of it
        # went to signals that are new in every record and predict no other.
        "explained": OPTIONAL,
        "new_in_every_record": NUMBER,
        # RMS of the noise, of what the simulation of the model with its effects misses
        # by its own steps, and of both: where that is reached no effect is added. Null
        # where a simulator whose inside is not seen is in the chain.
        "noise": NUMBER,
        "step_error": OPTIONAL,
        "floor": NUMBER,
        # Share of the gap that no effect takes away; it lowers every confidence. Of the
        # whole gap, or of what no wrong hysteresis could do, whichever is less.
        "left": NUMBER,
        # Share of the power of what is left that stands in lone samples; and how much
        # of it differs between periods of the same input, above the noise's power and
        # in units of that. Null where no record repeats.
        "lone_share": NUMBER,
        "unrepeated": OPTIONAL,
    }
)

# What the named effects cannot own of what they leave on the fit records, as shares of
# the power of the gap.
UNNAMED = _object(
    {
        # As the user allows it: more of `structured` withdraws the names; `changing`
        # decides nothing.
        "allowed": NUMBER,
        # What follows known signals; what goes if the effects may change in time (null
        # where none acts on the input); what follows no known signal.
        "structured": NUMBER,
        "changing": OPTIONAL,
        "unrelated": NUMBER,
        # Of what sort it is, and in words; null where no more stays than may.
        "sort": {"enum": ["strength", "history", "memory", "curve", "unrelated", None]},
        "sentence": {"type": ["string", "null"]},
        # The effects' strength in each fit record, as a multiple of what it is in all.
        "factors": {"type": "array", "items": NUMBER},
    }
)

# Where the hold-out records show far less than the fit records promised: both shares
# of the power above the floor that are gone, and what the reader is told.
SHORTFALL = _object(
    {"fit": OPTIONAL, "hold_out": OPTIONAL, "sentence": {"type": "string"}}
)

# A delay, a gain or an offset that some fit records have of their own, by record: no
# effect. `share_of_gap_power` is above the noise floor, on the fit records.
RECORD_VALUES = _object(
    {
        "kinds": {
            "type": "array",
            "items": {"enum": ["delay", "gain", "offset"]},
            "minItems": 1,
        },
        "records": {
            "type": "array",
            "items": _object(
                {"name": WORDS, "delay_s": NUMBER, "gain": NUMBER, "offset": NUMBER}
            ),
        },
        "share_of_gap_power": NUMBER,
        "sentence": WORDS,
    }
)

# A hold-out record before and after; null where the model runs away on it.
HOLD_OUT = {"name": WORDS, "before": NUMBER, "after": OPTIONAL}

# Names that the hold-out records took back: the model with them is worse there than
# the base. RMS over the hold-out records of the base and of that model, null where it
# has no bounded output.
WITHDRAWN = _object(
    {
        "names": NAMES,
        # The word of the fit records, and what they decided.
        "verdict": {"enum": ["named", "parameters", "no-gap", "unnamed"]},
        "effects": {"type": "array", "items": EFFECT},
        "before": NUMBER,
        "after": OPTIONAL,
        "records": {
            "type": "array",
            "items": _object(HOLD_OUT),
        },
        "why": WORDS,
    }
)

# A flexible model of the residual, beside which the named effects stand; `outside` are
# the records that lie outside what was fitted, together.
BLACK_BOX = _object(
    {},
    explained_on_folds=OPTIONAL,
    after=OPTIONAL,
    explained=EXPLAINED,
    after_interval=INTERVAL,
    interval=INTERVAL,
    records={
        "type": "array",
        "items": _object(
            HOLD_OUT | {"named": OPTIONAL, "outside": NAMES}, explained=EXPLAINED
        ),
    },
    outside={
        "oneOf": [
            _object({"before": NUMBER, "after": OPTIONAL, "named": OPTIONAL}),
            {"type": "null"},
        ]
    },
)

# Null where the model of a rung runs away on a hold-out record.
RUNG = _object({"name": {"type": "string"}, "rms": OPTIONAL})

# A place and form of an effect; its block's place in the chain, none beside it.
TESTED = _object(
    {
        "place": {"type": "string"},
        "form": {"type": "string"},
        "position": {"type": ["integer", "null"], "minimum": 0},
        "score": NUMBER,
    }
)

# An effect that was added and went out again.
TAKEN_OUT = _object({"name": {"type": "string"}, "reason": {"type": "string"}})

# A row of a ranking. `round` and `look` number the rankings: look 0 is the round
# itself, 1 and on are the second looks after it.
RANK = _object(
    {
        "round": {"type": "integer", "minimum": 1},
        "look": {"type": "integer", "minimum": 0},
        # The effect in whose place this one was tried; null in the round itself.
        "instead_of": {"type": ["string", "null"]},
        # The effects that were in the model beside which it was tried.
        "beside": NAMES,
        "name": {"type": "string"},
        "place": {"type": "string"},
        # Whether it is in the model by this ranking, added or kept.
        "taken": {"type": "boolean"},
        # Whether it was refitted with the whole model: only those can be a tie.
        "refitted": {"type": "boolean"},
        # The gain on records held back from the fit, of each likely effect that pays
        # on all fit records.
        "held_back": OPTIONAL,
    },
    form={"type": "string"},
    score=NUMBER,
    gain=NUMBER,
    declined={"type": "string"},
    variants={"type": "array", "items": TESTED},
)

# The excitation that tells the named effects from those that they cannot be told from
# best, over all of them at once. Separations are in noise floors: of the pair that is
# hardest, and of each pair.
EXPERIMENT = _object(
    {
        "excitation": {"type": "string"},
        "parameters": {
            "type": "object",
            "additionalProperties": _object(
                {
                    "value": {"type": ["number", "array"], "items": NUMBER},
                    "unit": {"type": "string"},
                }
            ),
        },
        "sampling_interval_s": NUMBER,
        "separation": NUMBER,
        "existing_separation": NUMBER,
        "pairs": {
            "type": "array",
            "items": _object(
                {
                    # The named effect in whose place both are, or which one of them is.
                    "of": {"type": "string"},
                    "names": NAMES | {"minItems": 2, "maxItems": 2},
                    "separation": NUMBER,
                    # By the existing record, and the excitation, best for this pair.
                    "existing_separation": NUMBER,
                    "largest_separation": NUMBER,
                }
            ),
        },
        # What is new in every record: no input brings it out.
        "left_out": {
            "type": "array",
            "items": _object({"of": {"type": "string"}, "name": {"type": "string"}}),
        },
        "sentence": WORDS,
    }
) | {"type": ["object", "null"]}

# Effects that the user put into the simulator, as they were fitted before the search,
# and the RMS residual on the hold-out records without and with them. `gap` begins with
# them: its `before` is this `after`.
BUILT_IN = _object(
    {
        "effects": {
            "type": "array",
            "items": _object(
                {
                    "name": WORDS,
                    "place": WORDS,
                    "form": WORDS,
                    "parameters": {"type": "object", "additionalProperties": VALUE},
                },
                behaviour=WORDS,
                causes=NAMES,
            ),
        },
        "before": NUMBER,
        "after": NUMBER,
        "sentence": WORDS,
    }
)

SCHEMA = _object(
    {
        "dataset": {"type": "string"},
        "model": {"type": "string"},
        "unit": {"type": "string"},
        "verdict": {"enum": ["named", "parameters", "no-gap", "unnamed"]},
        "reason": {"type": "string"},
        "effects": {"type": "array", "items": EFFECT},
        "where": {"type": "array", "items": VIEW},
        "gap": GAP,
        "ranking": {"type": "array", "items": RANK},
        "next_experiment": EXPERIMENT,
    },
    records={"type": "array", "items": _object(HOLD_OUT, explained=EXPLAINED)},
    # The base, the base re-tuned within what it leaves free, then effect by effect.
    ladder={"type": "array", "items": RUNG},
    fit=FIT,
    unnamed=UNNAMED,
    runs_away={"type": "array", "items": AWAY},
    record_values={"oneOf": [RECORD_VALUES, {"type": "null"}]},
    withdrawn={"oneOf": [WITHDRAWN, {"type": "null"}]},
    # Where the user put effects in or left some out, or the kind of device leaves some
    # out as impossible.
    asked=_object(
        {"without": NAMES, "with": NAMES, "sentence": WORDS}, impossible=NAMES
    ),
    # What the device is: its kind as dataset.yaml tells it, and what its units tell.
    device=_object(
        {
            "kind": {"enum": [*DEVICE_KINDS, None]},
            "input": {"enum": list(QUANTITIES)},
            "output": {"enum": list(QUANTITIES)},
            "causality": WORDS,
        }
    ),
    built_in=BUILT_IN,
    # What hystbench gap was called with, as typed, so that the page can show how to run
    # it again.
    command=_object({"dataset": WORDS, "model": WORDS, "out": WORDS}),
    # Effects that need a simulator that can be run again, where it cannot.
    not_tried={"type": "array", "items": {"type": "string"}},
    taken_out={"type": "array", "items": TAKEN_OUT},
    shortfall={"oneOf": [SHORTFALL, {"type": "null"}]},
    black_box={"oneOf": [BLACK_BOX, {"type": "null"}]},
    base_parameters={"type": "object"},
    # The model with its effects: what it takes and gives, how to run it.
    simulator=_object(
        {
            "input": _object({"name": WORDS, "unit": WORDS}),
            "output": _object({"name": WORDS, "unit": WORDS}),
            # Functions that must be importable where it runs.
            "functions": NAMES,
            # Whether it answers to other inputs than those of the records.
            "runs_again": {"type": "boolean"},
            "sampling_interval_s": NUMBER,
        }
    ),
    # Where --calls ended the search: how many were allowed.
    calls_used_up=_object({"bound": {"type": "integer"}, "sentence": WORDS}),
    # What of the dataset is hardly meant: copies, strange times, sizes and units.
    warnings={"type": "array", "items": WORDS},
    # Why next_experiment is null though effects cannot be told apart.
    no_experiment={"type": "string"},
)

_NOTHING: dict[str, Any] = {"array": [], "string": ""}
LEFT_OUT = {
    key: _NOTHING.get(part.get("type"))
    for key, part in SCHEMA["properties"].items()
    if key not in SCHEMA["required"]
}
"""What stands for each key that gap.json may leave out."""

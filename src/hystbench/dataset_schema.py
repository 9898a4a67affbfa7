"""What a dataset.yaml may say, as a JSON Schema."""

from __future__ import annotations

from typing import Any

from hystbench.device_kinds import KINDS
from hystbench.quantities import QUANTITIES


def _column(**more: dict[str, Any]) -> dict[str, Any]:
    """Describe a column of the records: name, unit, and what else it may say."""
    return {
        "type": "object",
        "required": ["column", "unit"],
        "additionalProperties": False,
        "properties": {
            "column": {"type": "string"},
            "unit": {"type": "string"},
            "meant": {"type": "boolean"},
            **more,
        },
    }


_CHANNEL: dict[str, Any] = {
    "name": {"type": "string"},
    "quantity": {"enum": list(QUANTITIES)},
}

SCHEMA: dict[str, Any] = {
    "type": "object",
    "required": ["name", "input", "output", "records"],
    "additionalProperties": False,
    "properties": {
        "name": {"type": "string", "pattern": r"^[A-Za-z0-9][A-Za-z0-9._-]*$"},
        "description": {"type": "string"},
        "time": _column(
            tolerance={"type": "number", "exclusiveMinimum": 0, "maximum": 0.5}
        ),
        "input": _column(
            **_CHANNEL, hold={"enum": ["zero-order", "linear", "band-limited"]}
        ),
        "output": _column(**_CHANNEL),
        "simulated": _column(),
        "device": {
            "type": "object",
            "required": ["kind"],
            "additionalProperties": False,
            "properties": {"kind": {"enum": list(KINDS)}},
        },
        "sampling_frequency_hz": {"type": "number", "exclusiveMinimum": 0},
        "noise_rms": {"type": "number", "exclusiveMinimum": 0},
        "identification": {"type": "string"},
        "records": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["file"],
                "additionalProperties": False,
                "properties": {
                    "file": {"type": "string"},
                    "sha256": {"type": "string", "pattern": "^[0-9a-f]{64}$"},
                    "name": {"type": "string"},
                    "group": {"type": "string"},
                    "rows": {
                        "type": "array",
                        "items": {"type": "integer", "minimum": 1},
                        "minItems": 2,
                        "maxItems": 2,
                    },
                    "sampling_frequency_hz": {"type": "number", "exclusiveMinimum": 0},
                    "missing": {"enum": ["interpolate"]},
                    "use": {"enum": ["fit", "hold-out"]},
                    "period_samples": {"type": "integer", "minimum": 2},
                    "stands_still": {
                        "type": "array",
                        "items": {"enum": ["input", "output"]},
                        "uniqueItems": True,
                    },
                    "meant": {
                        "type": "array",
                        "items": {"enum": ["copy", "amplitude"]},
                        "uniqueItems": True,
                    },
                },
            },
        },
    },
}

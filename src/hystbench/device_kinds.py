"""Kinds of devices, and what causes each effect in each of them.

The table is ``device_kinds.yaml``; an effect that is not in it says its causes itself.
One that nothing causes in a kind of device cannot be there: a search leaves it out. The
causes that are left say what the effect is called there.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Literal, get_args

from hystbench.yaml_files import load_yaml

DeviceKind = Literal[
    "magnetostrictive",
    "piezoelectric",
    "electromechanical",
    "hydraulic",
    "thermal",
    "electronic",
    "mechanical",
]

DEVICE_KINDS: tuple[DeviceKind, ...] = get_args(DeviceKind)

#: What an effect is called where its name is that of one of its causes.
BEHAVIOURS: Mapping[str, str] = {"eddy-diffusion": "diffusion-like lag"}


@cache
def causes() -> Mapping[str, Mapping[str, Sequence[DeviceKind]]]:
    """Read the table: by effect, then by cause, the kinds of devices."""
    table = load_yaml(Path(__file__).with_suffix(".yaml"))["causes"]
    return {
        effect: {
            cause: DEVICE_KINDS if kinds == ["any"] else kinds
            for cause, kinds in rows.items()
        }
        for effect, rows in table.items()
    }


def behaviour_of(effect: str) -> str:
    """Call an effect by what it does, whatever causes it."""
    return BEHAVIOURS.get(effect, effect.replace("-", " "))

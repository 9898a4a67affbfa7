"""The kinds of view: from where an engineer reads what a simulator lacks."""

from __future__ import annotations

from typing import Literal

ViewKind = Literal[
    "frequency",
    "amplitude",
    "rate",
    "branch",
    "slow-time",
    "delay",
    "unexplained",
    "record",
    "level",
]

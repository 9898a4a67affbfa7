"""Settings of a trial on two short records."""

from __future__ import annotations

import copy
from typing import Any

import yaml

from hystbench.settings import read_settings
from tests.conftest import ROOT, shorten

SIGNALS = ("sine-080hz", "sine-100hz")


def job(signals: tuple[str, ...] = SIGNALS, **budget: int) -> dict[str, Any]:
    """The project's own settings, cut down to seconds."""
    config = yaml.safe_load((ROOT / "config.yaml").read_text())
    shorten(config, 0.2)
    config["excitations"]["sine-001hz"] = {"sine": {"frequency_hz": 1, "duration_s": 1}}
    config["filters"]["order"] = 6
    small = {"starts": 1, "evaluations": 1, "last_evaluations": 1}
    config["structures"] |= small | budget
    settings = read_settings(config, ROOT / "workflow/schemas/config.schema.yaml")
    whole = copy.deepcopy(settings.structure_job)
    whole["signals"] = {name: whole["signals"][name] for name in signals}
    return whole

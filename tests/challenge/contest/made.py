"""Truths and answers made by hand."""

from __future__ import annotations

from typing import Any

from hystbench.challenge.contest.score import judge_answer
from hystbench.gap.schema import SCHEMA


def place(view, right, edges, shares, unit=""):
    return {
        "view": view,
        "right": right,
        "axis": view,
        "unit": unit,
        "from": edges[0],
        "to": edges[-1],
        "edges": edges,
        "shares": shares,
    }


#: A resonance whose power lies at 60 to 80 Hz (0.9) and, a little, below.
FREQUENCY = place("frequency", True, [0.0, 60.0, 80.0, 200.0], [0.1, 0.9, 0.0], "Hz")
AMPLITUDE = place("amplitude", False, [-1.0, 0.0, 1.0], [0.5, 0.5], "A")
TIME = place("slow-time", False, [0.0, 1.0, 2.0], [0.25, 0.75], "s")
BRANCH = {
    "view": "branch",
    "right": False,
    "axis": "branch",
    "unit": "",
    "names": ["rising"],
    "share": 0.7,
    "shares": {"rising": 0.7, "falling": 0.3},
}
DELAY = {
    "view": "delay",
    "right": True,
    "axis": "delay",
    "unit": "s",
    "from": 5e-4,
    "to": 2e-3,
    "value": 1e-3,
    "share": 0.8,
}
WHERE = [FREQUENCY, AMPLITUDE, TIME, BRANCH, DELAY]


def effect(name="resonance", form="mode", parameters=None, where=WHERE):
    return {
        "name": name,
        "form": form,
        "place": "mechanics",
        "parameters": parameters or {},
        "ratio_db": 20.0,
        "ratio_retuned_db": 18.0,
        "where": list(where),
    }


def truth(*effects, kind="single", family="gpi", **more):
    return {
        "seed": 1,
        "kind": kind,
        "family": family,
        "ratio_db": 20.0 if effects else None,
        "noise_rms": 3.0,
        "effects": list(effects),
        "hold_out": {
            "gap_rms": 13.0,
            "explainable_rms": 12.0,
            "base_error_rms": 4.0,
        },
    } | more


def named(name, confidence=0.9, ties=(), parameters=None):
    return {
        "name": name,
        "place": "mechanics",
        "parameters": parameters or {},
        "confidence": confidence,
        "cannot_be_told_from": list(ties),
    }


def view(kind="frequency", low: Any = 60.0, high: Any = 80.0, unit="Hz"):
    return {
        "view": kind,
        "axis": kind,
        "from": low,
        "to": high,
        "unit": unit,
        "share_of_gap_power": 0.9,
        "p_value": 0.001,
        "sentence": "There.",
    }


def gap(*effects, verdict="named", views=(), before=13.0, after=5.0):
    return {
        "dataset": "d",
        "model": "m",
        "unit": "um",
        "verdict": verdict,
        "reason": "r",
        "effects": list(effects),
        "where": list(views),
        "gap": {
            "before": before,
            "after": after,
            "noise_floor": 3.0,
            "floor_method": "repeats",
            "explained": 0.9,
        },
        "ranking": [],
        "next_experiment": None,
    }


def answer(content, status="answered"):
    return {
        "status": status,
        "seconds": 2.0,
        "cpu_seconds": 1.5,
        "data": "0",
        "gap": content,
    }


def judged(about, content, confirm=lambda names: names, case="c", solver="s", **more):
    """Judge an answer to a case; ``more`` is of the answer."""
    return judge_answer(solver, case, about, answer(content, **more), SCHEMA, confirm)

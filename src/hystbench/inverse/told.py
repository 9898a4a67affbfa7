"""Tracking errors as a table and in words."""

from __future__ import annotations

from collections.abc import Sequence

from hystbench.inverse.tracking import (
    CODE,
    DRIVES,
    FIELD,
    LINEAR,
    OWN,
    WITH,
    WITHOUT,
    Tracked,
    follows,
)
from hystbench.model import Model

GOAL = 0.02
"""RMS error that is asked for, as a share of the stroke, to :data:`GOAL_HZ`."""
GOAL_HZ = 100.0


def table(rows: Sequence[Tracked], unit: str) -> str:
    """Write RMS and largest errors as a Markdown table, a reference a row."""
    lines = [
        "**Open-loop tracking on the twin, a simulation: RMS error (largest error), in "
        "% of the reference's peak-to-peak.**",
        "",
        "| reference | stroke (" + unit + ") | " + " | ".join(DRIVES.values()) + " |",
        "|---|---|" + "---|" * len(DRIVES),
    ]
    for name, own in _by_reference(rows).items():
        cells = [
            f"{100 * own[drive].rms:.2f} ({100 * own[drive].largest:.1f})"
            for drive in DRIVES
        ]
        lines.append(f"| {name} | {own[LINEAR].stroke:.1f} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def verdict(rows: Sequence[Tracked]) -> str:
    """Say what the inverse is worth, and where the goal is missed."""
    within = {
        name: own
        for name, own in _by_reference(rows).items()
        if own[LINEAR].reference.highest_hz <= GOAL_HZ
    }
    missed = [
        f"{name} ({100 * own[WITH].rms:.2f} %)"
        for name, own in within.items()
        if own[WITH].rms > GOAL
    ]
    parts = [
        f"RMS errors on the {len(within)} references to {GOAL_HZ:g} Hz, in % of the "
        f"stroke: {_range(within, LINEAR)} with a linear gain, "
        f"{_range(within, WITHOUT)} with the inverse of the slow loop's model, "
        f"{_range(within, FIELD)} with that of the rate-dependent Prandtl-Ishlinskii "
        "model, "
        f"{_range(within, WITH)} with the gap's effects in the slow loop's, "
        f"{_range(within, CODE)} with the same sample by sample, as exported, and "
        f"{_range(within, OWN)} with the twin's own model, which no device comes with.",
        f"The goal, {100 * GOAL:g} %, is met on {len(within) - len(missed)} of "
        f"{len(within)} references"
        + (f", and missed on {', '.join(missed)}." if missed else "."),
    ]
    worse = [
        f"{name} ({100 * own[WITH].rms:.2f} instead of {100 * own[WITHOUT].rms:.2f} %)"
        for name, own in within.items()
        if own[WITH].rms > own[WITHOUT].rms
    ]
    if worse:
        parts.append(f"The effects make it worse on {', '.join(worse)}.")
    return " ".join(parts) + "\n"


def left(rows: Sequence[Tracked], model: Model) -> str:
    """Say what the inverse of the rate-dependent model leaves on that model itself."""
    errors = [
        100 * follows(model, row).rms
        for row in rows
        if row.drive == FIELD and row.reference.highest_hz <= GOAL_HZ
    ]
    return (
        "The inverse of the rate-dependent model leaves "
        f"{min(errors):.2f} to {max(errors):.2f} % on that model itself; the rest is "
        "the model's own error.\n"
    )


def _range(rows: dict[str, dict[str, Tracked]], drive: str) -> str:
    errors = [100 * own[drive].rms for own in rows.values()]
    return f"{min(errors):.2f} to {max(errors):.2f}"


def _by_reference(rows: Sequence[Tracked]) -> dict[str, dict[str, Tracked]]:
    found: dict[str, dict[str, Tracked]] = {}
    for row in rows:
        found.setdefault(row.reference.name, {})[row.drive] = row
    return found

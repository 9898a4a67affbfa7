"""The paper's models on devices, beside published results, as tables and in words."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.devices.errors import LAST, DeviceError
from hystbench.files import write_csv, write_text
from hystbench.published import FILTERS, load

WRITTEN = (
    *("errors.csv", "tracking.csv", "simulation.csv", "beside.csv"),
    "verdict.md",
)
"""What a comparison on devices writes."""

MODELS = (*FILTERS, "rdgpi")
COLUMNS = (*("dataset", "model", "question", "how", "rms", "relative_error", "unit"),)
PUBLISHED_COLUMNS = ("dataset", "whose", "model", "rms", "unit", "protocol")


def write_devices(
    errors: Sequence[DeviceError],
    gaps: Mapping[str, Mapping[str, str]],
    out: Path,
) -> None:
    """Write all errors, and what they come to.

    Parameters
    ----------
    errors : sequence of DeviceError
    gaps : mapping of str to mapping
        Rows of the summary of the gap, by dataset; one that is missing leaves cells
        empty.
    out : Path
    """
    write_csv(
        out / "errors.csv",
        COLUMNS,
        [
            (
                *(e.dataset, e.model, e.question, e.how),
                *(_short(e.rms), _short(e.relative), e.unit),
            )
            for e in errors
        ],
    )
    write_csv(
        out / "tracking.csv",
        ("dataset", "step sizes", *FILTERS, "last output", "order"),
        _tracking(errors),
    )
    write_csv(
        out / "simulation.csv",
        ("dataset", "unit", *MODELS, "base", "gap: before", "gap: after", "named"),
        _simulation(errors, gaps),
    )
    beside = [*_ours(errors, gaps), *_published()]
    order = list(dict.fromkeys(e.dataset for e in errors))
    known = [row for row in beside if row[0] in order]
    known.sort(key=lambda row: (order.index(row[0]), row[3]))
    write_csv(
        out / "beside.csv",
        PUBLISHED_COLUMNS,
        [(*row[:3], _short(row[3]), *row[4:]) for row in known],
    )
    write_text(out / "verdict.md", verdict(errors) + "\n")


def verdict(errors: Sequence[DeviceError]) -> str:
    """Say whether the paper's order of its filters holds on the devices."""
    tracking = _by_how(e for e in errors if e.question == "tracking")
    fixed = _by_how(e for e in errors if e.question == "simulation")
    paper = published_order()
    parts = [
        "By the geometric mean of the printed MSE the paper's filters come in the "
        f"order {', '.join(paper)}."
    ]
    for how, words in (
        *((how, f"tracking, {how}") for how in tracking if how in _of_all(tracking)),
        *((how, f"simulation, {how}") for how in fixed if how in _of_all(fixed)),
    ):
        own = (tracking if words.startswith("tracking") else fixed)[how]
        first = [name for name, rms in own.items() if _first(rms) == paper[0]]
        stand = sum(_pairs(rms, paper) for rms in own.values())
        total = len(own) * math.comb(len(paper), 2)
        parts.append(
            f"{words[0].upper()}{words[1:]}: the {paper[0]} filter is first on "
            f"{len(first)} of {len(own)} devices"
            f"{' (' + ', '.join(first) + ')' if first else ''}, and {stand} of {total} "
            "pairs of filters stand in the paper's order."
        )
    last = {e.dataset: e.rms for e in errors if e.model == LAST}
    beaten = sum(
        min(min(own[name].values()) for own in tracking.values()) < rms
        for name, rms in last.items()
    )
    parts.append(
        f"On {beaten} of {len(last)} devices the best filter, however its step size is "
        "chosen, tracks the output better than to repeat its last value."
    )
    return " ".join(parts)


def published_order() -> list[str]:
    """Order the filters by the geometric mean of their printed MSE over all signals."""
    printed: dict[str, list[float]] = {name: [] for name in FILTERS}
    for pair in load():
        if pair.model in printed and pair.table != REPEATED:
            printed[pair.model].append(pair.mse.value)
    return sorted(FILTERS, key=lambda name: float(np.mean(np.log(printed[name]))))


REPEATED = 4
"""The paper's table that repeats values of the others for the GPO filter."""

Rms = dict[str, float]
ByHow = dict[str, dict[str, Rms]]


def _by_how(errors: Iterable[DeviceError]) -> ByHow:
    """Set out RMS errors of filters by how they were run, and by dataset."""
    found: ByHow = {}
    for e in errors:
        if e.model in FILTERS:
            found.setdefault(e.how, {}).setdefault(e.dataset, {})[e.model] = e.rms
    return found


def _of_all(found: ByHow) -> dict[str, None]:
    """Give the ways in which every filter was run."""
    return {
        how: None
        for how, own in found.items()
        if all(len(rms) == len(FILTERS) for rms in own.values())
    }


def _first(rms: Rms) -> str:
    return min(rms, key=lambda name: rms[name])


def _pairs(rms: Rms, order: Sequence[str]) -> int:
    """Count the pairs of filters that stand in an order."""
    return sum(rms[first] < rms[second] for first, second in combinations(order, 2))


def _tracking(errors: Sequence[DeviceError]) -> list[list[object]]:
    found = _by_how(e for e in errors if e.question == "tracking")
    square = {(e.dataset, e.model, e.how): e.relative for e in errors}
    last = {e.dataset: e.relative for e in errors if e.model == LAST}
    rows: list[list[object]] = []
    for name in last:
        for how in _of_all(found):
            rms = found[how][name]
            rows.append(
                [
                    name,
                    how,
                    *(_percent(square[name, model, how]) for model in FILTERS),
                    _percent(last[name]),
                    " < ".join(sorted(rms, key=lambda model: rms[model])),
                ]
            )
    return rows


def _simulation(
    errors: Sequence[DeviceError], gaps: Mapping[str, Mapping[str, str]]
) -> list[list[object]]:
    rows: list[list[object]] = []
    own = {(e.dataset, e.model): e for e in errors if e.question == "simulation"}
    for name in dict.fromkeys(e.dataset for e in errors):
        gap = gaps.get(name, {})
        rows.append(
            [
                name,
                own[name, FILTERS[0]].unit,
                *(_short(own[name, model].rms) for model in MODELS),
                gap.get("base", ""),
                gap.get("before", ""),
                gap.get("after", ""),
                gap.get("effects", "") if gap.get("verdict") == "named" else "none",
            ]
        )
    return rows


Row = tuple[str, str, str, float, str, str]


def _ours(
    errors: Sequence[DeviceError], gaps: Mapping[str, Mapping[str, str]]
) -> list[Row]:
    """Give our simulation errors of the datasets that have published ones."""
    sets = {row["dataset"]: row for row in baselines()}
    rows: list[Row] = []
    for e in errors:
        if e.question == "simulation" and e.dataset in sets:
            scale, unit = _scale(e.unit, sets[e.dataset]["unit"])
            rows.append((e.dataset, "ours", e.model, scale * e.rms, unit, e.how))
    for name, gap in gaps.items():
        if name not in sets:
            continue
        scale, unit = _scale(gap["unit"], sets[name]["unit"])
        named = gap["effects"] if gap["verdict"] == "named" else ""
        for key, what in (("before", gap["base"]), ("after", f"+ {named}")):
            if key == "before" or named:
                label = f"gap: {gap['base']} {'' if key == 'before' else what}".strip()
                rows.append((name, "ours", label, scale * float(gap[key]), unit, key))
    return rows


def _published() -> list[Row]:
    return [
        (
            row["dataset"],
            "published",
            row["model"],
            float(row["rms"]),
            row["unit"],
            "Champneys et al. 2024",
        )
        for row in baselines()
    ]


def baselines() -> list[dict[str, str]]:
    """Read the published baselines: see docs/devices.md on where they come from."""
    place = files("hystbench.published") / "baselines.csv"
    return list(csv.DictReader(place.read_text(encoding="utf-8").splitlines()))


def read_gaps(path: Path) -> dict[str, dict[str, str]]:
    """Read the summary of the gap, by dataset."""
    with path.open(encoding="utf-8", newline="") as stream:
        return {row["dataset"]: row for row in csv.DictReader(stream)}


def _scale(ours: str, theirs: str) -> tuple[float, str]:
    """Give the factor from our unit to the published one."""
    if ours == theirs:
        return 1.0, ours
    if theirs == f"m{ours}":
        return 1e3, theirs
    raise ValueError(f"{ours} and {theirs}: not told apart")


def _percent(value: float) -> str:
    return "diverged" if math.isinf(value) else f"{100 * value:.1f} %"


def _short(value: Any) -> Any:
    if isinstance(value, float):
        return "diverged" if math.isinf(value) else f"{value:.4g}"
    return value

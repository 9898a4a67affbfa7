"""The paper's models on devices, beside published results, as tables and in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.compare.rows import read_rows, write_fields
from hystbench.devices.errors import LAST, DeviceError
from hystbench.files import write_csv, write_text
from hystbench.published import FILTERS, load, read_csv

WRITTEN = (
    *("errors.csv", "tracking.csv", "simulation.csv", "beside.csv"),
    "verdict.md",
)
"""What a comparison on devices writes."""

MODELS = (*FILTERS, "rdgpi")
COLUMNS = (
    *("dataset", "model", "question", "how", "rms"),
    *("relative_error=relative", "unit"),
)
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
    write_fields(out / "errors.csv", COLUMNS, errors, _short)
    tracking = ("dataset", "step sizes", *FILTERS, "last output", "order")
    write_csv(out / "tracking.csv", tracking, _tracking(errors))
    gap = ("base", "gap: before", "gap: after", "named")
    simulation = ("dataset", "unit", *MODELS, *gap)
    write_csv(out / "simulation.csv", simulation, _simulation(errors, gaps))
    order = list(dict.fromkeys(e.dataset for e in errors))
    beside = [row for row in (*_ours(errors, gaps), *_published()) if row[0] in order]
    beside.sort(key=lambda row: (order.index(row[0]), row[3]))
    rows = (map(_short, row) for row in beside)
    write_csv(out / "beside.csv", PUBLISHED_COLUMNS, map(list, rows))
    write_text(out / "verdict.md", verdict(errors) + "\n")


def verdict(errors: Sequence[DeviceError]) -> str:
    """Say whether the paper's order of its filters holds on the devices."""
    paper = published_order()
    parts = [
        "By the geometric mean of the printed MSE the paper's filters come in the "
        f"order {', '.join(paper)}."
    ]
    for question in ("tracking", "simulation"):
        for how, own in _of_all_filters(errors, question).items():
            first = [name for name, rms in own.items() if _ranked(rms)[0] == paper[0]]
            stand = sum(_pairs(rms, paper) for rms in own.values())
            told = f" ({', '.join(first)})" if first else ""
            parts.append(
                f"{question.title()}, {how}: the {paper[0]} filter is first on "
                f"{len(first)} of {len(own)} devices{told}, and {stand} of "
                f"{len(own) * math.comb(len(paper), 2)} pairs of filters stand in the "
                "paper's order."
            )
    last = {e.dataset: e.rms for e in errors if e.model == LAST}
    filters = [e for e in errors if e.question == "tracking" and e.model in FILTERS]
    beaten = sum(
        min(e.rms for e in filters if e.dataset == name) < rms
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
"""RMS errors by filter."""


def _of_all_filters(
    errors: Iterable[DeviceError], question: str
) -> dict[str, dict[str, Rms]]:
    """Set out the errors by how all filters were run, and by dataset."""
    found: dict[str, dict[str, Rms]] = {}
    for e in errors:
        if e.question == question and e.model in FILTERS:
            found.setdefault(e.how, {}).setdefault(e.dataset, {})[e.model] = e.rms
    return {
        how: own
        for how, own in found.items()
        if all(len(rms) == len(FILTERS) for rms in own.values())
    }


def _ranked(rms: Rms) -> list[str]:
    return sorted(rms, key=lambda name: rms[name])


def _pairs(rms: Rms, order: Sequence[str]) -> int:
    """Count the pairs of filters that stand in an order."""
    return sum(rms[first] < rms[second] for first, second in combinations(order, 2))


def _tracking(errors: Sequence[DeviceError]) -> Iterator[list[object]]:
    relative = {(e.dataset, e.model, e.how): _percent(e.relative) for e in errors}
    found = _of_all_filters(errors, "tracking")
    for last in (e for e in errors if e.model == LAST):
        for how, own in found.items():
            cells = [relative[last.dataset, model, how] for model in FILTERS]
            order = " < ".join(_ranked(own[last.dataset]))
            yield [last.dataset, how, *cells, _percent(last.relative), order]


def _simulation(
    errors: Sequence[DeviceError], gaps: Mapping[str, Mapping[str, str]]
) -> Iterator[list[object]]:
    own = {(e.dataset, e.model): e for e in errors if e.question == "simulation"}
    for name in dict.fromkeys(e.dataset for e in errors):
        gap = gaps.get(name, {})
        named = gap.get("effects", "") if gap.get("verdict") == "named" else "none"
        about = [gap.get(key, "") for key in ("base", "before", "after")]
        rms = [_short(own[name, model].rms) for model in MODELS]
        yield [name, own[name, FILTERS[0]].unit, *rms, *about, named]


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
    source = "Champneys et al. 2024"
    return [
        (
            *(row["dataset"], "published", row["model"]),
            float(row["rms"]),
            row["unit"],
            source,
        )
        for row in baselines()
    ]


def baselines() -> list[dict[str, str]]:
    """Read the published baselines: see docs/devices.md on where they come from."""
    return read_csv("baselines.csv")


def read_gaps(path: Path) -> dict[str, dict[str, str]]:
    """Read the summary of the gap, by dataset."""
    return {row["dataset"]: row for row in read_rows(path, ("dataset",))}


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

"""The verdict in a few sentences, for the report's first page and the terminal.

Every number comes from the summary.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from hystbench.compare.claims.claim import Judgement
from hystbench.compare.tables import Table

HEADERS = ("", "runs", "within a factor of 2", "median |log10(ours/paper)|", "diverged")


def _percent(fraction: float | None) -> str:
    return "none" if fraction is None else f"{100 * fraction:.0f} %"


def _median(value: float | None) -> str:
    return "none" if value is None else f"{value:.3f}"


def _row(name: str, part: Mapping[str, Any]) -> tuple[str, ...]:
    return (
        name,
        f"{part['cells']} of {part['cells_published']}",
        _percent(part["within_factor_2"]),
        _median(part["median_abs_log10_ratio"]),
        str(part["diverged"]),
    )


def rows(summary: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """List the lines of the small table: all filters, each model, other counts."""
    without = summary["without_inconsistent"]
    split = {"calibrated": "signals of the calibration", "held_out": "held-out signals"}
    return [
        _row("four filters", summary),
        *(_row(model, part) for model, part in summary["per_model"].items()),
        *(
            _row(
                name,
                summary[key]
                | {
                    "median_abs_log10_ratio": summary[key]["median_abs_log10_ratio_all"]
                },
            )
            for key, name in split.items()
            if key in summary
        ),
        _row("filters, without †", without["without_no"]),
        _row("filters, without † and ‡", without["without_no_and_undecided"]),
        _row("rdgpi", summary["rdgpi"]),
    ]


def sentences(summary: Mapping[str, Any]) -> list[str]:
    """Give the verdict in words."""
    order = summary["orderings"]
    said = []
    if summary["cells"] == 0:
        said.append(
            "No filter was run on a signal of the paper, so nothing is compared with "
            "its Tables 1-3."
        )
    else:
        said.append(
            f"Of the {summary['cells_published']} filter errors (MSE) in Tables 1-3, "
            f"{summary['cells']} were run on the twin."
        )
        # What a twin was fitted to and what it was not are never one number.
        halves = {"calibrated": "to which it is fitted", "held_out": "held out"}
        split = {key: words for key, words in halves.items() if key in summary}
        for key, words in split.items() or {"": ""}.items():
            part = summary[key] if key else summary
            if part["cells"]:
                said.append(_nearness(part, words))
        said.append(
            f"Ours order {order['agree']} of {order['compared']} pairs of filters "
            f"under one signal as the paper does (it has {order['published']})."
        )
    said.append(
        f"Of {summary['claims_total']} claims of the paper "
        f"{summary['claims_reproduced']} are reproduced, "
        f"{summary['claims_not_reproduced']} are not, and "
        f"{summary['claims_not_testable']} cannot be tested here."
    )
    said.append(_by_kind(summary["claims_by_kind"]))
    said.extend(_families(summary["claims_reproduced_where"]))
    said.append(
        "The twin is a simulation, since the measured data are not public: agreement "
        "says that the models do on such a plant as printed, not that the device was "
        "measured again."
    )
    return said


def _nearness(part: Mapping[str, Any], words: str) -> str:
    """Say how near a part of the cells comes to the paper."""
    medians = part["median_abs_log10_ratio"]
    if isinstance(medians, Mapping):
        medians = part["median_abs_log10_ratio_all"]
    typical = (
        "the typical run diverged"
        if medians is None
        else f"the typical MSE is off by a factor of {10**medians:.2f}"
    )
    return (
        f"Of the {part['cells']}{f' {words}' if words else ''}, "
        f"{_percent(part['within_factor_2'])} are within a factor of 2 of the paper "
        f"and {typical}."
    )


def _by_kind(kinds: Mapping[str, Mapping[str, int]]) -> str:
    """Say how many of the claims could have failed: results, apart from the rest."""
    results = kinds.get("result", {})
    given = kinds.get("condition", {})
    return (
        f"Among them are {sum(results.values())} results, of which "
        f"{results.get('reproduced', 0)} are reproduced and "
        f"{results.get('not_reproduced', 0)} are not; {given.get('reproduced', 0)} are "
        "conditions that hold because signals, orders and envelopes are made so."
    )


def _families(where: Mapping[str, int]) -> list[str]:
    """Say how many reproduced claims also hold where the hysteresis is another's."""
    other = where["every_family"] + where["some_families"]
    if other:
        return [
            f"Of {other} reproduced claims that were judged on twins with other "
            f"hysteresis too, {where['every_family']} hold on each of them."
        ]
    if where["one_family_run"]:
        return [
            "No twin with other hysteresis was run: the reproduced claims are shown on "
            "the GPI twin only, which the GPO filter's own operators make."
        ]
    return []


LEGEND = (
    "† printed pairs of MSE and RE that cannot be true beside the others of their "
    "signal; ‡ pairs of which one must be wrong, which one is unknown."
)


def verdict_rst(summary: Mapping[str, Any]) -> str:
    """Write the first page of the report as reStructuredText."""
    return _page(sentences(summary), _table(summary, "rst"))


def verdict_markdown(summary: Mapping[str, Any]) -> str:
    """Write the verdict as Markdown."""
    return _page(sentences(summary), _table(summary, "pipe"))


def _table(summary: Mapping[str, Any], style: str) -> str:
    """Write the small table; a bar has a meaning of its own in both markups."""
    headers = [header.replace("|", r"\|") for header in HEADERS]
    return _grid(rows(summary), headers, style)


def _grid(lines: Sequence[Sequence[str]], headers: Sequence[str], style: str) -> str:
    """Write a table of text in one of the styles of tabulate."""
    frame = pd.DataFrame(lines, columns=list(headers), dtype=str)
    return str(frame.to_markdown(index=False, tablefmt=style, disable_numparse=True))


def _page(said: Sequence[str], table: str) -> str:
    return "\n\n".join((" ".join(said[:-1]), said[-1], table, LEGEND)) + "\n"


def print_tables(
    tables: Iterable[Table],
    judgements: Iterable[Judgement],
    summary: Mapping[str, Any],
) -> str:
    """Write ours beside theirs and the claims for a terminal."""
    parts = []
    for table in tables:
        lines = table.frame.to_numpy().tolist()
        body = _grid(lines, list(table.frame.columns), "simple")
        parts.append("\n".join(filter(None, (table.caption, body, table.legend))))
    ledger = _grid(
        [(j.verdict, j.claim.id, j.published_bears_out) for j in judgements],
        ("verdict", "claim", "paper's own tables bear it out"),
        "simple",
    )
    numbers = _grid(rows(summary), HEADERS, "simple")
    return "\n\n".join((*parts, ledger, numbers, "\n".join(sentences(summary)))) + "\n"

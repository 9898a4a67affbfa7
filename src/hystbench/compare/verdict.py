"""The verdict in a few sentences, for the report's first page and the terminal.

The words are in ``sentences.txt.j2`` and ``first.txt.j2``; every number comes from the
summary.
"""

from collections.abc import Iterable, Mapping
from typing import Any

from hystbench.compare.claims import CLAIMS
from hystbench.compare.claims.claim import Judgement
from hystbench.compare.tables import PrintedTable, grid
from hystbench.templates import paragraphs

#: An RMS displacement is told where it is off by more (%).
NEAR_RMS = 3.0

HEADERS = ("", "runs", "within a factor of 2", "median |log10(ours/paper)|", "diverged")
HALVES = (
    "Held out are signals whose errors no fit has read; calibrated are those to which "
    "the twin and the step sizes are fitted."
)


def _percent(fraction: float | None) -> str:
    return "none" if fraction is None else f"{100 * fraction:.0f} %"


def _filled(template: str, summary: Mapping[str, Any]) -> list[str]:
    """Fill a template with the summary."""
    short = {each.id: each.shortly or each.id for each in CLAIMS}
    given = {"held_out": None, "calibrated": None, "whole": summary, **summary}
    return paragraphs(__package__, template, short=short, near_rms=NEAR_RMS, **given)


def sentences(summary: Mapping[str, Any]) -> list[str]:
    """Give the verdict in words: first what no fit has read, apart from the rest."""
    return _filled("sentences.txt.j2", summary)


def first_result(summary: Mapping[str, Any]) -> str:
    """Write the README's table of what was found as Markdown, failures among it."""
    lines = [line.split(" | ") for line in _filled("first.txt.j2", summary)]
    return grid(lines, ("of the paper", "found"), "pipe") + "\n"


def rows(summary: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """List the lines of the small table, held-out and calibrated cells apart."""
    found = []
    for key, name in (("held_out", "held out"), ("calibrated", "calibrated")):
        if part := summary.get(key):
            found.append(_row(f"{name}: all filters", part))
            for model, own in part["per_model"].items():
                found.append(_row(f"{name}: {model}", own))
    if not found:
        found = [_row("four filters", summary)]
        found += [_row(model, own) for model, own in summary["per_model"].items()]
    return [*found, _row("rdgpi, our guess of the model", summary["rdgpi"])]


def _row(name: str, part: Mapping[str, Any]) -> tuple[str, ...]:
    median = part["median_abs_log10_ratio"]
    if isinstance(median, Mapping):
        median = part["median_abs_log10_ratio_all"]
    return (
        name,
        f"{part['cells']} of {part['cells_published']}",
        _percent(part["within_factor_2"]),
        "none" if median is None else f"{median:.3f}",
        str(part["diverged"]),
    )


def verdict_page(summary: Mapping[str, Any], style: str) -> str:
    """Write sentences and small table, in a style of tabulate: ``rst`` or ``pipe``."""
    *said, last = sentences(summary)
    listed = "\n".join(f"- {sentence}" for sentence in said)
    # A bar has a meaning of its own in markups.
    headers = [header.replace("|", r"\|") for header in HEADERS]
    return (
        "\n\n".join((listed, last, grid(rows(summary), headers, style), HALVES)) + "\n"
    )


def print_tables(
    tables: Iterable[PrintedTable],
    judgements: Iterable[Judgement],
    summary: Mapping[str, Any],
) -> str:
    """Write ours beside theirs and the claims for a terminal."""
    parts = ["\n".join(filter(None, table.text("simple"))) for table in tables]
    ledger = grid(
        [(j.verdict, j.claim.id, j.published_bears_out) for j in judgements],
        ("verdict", "claim", "paper's own tables bear it out"),
        "simple",
    )
    numbers = grid(rows(summary), HEADERS, "simple")
    return "\n\n".join((*parts, ledger, numbers, "\n".join(sentences(summary)))) + "\n"

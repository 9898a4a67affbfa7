"""The score of a solver: what summary.json holds, beside what was asked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hystbench.challenge.contest.score import Row
from hystbench.challenge.contest.tables import (
    brier,
    coverage,
    middle,
    reliability,
    shares,
)
from hystbench.challenge.contest.wilson import Share, share

FAMILIES = {
    "gpi": ("gpi",),
    "foreign": ("preisach", "jiles-atherton"),
    "preisach": ("preisach",),
    "jiles-atherton": ("jiles-atherton",),
}
CONFIDENT = 0.8


@dataclass(frozen=True)
class Asked:
    """A figure that was asked for, and what was reached."""

    figure: str
    asked: str
    reached: float | None
    low: float | None
    high: float | None
    cases: int
    met: bool | None
    """By the point estimate; None where there are no cases."""


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Sum up what a solver reached on one set.

    Parameters
    ----------
    rows : sequence of Row
        Of one solver.

    Returns
    -------
    dict
        Shares are mappings of share, low, high (95 % Wilson) and cases.
    """
    singles = [row for row in rows if row.kind == "single"]
    hidden = [row for row in rows if row.kind in ("single", "pair", "triple")]
    none, unlisted = _of(rows, "none"), _of(rows, "unlisted")
    several = [row for row in rows if row.kind in ("pair", "triple")]
    return {
        "cases": len(rows),
        "lost": sum(bool(row.lost) for row in rows),
        "where_hit": {
            **_by_ratio(singles, "where_hit"),
            "several": shares(several, "where_hit").to_mapping(),
            "unlisted": shares(unlisted, "where_hit").to_mapping(),
        },
        "top1": _by_ratio(singles, "top1"),
        "top1_strict": _by_ratio(singles, "top1_strict"),
        "in_set": _by_ratio(singles, "in_set"),
        "in_set_raw": _by_ratio(singles, "in_set_raw"),
        "set_size": _mean(singles, "set_size"),
        "set_size_raw": _mean(singles, "set_size_raw"),
        "exact_set": _by_ratio(singles, "exact"),
        "exact_set_strict": _by_ratio(singles, "exact_strict"),
        "false_alarm": shares(none, "false_alarm").to_mapping(),
        "false_alarm_by_family": _by_family(none, "false_alarm"),
        "false_alarm_strict": shares(none, "false_alarm_strict").to_mapping(),
        "pairs_both": shares(_of(rows, "pair"), "all_named").to_mapping(),
        "pairs_exact": shares(_of(rows, "pair"), "exact").to_mapping(),
        "triples_all": shares(_of(rows, "triple"), "all_named").to_mapping(),
        "triples_exact": shares(_of(rows, "triple"), "exact").to_mapping(),
        "unlisted_unnamed": shares(unlisted, "unnamed").to_mapping(),
        "unlisted_confident": _confident(unlisted).to_mapping(),
        "shrink_median": middle(hidden, lambda row: row.shrink),
        "brier": brier(rows),
        "calibration_error": calibration_error(rows),
        "parameter_error_median": middle(hidden, lambda row: row.parameter_error),
        "coverage": coverage(hidden).to_mapping(),
        "without_interval": sum(row.parameters - row.intervals for row in hidden),
        "seconds_per_case": middle(rows, lambda row: row.cpu_seconds),
        "clock_seconds_per_case": middle(rows, lambda row: row.seconds),
    }


def reach(rows: Sequence[Row], transfer: Sequence[Row]) -> list[Asked]:
    """Hold a solver's score against what the project asks of its own.

    Parameters
    ----------
    rows, transfer : sequence of Row
        Of the published set and of the transfer set; the second may be empty.
    """
    singles = _of(rows, "single")
    gpi_20, gpi_10 = (_group(singles, "gpi", ratio) for ratio in (20.0, 10.0))
    foreign_20, foreign_10 = (_group(singles, "foreign", r) for r in (20.0, 10.0))
    at_20 = [row for row in singles if row.ratio_db == 20.0]
    unlisted = _of(rows, "unlisted")
    hidden = [row for row in rows if row.kind in ("single", "pair", "triple")]
    found = [
        _least("top1 GPI 20 dB", shares(gpi_20, "top1"), 0.97),
        _least("top1 foreign 20 dB", shares(foreign_20, "top1"), 0.95),
        _least("in_set 20 dB", shares(at_20, "in_set"), 0.99),
        _least("top1 GPI 10 dB", shares(gpi_10, "top1"), 0.92),
        _least("top1 foreign 10 dB", shares(foreign_10, "top1"), 0.80),
        _least("exact_set GPI 20 dB", shares(gpi_20, "exact"), 0.92),
        _least("exact_set foreign 20 dB", shares(foreign_20, "exact"), 0.88),
        _most("false_alarm", shares(_of(rows, "none"), "false_alarm"), 0.01),
        _least("pairs_both", shares(_of(rows, "pair"), "all_named"), 0.88),
        _least("triples_all", shares(_of(rows, "triple"), "all_named"), 0.70),
        _least("unlisted_unnamed", shares(unlisted, "unnamed"), 0.90),
        _most("unlisted_confident", _confident(unlisted), 0.03),
        _least("where_hit 20 dB", shares(at_20, "where_hit"), 0.90),
        _number("shrink_median", middle(hidden, lambda r: r.shrink), hidden, 0.95),
        _calibrated(rows),
        _covering(coverage(hidden)),
        _quick(rows),
    ]
    if transfer:
        found.append(_transferred(rows, transfer))
    return found


def further(rows: Sequence[Row]) -> list[tuple[str, Any, Any, Any, int]]:
    """Give what else there is to say of a score: strict figures, sizes, errors.

    Parameters
    ----------
    rows : sequence of Row
        Of one solver on one set.

    Returns
    -------
    list of (str, float or None, float or None, float or None, int)
        A figure, what was reached, its interval where it is a share, and the cases.
    """
    singles = _of(rows, "single")
    at_20 = [row for row in singles if row.ratio_db == 20.0]
    hidden = [row for row in rows if row.kind in ("single", "pair", "triple")]
    foreign = _group(singles, "foreign", 20.0)
    told = [row for row in hidden if row.parameter_error is not None]
    several = [row for row in rows if row.kind in ("pair", "triple")]
    found: list[tuple[str, Share]] = [
        *(
            (f"in_set {family} 20 dB", shares(_group(singles, family, 20.0), "in_set"))
            for family in ("gpi", "preisach", "jiles-atherton")
        ),
        ("top1_strict foreign 20 dB", shares(foreign, "top1_strict")),
        ("exact_set_strict foreign 20 dB", shares(foreign, "exact_strict")),
        (
            "false_alarm_strict foreign",
            shares(
                [r for r in _of(rows, "none") if r.family in FAMILIES["foreign"]],
                "false_alarm_strict",
            ),
        ),
        ("pairs_exact", shares(_of(rows, "pair"), "exact")),
        ("triples_exact", shares(_of(rows, "triple"), "exact")),
        ("where_hit of several effects", shares(several, "where_hit")),
        ("where_hit of unlisted effects", shares(_of(rows, "unlisted"), "where_hit")),
    ]
    error = middle(told, lambda row: row.parameter_error)
    numbers = [
        ("set_size at 20 dB, mean", _mean(at_20, "set_size"), len(at_20)),
        ("set_size_raw at 20 dB, mean", _mean(at_20, "set_size_raw"), len(at_20)),
        ("brier", brier(rows), len(rows)),
        ("relative error of parameters, median", error, len(told)),
    ]
    return [
        *((name, *reached) for name, reached in found),
        *((name, value, None, None, cases) for name, value, cases in numbers),
    ]


def calibration_error(rows: Sequence[Row]) -> float | None:
    """Mean distance of stated confidence from what happened, over the effects named."""
    bins = reliability(rows)
    named = sum(item[-1] for item in bins)
    if not named:
        return None
    return float(sum(abs(item[2] - item[3]) * item[-1] for item in bins) / named)


def _of(rows: Sequence[Row], kind: str) -> list[Row]:
    return [row for row in rows if row.kind == kind]


def _group(rows: Sequence[Row], family: str, ratio_db: float) -> list[Row]:
    among = FAMILIES[family]
    return [row for row in rows if row.family in among and row.ratio_db == ratio_db]


def _by_ratio(rows: Sequence[Row], figure: str) -> dict[str, Any]:
    """Give a figure by ratio and, in it, by family."""
    ratios = sorted({row.ratio_db for row in rows if row.ratio_db is not None})
    return {
        f"{ratio:g}": _by_family([r for r in rows if r.ratio_db == ratio], figure)
        for ratio in ratios
    }


def _by_family(rows: Sequence[Row], figure: str) -> dict[str, Any]:
    groups = {
        family: [row for row in rows if row.family in among]
        for family, among in FAMILIES.items()
    }
    return {
        family: shares(group, figure).to_mapping()
        for family, group in groups.items()
        if group
    }


def _mean(rows: Sequence[Row], figure: str) -> float | None:
    values = [value for row in rows if (value := getattr(row, figure)) is not None]
    return sum(values) / len(values) if values else None


def _confident(rows: Sequence[Row]) -> Share:
    """Share of cases in which some effect is named with confidence above 0.8."""

    def highest(row: Row) -> float:
        told = [float(word.rpartition("=")[2]) for word in row.confidences.split()]
        return max(told, default=0.0)

    return share([highest(row) > CONFIDENT for row in rows])


def _least(figure: str, reached: Share, asked: float) -> Asked:
    met = None if reached.share is None else reached.share >= asked
    return Asked(figure, f">= {asked:g}", *reached, met)


def _most(figure: str, reached: Share, asked: float) -> Asked:
    met = None if reached.share is None else reached.share <= asked
    return Asked(figure, f"<= {asked:g}", *reached, met)


def _number(
    figure: str, value: float | None, rows: Sequence[Row], asked: float
) -> Asked:
    met = None if value is None else value >= asked
    return Asked(figure, f">= {asked:g}", value, None, None, len(rows), met)


def _calibrated(rows: Sequence[Row]) -> Asked:
    error = calibration_error(rows)
    met = None if error is None else error <= 0.05
    name = "stated confidence off by"
    return Asked(name, "<= 0.05", error, None, None, len(rows), met)


def _covering(reached: Share) -> Asked:
    met = None if reached.share is None else 0.90 <= reached.share <= 0.98
    return Asked("coverage of 95 % intervals", "0.9 to 0.98", *reached, met)


def _quick(rows: Sequence[Row]) -> Asked:
    seconds = middle(rows, lambda row: row.cpu_seconds)
    met = None if seconds is None else seconds <= 1.0
    return Asked("seconds_per_case", "<= 1", seconds, None, None, len(rows), met)


def _transferred(rows: Sequence[Row], transfer: Sequence[Row]) -> Asked:
    """Hold top-1 at 20 dB on the transfer set against the published set's."""
    here, there = (
        shares([r for r in each if r.kind == "single" and r.ratio_db == 20.0], "top1")
        for each in (rows, transfer)
    )
    if here.share is None or there.share is None:
        return Asked("transfer top1 20 dB", "", None, None, None, there.cases, None)
    least = here.share - 0.05
    return Asked("transfer top1 20 dB", f">= {least:.3f}", *there, there.share >= least)

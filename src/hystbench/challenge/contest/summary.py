"""The score of a solver: what summary.json holds, beside what was asked.

All take a data frame of :func:`hystbench.challenge.contest.frames.frame`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from hystbench.challenge.contest import table
from hystbench.challenge.contest.tables import (
    brier,
    calibration_error,
    coverage,
    mean,
    middle,
    shares,
)
from hystbench.challenge.contest.wilson import Share
from hystbench.challenge.plant.inside import MACHINES

FAMILIES = {
    "gpi": ("gpi",),
    "foreign": ("preisach", "jiles-atherton"),
    "preisach": ("preisach",),
    "jiles-atherton": ("jiles-atherton",),
    "machines": MACHINES,
}
HIDDEN = ("single", "pair", "triple")
SEVERAL = ("pair", "triple")


@dataclass(frozen=True)
class Figure:
    """A share of some cases, and what the project asks of its own solver.

    Parameters
    ----------
    name : str
    column : str
        The figure of a case, true or false.
    kind, family : str
        ``all``, or a kind of case and one of :data:`FAMILIES`.
    ratio_db : float or None
        None for all.
    sense, bound
        What is asked: ``>=`` or ``<=``, and of what.
    """

    name: str
    column: str
    kind: str
    family: str = "all"
    ratio_db: float | None = None
    sense: str = ""
    bound: float = 0.0

    @property
    def asked(self) -> str:
        """What is asked, in words; empty where nothing is."""
        return f"{self.sense} {self.bound:g}" if self.sense else ""

    def share(self, cases: pd.DataFrame) -> Share:
        """Compute the share over the cases that it is about."""
        chosen = pd.Series(data=True, index=cases.index)
        if self.kind != "all":
            chosen &= cases["kind"] == self.kind
        if self.family != "all":
            chosen &= cases["family"].isin(FAMILIES[self.family])
        if self.ratio_db is not None:
            chosen &= (cases["ratio_db"] == self.ratio_db).fillna(False)
        return shares(cases[chosen], self.column)


def figures(name: str) -> list[Figure]:
    """Give the figures of a table of ``contest.yaml``."""
    return [Figure(*row) for row in table(name)]


TOP1_20 = Figure("transfer top1 20 dB", "top1", "single", "all", 20.0)


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


def summary(cases: pd.DataFrame) -> dict[str, Any]:
    """Sum up what a solver reached on one set.

    Parameters
    ----------
    cases : DataFrame
        Of one solver.

    Returns
    -------
    dict
        Shares are mappings of share, low, high (95 % Wilson) and cases.
    """
    hidden = of(cases, HIDDEN)
    return {
        "cases": len(cases),
        "lost": int((cases["lost"] != "").sum()),
        "where_hit": {
            **_by_ratio(of(cases, ("single",)), "where_hit"),
            "several": _share(of(cases, SEVERAL), "where_hit"),
            "unlisted": _share(of(cases, ("unlisted",)), "where_hit"),
        },
        **{
            name: _SUMS[how["by"]](of(cases, how["of"]), how["figure"])
            for name, how in table("summary").items()
        },
        "brier": brier(cases),
        "calibration_error": calibration_error(cases),
        "parameter_error_median": middle(hidden, "parameter_error"),
        "coverage": coverage(hidden)._asdict(),
        "without_interval": int((hidden["parameters"] - hidden["intervals"]).sum()),
        "seconds_per_case": middle(cases, "cpu_seconds"),
        "clock_seconds_per_case": middle(cases, "seconds"),
    }


def reach(cases: pd.DataFrame, transfer: pd.DataFrame) -> list[Asked]:
    """Hold a solver's score against what the project asks of its own.

    Parameters
    ----------
    cases, transfer : DataFrame
        Of the published set and of the transfer set; the second may be empty.
    """
    hidden = of(cases, HIDDEN)
    covered = coverage(hidden)
    met = None if covered.share is None else 0.90 <= covered.share <= 0.98
    shrink, seconds = middle(hidden, "shrink"), middle(cases, "cpu_seconds")
    apart = calibration_error(cases)
    found = [
        *(_asked(f.name, f.sense, f.bound, f.share(cases)) for f in figures("asked")),
        _asked("shrink_median", ">=", 0.95, _number(shrink, hidden)),
        _asked("stated confidence off by", "<=", 0.05, _number(apart, cases)),
        Asked("coverage of 95 % intervals", "0.9 to 0.98", *covered, met),
        _asked("seconds_per_case", "<=", 1.0, _number(seconds, cases)),
    ]
    if len(transfer):
        found.append(_transferred(TOP1_20.share(cases), TOP1_20.share(transfer)))
    return found


def further(cases: pd.DataFrame) -> list[tuple[str, Any, Any, Any, int]]:
    """Give what else there is to say of a score: strict figures, sizes, errors.

    Parameters
    ----------
    cases : DataFrame
        Of one solver on one set.

    Returns
    -------
    list of (str, float or None, float or None, float or None, int)
        A figure, what was reached, its interval where it is a share, and the cases.
    """
    singles = of(cases, ("single",))
    at_20 = singles[(singles["ratio_db"] == 20.0).fillna(False)]
    known = of(cases, HIDDEN).dropna(subset="parameter_error")
    several = shares(of(cases, SEVERAL), "where_hit")
    unlisted = shares(of(cases, ("unlisted",)), "where_hit")
    error = middle(known, "parameter_error")
    numbers = [
        ("set_size at 20 dB, mean", mean(at_20, "set_size"), at_20),
        ("set_size_raw at 20 dB, mean", mean(at_20, "set_size_raw"), at_20),
        ("brier", brier(cases), cases),
        ("relative error of parameters, median", error, known),
    ]
    return [
        *((figure.name, *figure.share(cases)) for figure in figures("further")),
        ("where_hit of several effects", *several),
        ("where_hit of unlisted effects", *unlisted),
        *((name, *_number(value, among)) for name, value, among in numbers),
    ]


def of(cases: pd.DataFrame, kinds: Sequence[str]) -> pd.DataFrame:
    """Give the cases of some kinds."""
    return cases[cases["kind"].isin(kinds)]


def _by_ratio(cases: pd.DataFrame, figure: str) -> dict[str, Any]:
    """Give a figure by ratio and, in it, by family."""
    return {
        f"{ratio:g}": _by_family(same, figure)
        for ratio, same in cases.groupby("ratio_db")
    }


def _by_family(cases: pd.DataFrame, figure: str) -> dict[str, Any]:
    groups = {name: cases[cases["family"].isin(f)] for name, f in FAMILIES.items()}
    return {name: _share(group, figure) for name, group in groups.items() if len(group)}


def _share(cases: pd.DataFrame, figure: str) -> dict[str, Any]:
    return shares(cases, figure)._asdict()


#: How a row of the table ``summary`` is summed up.
_SUMS: dict[str, Callable[[pd.DataFrame, str], Any]] = {
    "ratio": _by_ratio,
    "family": _by_family,
    "share": _share,
    "mean": mean,
    "median": middle,
}


def _number(value: float | None, cases: pd.DataFrame) -> Share:
    """Give a number that is no share, and has no interval."""
    return Share(value, None, None, len(cases))


def _asked(name: str, sense: str, bound: float, reached: Share) -> Asked:
    value = reached.share
    met = None
    if value is not None:
        met = value >= bound if sense == ">=" else value <= bound
    return Asked(name, f"{sense} {bound:g}", *reached, met)


def _transferred(here: Share, there: Share) -> Asked:
    """Hold top-1 at 20 dB on the transfer set against the published set's."""
    name = TOP1_20.name
    if here.share is None or there.share is None:
        return Asked(name, "", None, None, None, there.cases, None)
    least = here.share - 0.05
    return Asked(name, f">= {least:.3f}", *there, there.share >= least)

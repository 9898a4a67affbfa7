"""The score of a solver: what summary.json holds, beside what was asked.

All take a data frame of :func:`hystbench.challenge.contest.frames.frame`.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import pandas as pd

from hystbench.challenge.contest import table
from hystbench.challenge.contest.tables import (
    Share,
    average,
    brier,
    calibration_error,
    coverage,
    shares,
)
from hystbench.challenge.plant.inside import MACHINES

#: Families of plants by one word.
FAMILIES = {
    "gpi": ("gpi",),
    "foreign": ("preisach", "jiles-atherton", "duhem"),
    "preisach": ("preisach",),
    "jiles-atherton": ("jiles-atherton",),
    "machines": MACHINES,
}
#: Kinds of cases that hide what can be named.
HIDDEN = ("single", "pair", "triple")
KINDS = {"hidden": HIDDEN, "several": ("pair", "triple")}
"""Kinds of cases by one word; every other word is a kind."""


class Figure(NamedTuple):
    """A figure of some cases, and what the project asks of its own solver."""

    name: str
    column: str
    """The share of cases of which this is true; or, before the name of a column, what
    is made of it, as :data:`STATISTICS` has it."""
    kind: str = "all"
    family: str = "all"
    """``all``, or a kind of case (or of :data:`KINDS`) and one of :data:`FAMILIES`."""
    ratio_db: float | None = None
    """None for all."""
    sense: str = ""
    bound: Any = 0.0
    """What is asked: ``>=`` or ``<=``, and of what; or ``to`` between two ends."""

    @property
    def asked(self) -> str:
        """What is asked, in words; empty where nothing is."""
        if self.sense == "to":
            return "{:g} to {:g}".format(*self.bound)
        return f"{self.sense} {self.bound:g}" if self.sense else ""

    def met(self, value: float | None) -> bool | None:
        """Tell whether a value is what is asked; None where there is none."""
        if value is None:
            return None
        if self.sense == "to":
            return bool(self.bound[0] <= value <= self.bound[1])
        return bool(value >= self.bound if self.sense == ">=" else value <= self.bound)

    def of(self, cases: pd.DataFrame) -> Share:
        """Compute it over the cases that it is about; a number has no interval."""
        if self.kind != "all":
            cases = of(cases, KINDS.get(self.kind, (self.kind,)))
        if self.family != "all":
            cases = cases[cases["family"].isin(FAMILIES[self.family])]
        if self.ratio_db is not None:
            cases = cases[(cases["ratio_db"] == self.ratio_db).fillna(False)]
        if self.column == "coverage":
            return coverage(cases)
        made, _, column = self.column.rpartition(" ")
        if not made:
            return shares(cases, column)
        if made == "known median":
            made, cases = "median", cases.dropna(subset=column)
        return Share(STATISTICS[made](cases, column), None, None, len(cases))


STATISTICS: dict[str, Callable[[pd.DataFrame, str], Any]] = {
    "mean": partial(average, how="mean"),
    "median": average,
    "distance": lambda cases, _: calibration_error(cases),
    "square": lambda cases, _: brier(cases),
}
"""What is made of a column: of stated confidence, how far it is from what happened.

``known median`` counts those cases alone of which the column is known.
"""


def figures(name: str) -> list[Figure]:
    """Give the figures of a table of ``contest.yaml``."""
    return [Figure(*row) for row in table(name)]


TOP1_20 = Figure("transfer top1 20 dB", "top1", "single", "all", 20.0, ">=")


class AskedFigure(NamedTuple):
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
            "several": _share(of(cases, KINDS["several"]), "where_hit"),
            "unlisted": _share(of(cases, ("unlisted",)), "where_hit"),
        },
        **{
            name: _SUMS[how["by"]](of(cases, how["of"]), how["figure"])
            for name, how in table("summary").items()
        },
        "brier": brier(cases),
        "calibration_error": calibration_error(cases),
        "parameter_error_median": average(hidden, "parameter_error"),
        "coverage": coverage(hidden)._asdict(),
        "without_interval": int((hidden["parameters"] - hidden["intervals"]).sum()),
        "seconds_per_case": average(cases, "cpu_seconds"),
        "clock_seconds_per_case": average(cases, "seconds"),
    }


def reach(cases: pd.DataFrame) -> list[AskedFigure]:
    """Hold a solver's score on a set against what the project asks of its own."""
    return [_asked(figure, figure.of(cases)) for figure in figures("asked")]


def carried_over(cases: pd.DataFrame, transfer: pd.DataFrame) -> AskedFigure:
    """Hold the score on the transfer set against that on the published set."""
    here, there = TOP1_20.of(cases).share, TOP1_20.of(transfer)
    if here is None or there.share is None:
        return AskedFigure(TOP1_20.name, "", None, None, None, there.cases, None)
    asked = TOP1_20._replace(bound=here - 0.05)
    return _asked(asked, there)._replace(asked=f">= {asked.bound:.3f}")


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
    **STATISTICS,
}


def _asked(figure: Figure, reached: Share) -> AskedFigure:
    return AskedFigure(figure.name, figure.asked, *reached, figure.met(reached.share))

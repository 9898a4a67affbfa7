"""What a solver says of what it cannot name, or has never seen: blind by kind.

Cases are frames as :func:`hystbench.challenge.contest.tables.frame` gives them. A free
shape of the hysteresis beside a plant of another family than the base's is no name.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from hystbench.challenge.contest.tables import (
    how_often,
    names_that_count,
    sure,
    wilson,
)
from hystbench.challenge.spec import LEFT_OUT_GROUP, NAMELESS, group_of

COLUMNS = ("left_out", "cases", "no_name", "low", "high", "confident", "called")
"""Columns of the table of what is left out."""
ALL_NAMES = "all"
"""The last row of each sort."""


def left_out(cases: pd.DataFrame) -> pd.DataFrame:
    """Sum up cases whose hidden effect the solver had to do without.

    Parameters
    ----------
    cases : DataFrame
        Judged cases of one solver with one hidden effect each.

    Returns
    -------
    DataFrame
        A row an effect, in alphabetical order, then all: the share of cases in which
        no name is given, with its 95 % interval, the share in which one is given with
        more than .8, and what was named how often.
    """
    nameless = cases.assign(truth="")
    found = list(_rows(nameless, cases["truth"]))
    return pd.DataFrame(found, columns=list(COLUMNS)).round(4)


def never_seen(
    cases: pd.DataFrame, group: int = LEFT_OUT_GROUP
) -> Iterator[tuple[Any, ...]]:
    """Sum up cases of one hidden effect, or none, by what all other sets leave out.

    Parameters
    ----------
    cases : DataFrame
        Judged cases of one solver on the transfer set.
    group : int
        The group that all other sets left out.

    Yields
    ------
    tuple
        ``sort, name, cases, right, low, high, confidently_wrong, called``: a form of a
        listed effect, a family of plants or an unlisted effect; in how many cases just
        what is hidden is named, or nothing where nothing listed is, with the 95 %
        interval; in what share a wrong name is stated with more than .8; and which
        wrong names were given how often.
    """
    held = group_of(group)
    single = cases[cases["kind"] == "single"]
    forms = single["truth"] + ": " + single["form"]
    ours = cases["family"].isin(held.families)
    plain = cases[cases["kind"].isin(("single", "none")) & ours]
    unlisted = cases[cases["kind"] == "unlisted"]
    for sort, chosen, names in (
        ("form", single[forms.isin(held.forms)], forms),
        ("family", plain, plain["family"]),
        ("unlisted", unlisted, unlisted["truth"]),
    ):
        for row in _rows(chosen, names):
            yield sort, *row


def _rows(cases: pd.DataFrame, names: pd.Series[Any]) -> Iterator[tuple[Any, ...]]:
    """Give ``name, cases, right, low, high, confidently_wrong, called`` by name."""
    groups = [*cases.groupby(names), (ALL_NAMES, cases)] if len(cases) else []
    for name, group in groups:
        said = names_that_count(group)
        hidden = [set(truth.split()) - set(NAMELESS) for truth in group["truth"]]
        both = list(zip(said, hidden, strict=True))
        # a lost case names nothing, but is no answer
        told = zip(both, group["lost"], strict=True)
        right = wilson(
            sum(set(given) == there and not lost for (given, there), lost in told),
            len(both),
        )
        wrong = [
            {x: confidence for x, confidence in given.items() if x not in there}
            for given, there in both
        ]
        interval = (right.share, right.low, right.high)
        surely = sum(map(sure, wrong)) / len(wrong)
        yield str(name), len(both), *interval, surely, how_often(wrong)

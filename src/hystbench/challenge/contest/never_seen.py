"""What a solver says of what no set but the transfer set holds: blind by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import pandas as pd

from hystbench.challenge.contest.frames import CONFIDENT
from hystbench.challenge.contest.score import SHAPE
from hystbench.challenge.contest.tables import wilson
from hystbench.challenge.plant.effects import IN_ACTUATOR, UNLISTED
from hystbench.challenge.plant.hysteresis import KEPT

EVERY = "all"
"""The last row of each sort."""
FORMS = tuple(
    f"{name}: {form}"
    for name, kind in IN_ACTUATOR.items()
    for form, law in kind.forms.items()
    if law.use == "transfer"
)
"""Forms of listed effects that no set but the transfer set holds."""


def never_seen(cases: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    """Sum up cases of one hidden effect, or none, by what was kept from all other sets.

    Parameters
    ----------
    cases : DataFrame
        Judged cases of one solver on the transfer set, as ``frames.frame`` has them.

    Yields
    ------
    tuple
        ``sort, name, cases, right, low, high, confidently_wrong, called``: a form of a
        listed effect, a family of plants or an unlisted effect; in how many cases just
        what is hidden is named, or nothing where nothing listed is, with the 95 %
        interval; in what share a wrong name is stated with more than .8; and which
        wrong names were given how often. A free shape of the hysteresis beside a plant
        of another family than the base's is no name.
    """
    single = cases[cases["kind"] == "single"]
    forms = single["truth"] + ": " + single["form"]
    yield from _rows("form", single[forms.isin(FORMS)], forms)
    plain = cases[cases["kind"].isin(("single", "none")) & cases["family"].isin(KEPT)]
    yield from _rows("family", plain, plain["family"])
    unlisted = cases[cases["kind"] == "unlisted"]
    yield from _rows("unlisted", unlisted, unlisted["truth"])


def _rows(
    sort: str, cases: pd.DataFrame, names: pd.Series[Any]
) -> Iterator[tuple[Any, ...]]:
    groups = [*cases.groupby(names), (EVERY, cases)] if len(cases) else []
    for name, group in groups:
        wrong = [_wrong(case) for _, case in group.iterrows()]
        right = [_right(case) for _, case in group.iterrows()]
        share = wilson(sum(right), len(right))
        sure = sum(any(x > CONFIDENT for x in names.values()) for names in wrong)
        counts = Counter(called for names in wrong for called in names)
        called = ", ".join(f"{word} {count}" for word, count in counts.most_common())
        interval = (share.share, share.low, share.high)
        yield (sort, str(name), len(group), *interval, sure / len(group), called)


def _named(case: pd.Series[Any]) -> dict[str, float]:
    """Names that count, with the confidence of each."""
    free = case["family"] != "gpi"
    return {x: sure for x, sure in case["given"].items() if not free or x != SHAPE}


def _hidden(case: pd.Series[Any]) -> set[str]:
    """Listed effects that are hidden."""
    return set(case["truth"].split()) - set(UNLISTED)


def _wrong(case: pd.Series[Any]) -> dict[str, float]:
    hidden = _hidden(case)
    return {name: sure for name, sure in _named(case).items() if name not in hidden}


def _right(case: pd.Series[Any]) -> bool:
    return set(_named(case)) == _hidden(case)

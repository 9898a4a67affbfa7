"""What a solver says of an effect that it may not name: blind by kind."""

from __future__ import annotations

from collections import Counter

import pandas as pd

from hystbench.challenge.contest.frames import CONFIDENT
from hystbench.challenge.contest.score import SHAPE, given
from hystbench.challenge.contest.wilson import wilson

COLUMNS = ("left_out", "cases", "no_name", "low", "high", "confident", "called")
EVERY = "all"
"""The last row is of all effects together."""


def left_out(cases: pd.DataFrame) -> pd.DataFrame:
    """Sum up cases whose hidden effect the solver had to do without.

    Parameters
    ----------
    cases : DataFrame
        Judged cases of one solver with one hidden effect each, as ``frames.frame`` has
        them.

    Returns
    -------
    DataFrame
        A row an effect, in alphabetical order, then all: the share of cases in which
        no name is given, with its 95 % interval, the share in which one is given with
        more than :data:`CONFIDENT`, and what was named how often. A free shape of the
        hysteresis beside a plant of another family than the base's is no name.
    """
    said = cases.assign(said=cases.apply(_names, axis=1))
    groups = [*said.groupby("truth"), (EVERY, said)]
    found = [_row(str(name), list(group["said"])) for name, group in groups]
    return pd.DataFrame(found, columns=list(COLUMNS)).round(4)


def _names(row: pd.Series) -> dict[str, float]:
    """Give the names of an answer with what they are stated with."""
    names = given(row["verdict"], row["confidences"])
    free = row["family"] != "gpi"
    return {name: sure for name, sure in names.items() if not (free and name == SHAPE)}


def _row(name: str, said: list[dict[str, float]]) -> tuple[object, ...]:
    silent = wilson(sum(not names for names in said), len(said))
    sure = sum(any(x > CONFIDENT for x in names.values()) for names in said)
    counts = Counter(called for names in said for called in names)
    called = ", ".join(f"{word} {count}" for word, count in counts.most_common())
    share = (silent.share, silent.low, silent.high)
    return (name, len(said), *share, sure / len(said), called)

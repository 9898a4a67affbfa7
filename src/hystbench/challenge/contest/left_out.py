"""What a solver says of an effect that it may not name: blind by kind."""

import pandas as pd

from hystbench.challenge.contest.frames import sure
from hystbench.challenge.contest.tables import how_often, names_that_count, wilson

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
        more than .8, and what was named how often. A free shape of the
        hysteresis beside a plant of another family than the base's is no name.
    """
    kept = pd.Series(names_that_count(cases), index=cases.index, dtype=object)
    said = cases.assign(said=kept)
    groups = [*said.groupby("truth"), (EVERY, said)]
    found = [_row(str(name), list(group["said"])) for name, group in groups]
    return pd.DataFrame(found, columns=list(COLUMNS)).round(4)


def _row(name: str, said: list[dict[str, float]]) -> tuple[object, ...]:
    silent = wilson(sum(not names for names in said), len(said))
    share = (silent.share, silent.low, silent.high)
    return (name, len(said), *share, sum(map(sure, said)) / len(said), how_often(said))

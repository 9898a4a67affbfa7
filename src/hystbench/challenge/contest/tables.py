"""Judged cases as a data frame, and what many say together: tables, a row a group.

All tables take a data frame of :func:`frame`.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from hystbench.challenge.contest import table
from hystbench.challenge.contest.score import COLUMNS, FREE_SHAPE, Row
from hystbench.compare.rows import read_items
from hystbench.files import write_csv

#: An effect that is stated with a higher confidence is called confident.
CONFIDENT_ABOVE = 0.8
#: Types of columns; but for text, cells may be missing.
COLUMN_TYPES = {"str": "str", "bool": "boolean", "int": "Int64", "float": "Float64"}
#: With which an interval holds the true share.
CONFIDENCE = 0.95
#: Edges of the bins of stated confidence.
CONFIDENCE_EDGES = (0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)
#: First answers that are no effect.
NO_EFFECT = ("no-gap", "unnamed", "parameters", "lost")
#: Of two effects that no experiment in ``contest.yaml`` is about.
NO_EXPERIMENT = "none written down"
#: Kinds of cases in which at most one effect is hidden, in the order they are told.
AT_MOST_ONE = ("single", "unlisted", "none")


def read_rows(paths: Sequence[Path]) -> pd.DataFrame:
    """Read judged cases as :func:`frame` has them.

    Raises
    ------
    InputError
        If a file lacks a column, or a number in it is none.
    """
    return frame(row for path in paths for row in read_items(path, Row))


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Give judged cases as a data frame: a row a case, a column a field of Row.

    Figures that mean nothing for a case are missing. Added are ``stated``, the effects
    named with the confidence of each; ``given``, the same where the verdict is
    ``named``, as names beside another do not count; and ``confident``, whether one is
    stated with more than :data:`CONFIDENT_ABOVE`.
    """
    told = [astuple(row) for row in rows]
    table = pd.DataFrame(told, columns=list(COLUMNS), dtype=object)
    kinds = {item.name: str(item.type).partition(" ")[0] for item in fields(Row)}
    table = table.astype({name: COLUMN_TYPES[kind] for name, kind in kinds.items()})
    table["stated"] = table["confidences"].map(_stated).astype(object)
    named = table["verdict"] == "named"
    given = [x if y else {} for x, y in zip(table["stated"], named, strict=True)]
    table["given"] = pd.Series(given, index=table.index, dtype=object)
    table["confident"] = pd.array(list(map(sure, table["stated"])), dtype="boolean")
    return table


def write_frame(path: Path, table: pd.DataFrame) -> None:
    """Write judged cases that were read, as they were written."""
    told = table[list(COLUMNS)].astype(object)
    write_csv(path, COLUMNS, told.where(told.notna(), None).itertuples(index=False))


def _stated(confidences: str) -> dict[str, float]:
    """Give the stated confidence of each name, as a row has them."""
    parts = (word.rpartition("=") for word in confidences.split())
    return {name: float(confidence) for name, _, confidence in parts}


def sure(names: Mapping[str, float]) -> bool:
    """Tell whether a name is stated with more than :data:`CONFIDENT_ABOVE`."""
    return any(confidence > CONFIDENT_ABOVE for confidence in names.values())


class Share(NamedTuple):
    """A share of cases with its interval; all None where there are no cases."""

    share: float | None
    low: float | None
    high: float | None
    cases: int


def wilson(hits: int, cases: int) -> Share:
    """Compute a share and its 95 % score interval.

    Parameters
    ----------
    hits, cases : int

    References
    ----------
    .. [1] E. B. Wilson, "Probable inference, the law of succession, and statistical
       inference", Journal of the American Statistical Association 22 (1927) 209-212.
    """
    if cases == 0:
        return Share(None, None, None, 0)
    interval = binomtest(hits, cases).proportion_ci(CONFIDENCE, method="wilson")
    return Share(hits / cases, float(interval.low), float(interval.high), cases)


def names_that_count(cases: pd.DataFrame) -> list[dict[str, float]]:
    """Give the names of each case with their confidence, without what is no name.

    That is a free shape of the hysteresis beside a plant of another family than the
    base's.
    """
    both = zip(cases["given"], cases["family"], strict=True)
    return [
        {name: x for name, x in names.items() if family == "gpi" or name != FREE_SHAPE}
        for names, family in both
    ]


def how_often(names: Iterable[Iterable[str]]) -> str:
    """Say which names were given how often, the most frequent first."""
    counts = Counter(name for given in names for name in given)
    return ", ".join(f"{name} {count}" for name, count in counts.most_common())


def confusion(cases: pd.DataFrame) -> list[tuple[Any, ...]]:
    """Count what was answered first where at most one effect is hidden.

    Returns
    -------
    list of (kind, hidden, answered, right, cases)
        ``kind`` is single, unlisted or none; ``right`` yes or no. With nothing hidden
        beside a plant of another family than the base's, the shape is right too.
    """
    counted: list[tuple[Any, ...]] = []
    for kind in AT_MOST_ONE:
        mine = cases[cases["kind"] == kind]
        first = mine.apply(_first, axis=1) if len(mine) else mine["truth"]
        right = {
            "single": first == mine["truth"],
            "unlisted": first == "unnamed",
            "none": (mine["false_alarm"] == False).fillna(False),  # noqa: E712
        }[kind]
        hidden = mine["truth"].replace("", "none")
        answers = Counter(zip(hidden, first, np.where(right, "yes", "no"), strict=True))
        counted += [(kind, *map(str, key), n) for key, n in sorted(answers.items())]
    return counted


def confused(cases: pd.DataFrame) -> list[tuple[str, str, int, int, str]]:
    """List single effects that were taken for another, the most frequent first.

    Returns
    -------
    list of (hidden, answered, cases, of, experiment)
        ``of`` is how often the effect was hidden.
    """
    hidden = cases[cases["kind"] == "single"]["truth"].value_counts()
    wrong = [
        (name, answered, count, int(hidden[name]), experiment(name, answered))
        for kind, name, answered, right, count in confusion(cases)
        if kind == "single" and right == "no" and answered not in NO_EFFECT
    ]
    return sorted(wrong, key=lambda item: -item[2])


def experiment(one: str, other: str) -> str:
    """Tell an experiment that separates two effects, for docs/confusions.md.

    Parameters
    ----------
    one, other : str
        Names of the vocabulary; of others nothing is known.
    """
    for here, there, told in table("experiments"):
        if (one in here and other in there) or (other in here and one in there):
            return str(told)
    return NO_EXPERIMENT


def _first(case: pd.Series[Any]) -> str:
    if case["lost"]:
        return "lost"
    if case["verdict"] == "unnamed":
        return "unnamed"
    names = str(case["named"]).split()
    if case["family"] != "gpi" and case["truth"] != FREE_SHAPE and len(names) > 1:
        names = [name for name in names if name != FREE_SHAPE] or [FREE_SHAPE]
    return names[0] if names else str(case["verdict"])


def by_effect(cases: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    """Give for each single effect, family and ratio the shares that matter.

    Yields
    ------
    tuple
        ``effect, family, ratio_db, figure, share, low, high, cases``.
    """
    for (effect, ratio), mine in _singles(cases).groupby(["truth", "ratio_db"]):
        for family, group in _families(mine):
            for figure in ("top1", "in_set", "exact", "where_hit"):
                yield (effect, family, ratio, figure, *shares(group, figure))


def retuned(cases: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    """Give how hard each single effect is once the base is re-tuned at its best.

    Yields
    ------
    tuple
        ``effect, ratio_db``, then the least, the median and the greatest ratio that is
        left (dB), and ``cases``.
    """
    known = _singles(cases).dropna(subset="ratio_retuned_db")
    for key, mine in known.groupby(["truth", "ratio_db"])["ratio_retuned_db"]:
        yield (*key, mine.min(), mine.median(), mine.max(), len(mine))


def power(cases: pd.DataFrame) -> Iterator[tuple[Any, ...]]:
    """Give the share of cases in which an effect was named, by the hidden ratio.

    Yields
    ------
    tuple
        ``effect, family, ratio_db, share, low, high, cases``; effect and family may
        be ``all``.
    """
    chosen = _singles(cases)
    for effect, mine in [("all", chosen), *chosen.groupby("truth")]:
        for family, group in _families(mine):
            for ratio, same in group.groupby("ratio_db"):
                yield (effect, family, ratio, *shares(same, "all_named"))


def _singles(cases: pd.DataFrame) -> pd.DataFrame:
    return cases[(cases["kind"] == "single") & cases["ratio_db"].notna()]


def _families(cases: pd.DataFrame) -> list[tuple[Any, pd.DataFrame]]:
    """All cases, then those of each family of plants."""
    return [("all", cases), *cases.groupby("family")] if len(cases) else []


def _outcomes(cases: pd.DataFrame) -> list[tuple[float, bool]]:
    """Give the stated confidence of each effect named, and whether it is hidden."""
    return [
        (confidence, name in truth.split())
        for truth, stated in zip(cases["truth"], cases["stated"], strict=True)
        for name, confidence in stated.items()
    ]


def reliability(cases: pd.DataFrame) -> list[tuple[Any, ...]]:
    """Hold stated confidence against what happened.

    Returns
    -------
    list of tuple
        ``from, to, stated, share, low, high, effects`` of each bin that holds any;
        ``stated`` is the mean.
    """
    pairs = _outcomes(cases)
    out: list[tuple[Any, ...]] = []
    for low, high in itertools.pairwise(CONFIDENCE_EDGES):
        inside = [x for x in pairs if low <= x[0] < high or (x[0] == high == 1.0)]
        if inside:
            said, right = zip(*inside, strict=True)
            out.append(
                (low, high, float(np.mean(said)), *wilson(sum(right), len(right)))
            )
    return out


def brier(cases: pd.DataFrame) -> float | None:
    """Mean square of stated confidence minus what happened (1 or 0)."""
    pairs = _outcomes(cases)
    if not pairs:
        return None
    return float(np.mean([(said - right) ** 2 for said, right in pairs]))


def calibration_error(cases: pd.DataFrame) -> float | None:
    """Mean distance of stated confidence from what happened, over the effects named."""
    bins = reliability(cases)
    named = sum(item[-1] for item in bins)
    if not named:
        return None
    return float(sum(abs(item[2] - item[3]) * item[-1] for item in bins) / named)


def shares(cases: pd.DataFrame, figure: str) -> Share:
    """Share of cases of which a figure is true; those without it are left out."""
    values = cases[figure].dropna()
    return wilson(int(values.sum()), len(values))


def average(cases: pd.DataFrame, figure: str, how: str = "median") -> float | None:
    """Median of a figure, or its mean; None where no case has it."""
    value = cases[figure].agg(how)
    return None if pd.isna(value) else float(value)


def coverage(cases: pd.DataFrame) -> Share:
    """Share of the 95 % intervals that hold the true value.

    Numbers of one case are not independent; the interval takes them so.
    """
    return wilson(int(cases["covered"].sum()), int(cases["intervals"].sum()))

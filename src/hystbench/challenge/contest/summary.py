"""The score of a solver beside what was asked, and its files for docs and figures.

All take a data frame of :func:`hystbench.challenge.contest.tables.frame`.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from hystbench.challenge.contest import table, tables
from hystbench.challenge.contest.never_seen import never_seen
from hystbench.challenge.contest.tables import (
    Share,
    average,
    brier,
    calibration_error,
    coverage,
    shares,
    write_frame,
)
from hystbench.challenge.plant.effects import MACHINES
from hystbench.challenge.spec import GROUPS
from hystbench.files import write_csv, write_json

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
#: With room for the rounding of a difference of two shares.
FIVE_POINTS = 0.05 + 1e-9
#: Columns of each table but those of cases.
TABLES: dict[str, list[str]] = table("columns")
WRITTEN = (*TABLES, "cases.csv", "transfer-cases.csv", "summary.json")
"""Files of a score."""


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
    """Whether the point estimate meets the target; None where there are no cases."""


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


def write_score(
    cases: pd.DataFrame,
    transfer: pd.DataFrame,
    solver: str,
    about: Mapping[str, Any],
    out: Path,
) -> None:
    """Write the score of a solver, and its rivals' beside it.

    Parameters
    ----------
    cases : DataFrame
        Of all solvers on one set.
    transfer : DataFrame
        Of the solver on the transfer set; may be empty.
    solver : str
        Whose score it is.
    about : mapping
        What summary.json says of the contest: ``set``, ``scale``, ``transfer_set``,
        ``transfer_scale``, ``kept``, the group that all sets but the transfer set leave
        out, its seeds and ``seeds_used_while_mending`` (first and last, by what they
        were used for).
    out : Path
        Folder for :data:`WRITTEN`.
    """
    own = cases[cases["solver"] == solver]
    here, there = reach(own), reach(transfer)
    carried = list(_carried(here, there))
    over = [carried_over(own, transfer)] if len(transfer) else []
    asked = [*here, *over, *_off(carried)]
    found: dict[str, Iterable[Sequence[Any]]] = {
        "in-words.csv": _in_words(here, there),
        "contest.csv": _held(own, transfer, about),
        "kept.csv": list(_groups(about["kept"])),
        "reach.csv": asked,
        "further.csv": [(each.name, *each.of(own)) for each in figures("further")],
        "transfer.csv": carried,
        "confusion.csv": tables.confusion(own),
        "never-seen.csv": never_seen(transfer, about["kept"]),
        "confused.csv": tables.confused(own),
        "effects.csv": tables.by_effect(own),
        "retuned.csv": tables.retuned(own),
        "power.csv": tables.power(own),
        "reliability.csv": tables.reliability(own),
        "rivals.csv": _rivals(cases, own, solver),
    }
    for name, columns in TABLES.items():
        write_csv(out / name, columns, map(_told, found[name]))
    write_frame(out / "cases.csv", cases)
    write_frame(out / "transfer-cases.csv", transfer)
    # Last: where it stands, all is there.
    write_json(
        out / "summary.json",
        {
            "solver": solver,
            **about,
            **summary(own),
            "transfer": summary(transfer) if len(transfer) else None,
            "reach": [item._asdict() for item in asked],
        },
    )


def _held(
    cases: pd.DataFrame, transfer: pd.DataFrame, about: Mapping[str, Any]
) -> list[tuple[Any, ...]]:
    """Say how large each set is and which seeds it has, and those used before."""
    told: list[tuple[Any, ...]] = []
    for name, scale, judged in (
        (about["set"], about["scale"], cases),
        (about["transfer_set"], about["transfer_scale"], transfer),
    ):
        seeds = judged["seed"]
        if len(seeds):
            told.append((name, scale, len(seeds), seeds.min(), seeds.max()))
    mended = about["seeds_used_while_mending"]
    return [*told, *((name, None, None, *ends) for name, ends in mended.items())]


def _groups(group: int) -> Iterator[tuple[Any, ...]]:
    """Say which group was left out, and which come next."""
    for number, item in GROUPS.items():
        parts = (item.families, item.unlisted, item.forms)
        yield number, number == group, *(", ".join(names) for names in parts)


def _carried(
    reached: Sequence[AskedFigure], transfer: Sequence[AskedFigure]
) -> Iterator[tuple[str, float, float, float, bool | None]]:
    """Hold each figure on the transfer set beside the published set's.

    Within 5 points is said of shares; seconds are none.
    """
    for here, there in zip(reached, transfer, strict=True):
        if here.reached is not None and there.reached is not None:
            apart = there.reached - here.reached
            share = here.figure != "seconds_per_case"
            within = abs(apart) <= FIVE_POINTS if share else None
            yield here.figure, here.reached, there.reached, apart, within


def _in_words(
    reached: Sequence[AskedFigure], transfer: Sequence[AskedFigure]
) -> Iterator[tuple[str, str, str]]:
    """Tell in plain words how often the answer was right, failures among it."""
    both = zip(reached, transfer, strict=True)
    known = {here.figure: (here, there) for here, there in both}
    for row in table("in_words"):
        here, there = known[row["figure"]]
        if here.reached is not None:
            wrong = row.get("wrong", False)
            yield row["words"], _rightly(here, wrong), _rightly(there, wrong)


def _rightly(asked: AskedFigure, wrong: bool) -> str:
    """Give right answers in percent of so many cases; nothing where there are none."""
    if asked.reached is None:
        return ""
    share = 1 - asked.reached if wrong else asked.reached
    return f"{100 * share:.0f} % of {asked.cases}"


def _off(carried: Sequence[tuple[Any, ...]]) -> Iterator[AskedFigure]:
    """Count the shares that are more than 5 points off on the transfer set."""
    told = [within for *_, within in carried if within is not None]
    if told:
        off = told.count(False)
        figure = "transfer: shares more than 5 points off"
        yield AskedFigure(figure, "<= 0", float(off), None, None, len(told), not off)


def _rivals(
    cases: pd.DataFrame, own: pd.DataFrame, solver: str
) -> Iterator[tuple[Any, ...]]:
    """Hold all solvers against each other."""
    # Some are asked a share of the cases: the same of the solver's own stand beside.
    asked_of = own["case"].map(cases.groupby("case")["solver"].nunique())
    same = own[asked_of == cases["solver"].nunique()]
    for name, mine in cases.groupby("solver", sort=False):
        yield _rival(str(name), mine)
        if name == solver and len(same) < len(own):
            yield _rival(f"{solver}, the rivals' cases", same)


def _rival(name: str, mine: pd.DataFrame) -> tuple[Any, ...]:
    found = {item.figure: item.reached for item in reach(mine)}
    lost = mine["lost"][mine["lost"] != ""]
    figures = [found[figure] for figure in TABLES["rivals.csv"][3:-1]]
    note = f"first loss: {lost.iloc[0]}" if len(lost) else ""
    return (name, len(mine), len(lost), *figures, note)


def _told(row: Sequence[Any]) -> tuple[Any, ...]:
    """Round numbers to what a table shows; say yes and no."""
    words = {True: "yes", False: "no"}
    return tuple(
        words[item]
        if isinstance(item, bool)
        else (float(f"{item:.4g}") if isinstance(item, float) else item)
        for item in row
    )

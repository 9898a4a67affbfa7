"""The score as files: one for each table that docs, figures and readers use."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from hystbench.challenge.contest import table, tables
from hystbench.challenge.contest.frames import write_frame
from hystbench.challenge.contest.never_seen import never_seen
from hystbench.challenge.contest.summary import (
    AskedFigure,
    carried_over,
    figures,
    reach,
    summary,
)
from hystbench.challenge.left_out_groups import GROUPS
from hystbench.files import write_csv, write_json

#: With room for the rounding of a difference of two shares.
FIVE_POINTS = 0.05 + 1e-9
#: Columns of each table but those of cases.
TABLES: dict[str, list[str]] = table("columns")
_RIVALS = TABLES["rivals.csv"]
WRITTEN = (*TABLES, "cases.csv", "transfer-cases.csv", "summary.json")
"""Files of a score."""


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
    figures = [found[figure] for figure in _RIVALS[3:-1]]
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

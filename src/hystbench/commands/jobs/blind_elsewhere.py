"""``hystbench job blind-elsewhere``: the score of cases that another plant made."""

from pathlib import Path
from typing import Any

import pandas as pd

from hystbench.challenge.contest.score import Row, judge_answer
from hystbench.challenge.contest.summary import figures
from hystbench.challenge.contest.tables import frame, read_rows, sure
from hystbench.files import atomic_path, read_json
from hystbench.gap.schema import SCHEMA
from hystbench.options import DatasetFile, In, Out, command
from hystbench.yaml_files import load_yaml

OURS = {"gain-error": "calibration-error", "offset": "calibration-error"}
"""The vocabulary's words for what such a plant may call otherwise."""
FAMILY = {"gpi": "gpi", "preisach": "preisach", "ja": "jiles-atherton"}
"""The contest's family of plants, by a word that the other plant's has in its name."""
FORM = "of another plant"
"""Its parameters are not compared: they are of another parametrisation."""
COLUMNS = (
    *("figure", "asked", "own", "own_cases"),
    *("elsewhere", "low", "high", "elsewhere_cases"),
)


@command
def blind_elsewhere(
    cases: tuple[DatasetFile, ...], *, own: tuple[In, ...] = (), out: Out
) -> None:
    """Score CASES, folders with truth.yaml and result/gap.json, as a table.

    OWN are cases of the contest, as judged.
    """
    mine = read_rows(own)
    table = beside(mine[mine["solver"] == "gap"], frame(map(told, cases)))
    with atomic_path(out) as fresh:
        table.to_csv(fresh, index=False)


def told(case: Path) -> Row:
    """Judge one case.

    Parameters
    ----------
    case : Path
        A folder with ``truth.yaml`` (``seed``, ``kind``, ``family``, ``gnr_asked_db``,
        null with nothing hidden, ``noise_rms``, ``model_error_rms_holdout``,
        ``gap_rms_holdout`` and ``effects``, each with its ``name``) and
        ``result/gap.json``. Where that is missing the case is lost.
    """
    truth = load_yaml(case / "truth.yaml")
    name = str(truth["family"])
    family = next((ours for word, ours in FAMILY.items() if word in name), name)
    effects = [
        {
            "name": OURS.get(item["name"], item["name"]),
            "form": FORM,
            "where": (),
            "ratio_retuned_db": None,
        }
        for item in truth["effects"]
    ]
    ours = {
        "seed": truth["seed"],
        "kind": truth["kind"],
        "family": family,
        "ratio_db": truth["gnr_asked_db"],
        "noise_rms": truth["noise_rms"],
        "hold_out": {
            "base_error_rms": truth["model_error_rms_holdout"],
            "explainable_rms": truth["gap_rms_holdout"],
        },
        "effects": effects,
    }
    file = case / "result" / "gap.json"
    there = file.exists()
    answer = {
        "status": "answered" if there else "no gap.json",
        "gap": read_json(file) if there else None,
        "seconds": None,
        "cpu_seconds": None,
    }
    place = f"{case.parent.name}/{case.name}"
    return judge_answer("gap", place, ours, answer, SCHEMA, lambda members: members)


def beside(own: pd.DataFrame, elsewhere: pd.DataFrame) -> pd.DataFrame:
    """Put the figures of both plants side by side.

    Parameters
    ----------
    own, elsewhere : DataFrame
        Judged cases of one solver, as ``tables.frame`` has them; ``own`` may be empty.

    Returns
    -------
    DataFrame
        A row a figure; ``low`` and ``high`` are the 95 % interval elsewhere.
    """
    both = [_with_names(cases) for cases in (own, elsewhere)]
    found: list[tuple[Any, ...]] = []
    for figure in figures("elsewhere"):
        here, there = map(figure.of, both)
        found.append((figure.name, figure.asked, here.share, here.cases, *there))
    return pd.DataFrame(found, columns=list(COLUMNS)).round(4)


def _with_names(cases: pd.DataFrame) -> pd.DataFrame:
    """Add whether no name is given, one surely, and a wrong one surely."""
    both = zip(cases["given"], cases["truth"].str.split(), strict=True)
    wrong = [{x: y for x, y in names.items() if x not in true} for names, true in both]
    return cases.assign(
        no_name=[not names for names in cases["given"]],
        confident=list(map(sure, cases["given"])),
        wrongly=list(map(sure, wrong)),
    )

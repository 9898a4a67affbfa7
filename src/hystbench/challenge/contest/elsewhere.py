"""The score of cases that another plant made, each in a folder of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from hystbench.challenge.contest.wilson import wilson
from hystbench.errors import InputError
from hystbench.files import read_json
from hystbench.yaml_files import load_yaml

OURS = {"gain-error": "calibration-error", "offset": "calibration-error"}
"""The vocabulary's words for what such a plant may call otherwise."""
SHAPE = "hysteresis-shape"
SURE = 0.8
COLUMNS = [
    *("kind", "base", "ratio_db", "cases", "right", "low", "high", "exact"),
    "confidently_wrong",
]


def told(case: Path) -> dict[str, Any]:
    """Judge one case: a row.

    Parameters
    ----------
    case : Path
        A folder with ``truth.yaml`` (``kind``, ``family``, ``gnr_asked_db``, null with
        nothing hidden, and ``effects``, each with its ``name``) and
        ``result/gap.json``. Where that is missing the case is lost. A plant of a family
        with ``gpi`` in its name has an exact base.

    Returns
    -------
    dict
        ``right``: of a single effect, whether it is named first; of a pair, whether
        both are named; with nothing hidden, whether nothing is named; of an effect
        that is not in the vocabulary, the same. ``exact``: whether nothing else is
        named. Beside a base of another family than the plant's a wrong shape of the
        loop is neither required nor wrong.
    """
    truth = load_yaml(case / "truth.yaml")
    exactly = "gpi" in str(truth["family"])
    hidden = {OURS.get(item["name"], item["name"]) for item in truth["effects"]}
    file = case / "result" / "gap.json"
    gap: Mapping[str, Any] = read_json(file) if file.exists() else {}
    effects = [
        (item["name"], float(item["confidence"]))
        for item in gap.get("effects", ())
        if gap["verdict"] == "named" and (exactly or item["name"] != SHAPE)
    ]
    named = [name for name, _ in effects]
    kind = str(truth["kind"])
    wanted = hidden if kind in ("single", "pair") else set()
    first = bool(named) and named[0] in wanted
    right = first if kind == "single" else {*named} >= wanted
    if not wanted:
        right = bool(gap) and not named
    return {
        "kind": kind,
        "base": "exact" if exactly else "foreign",
        "ratio_db": truth["gnr_asked_db"],
        "right": right,
        "exact": right and {*named} == wanted,
        "confidently_wrong": any(
            sure > SURE and name not in wanted for name, sure in effects
        ),
    }


def score(cases: Sequence[Path]) -> pd.DataFrame:
    """Score cases by kind, base and ratio of gap to noise.

    Parameters
    ----------
    cases : sequence of Path
        As for :func:`told`.

    Returns
    -------
    DataFrame
        A row a group: shares of the cases, with the 95 % interval of ``right``.

    Raises
    ------
    InputError
        If there is no case, or one has no truth.
    """
    if not cases:
        raise InputError("CASES: none; expected folders with truth.yaml and result/")
    rows = []
    groups = pd.DataFrame([told(case) for case in cases]).groupby(
        ["kind", "base", "ratio_db"], sort=True, dropna=False
    )
    for (kind, base, ratio), group in groups:
        share = wilson(int(group["right"].sum()), len(group))
        rows.append(
            {
                "kind": kind,
                "base": base,
                "ratio_db": ratio,
                "cases": share.cases,
                "right": share.share,
                "low": share.low,
                "high": share.high,
                "exact": group["exact"].mean(),
                "confidently_wrong": group["confidently_wrong"].mean(),
            }
        )
    return pd.DataFrame(rows, columns=COLUMNS).round(4)

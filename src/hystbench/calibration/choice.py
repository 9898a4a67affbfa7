"""The choice among the structures that were tried: the rule, its result, its commit."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from hystbench.calibration.crossvalidation import LeftOut
from hystbench.calibration.fit import Tell
from hystbench.calibration.structures import find_structure
from hystbench.errors import InputError
from hystbench.files import write_csv, write_text
from hystbench.published import FILTERS

RULE = (
    "The least left-out score among the structures that are scored on whole records. "
    "A windowed score leaves samples out that the tables do not, so it is no score of "
    "the same errors: it stays in the table and cannot be chosen."
)
HEAD = """\
# Which structure is chosen among those of calibration/structures.py. The rule was
# committed before the trial was run; `hystbench job structures` writes what it chooses.
"""
COLUMNS = (
    "structure",
    "meaning",
    "whole_record",
    "chosen_by_rule",
    "in_sample_cost",
    "constraints_met",
    "left_out_score",
    *(f"left_out_median_{model}" for model in FILTERS),
    "left_out_within_factor_2",
    "left_out_worst_factor",
    "left_out_rms_percent",
    "free_beside",
)


def choose(tried: Sequence[Mapping[str, Any]]) -> str:
    """Name the structure that the rule chooses.

    Parameters
    ----------
    tried : sequence of mapping
        Results of :func:`hystbench.calibration.trial.try_structure`.

    Raises
    ------
    InputError
        If none is scored on whole records.
    """
    whole = [item for item in tried if find_structure(item["name"]).whole_record]
    if not whole:
        raise InputError("structures: none is scored on whole records; expected one")
    return str(min(whole, key=lambda item: float(item["score"]))["name"])


def write_choice(path: Path, tried: Sequence[Mapping[str, Any]]) -> None:
    """Write the rule, what it chooses and the scores it looked at."""
    figures = {
        item["name"]: {
            "in_sample_cost": round(float(item["cost"]), 2),
            "left_out_score": round(float(item["score"]), 2),
        }
        for item in _by_score(tried)
    }
    chosen = choose(tried)
    content = {
        "rule": RULE,
        "chosen": {"name": chosen, **figures[chosen]},
        "tried": figures,
    }
    text = yaml.safe_dump(content, sort_keys=False, width=88)
    write_text(path, HEAD + text)


def write_structures(path: Path, tried: Sequence[Mapping[str, Any]]) -> None:
    """Write a row for each structure, least left-out score first.

    ``free_beside`` is what the fit to all signals found for the unknowns that the base
    does not have, or not within the same bounds.
    """
    rows = []
    chosen = choose(tried)
    for item in _by_score(tried):
        structure = find_structure(item["name"])
        left_out = [LeftOut(**one) for one in item["left_out"]]
        sizes = np.abs([[one.log10_ratio[m] for m in FILTERS] for one in left_out])
        rows.append(
            [
                structure.name,
                structure.meaning,
                "yes" if structure.whole_record else "no",
                "yes" if structure.name == chosen else "",
                f"{item['cost']:.2f}",
                "yes" if item["constraints_met"] else "no",
                f"{item['score']:.2f}",
                *(f"{value:.3f}" for value in np.median(sizes, axis=0)),
                f"{np.mean(sizes <= np.log10(2)):.3f}",
                f"{10 ** sizes.max():.2f}",
                f"{100 * max(abs(one.rms_error) for one in left_out):.1f}",
                "; ".join(
                    f"{own.name} = {item['values'][own.name]:.3g} "
                    f"{own.unit.replace('-', '')}".strip()
                    for own in structure.more
                ),
            ]
        )
    write_csv(path, COLUMNS, rows)


def check_committed(path: Path, tell: Tell) -> None:
    """Refuse a choice that is not committed as it is.

    Parameters
    ----------
    path : Path
        The file of the choice.
    tell : callable
        Told where that cannot be known: without git, or outside a checkout.

    Raises
    ------
    InputError
        If git does not know the file or it differs from the last commit.
    """
    folder = path.resolve().parent
    try:
        inside = _git(folder, "rev-parse", "--is-inside-work-tree")
    except FileNotFoundError:
        tell(f"{path}: no git here: whether the choice is committed is not known")
        return
    if inside.returncode or inside.stdout.strip() != "true":
        tell(f"{path}: no git checkout: whether the choice is committed is not known")
        return
    # An ignored file is not committed either.
    status = _git(folder, "status", "--porcelain", "--ignored", "--", path.name)
    if status.returncode:
        raise InputError(f"{path}: git status: {status.stderr.strip()}")
    if status.stdout:
        raise InputError(
            f"{path}: not committed as it is ({status.stdout[:2].strip()} in git "
            "status); expected a committed choice before any held-out figure"
        )


def _by_score(tried: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    return sorted(tried, key=lambda item: float(item["score"]))


def _git(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # noqa: S603
        ["git", *words],  # noqa: S607
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )

"""What was tried before the twin was committed: first_round.yaml as a table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hystbench.files import write_csv
from hystbench.published import FILTERS
from hystbench.yaml_files import load_yaml

FIRST_ROUND = Path(__file__).with_suffix(".yaml")
WHAT = ("structure", "input_zero", "window_start_s")
"""What tells one reading from another."""
HOW = (
    "left_out_within_factor_2",
    "left_out_worst_factor",
    "left_out_rms_percent",
)
COLUMNS = (
    *WHAT,
    "chosen",
    "in_sample_cost",
    "left_out_score",
    *(f"left_out_median_{model}" for model in FILTERS),
    *HOW,
)


def write_tried(path: str | Path) -> None:
    """Write a row for each reading that was tried, least left-out score first.

    ``in_sample_cost`` is the cost on all calibration signals, ``left_out_score`` the
    sum that first_round.yaml names over the cells of signals left out in turn. Of these
    cells the other columns tell the median of ``|log10(ours/published)|`` of MSE for
    each filter, the share within a factor of 2, the worst factor, and the largest
    error of the RMS displacement (percent).
    """
    first = load_yaml(FIRST_ROUND)
    rows = sorted(first["tried"], key=lambda item: float(item["left_out_score"]))
    write_csv(path, COLUMNS, [_row(item, first["chosen"]) for item in rows])


def _row(item: dict[str, Any], chosen: dict[str, Any]) -> list[Any]:
    medians = item["left_out_median_abs_log10"]
    return [
        *(item[key] for key in WHAT),
        "yes" if all(item[key] == chosen[key] for key in WHAT) else "",
        item["in_sample_cost"],
        item["left_out_score"],
        *(medians[model] for model in FILTERS),
        *(item[key] for key in HOW),
    ]

"""The ranking with other constants: its table, written and read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from hystbench.compare.rows import read_rows
from hystbench.files import write_csv
from hystbench.published import FILTERS

COLUMNS = (
    "twin",
    "family",
    "zero_error_mA",
    "constant_tap",
    "configured",
    "gpo_first",
    "signals",
    "first_elsewhere",
    "pairs_calibrated",
    "pairs_held_out",
    "diverged",
    *(f"mean_mse_{model}_um2" for model in FILTERS),
)


@dataclass(frozen=True)
class Row:
    """The ranking on a twin with one constant.

    Parameters
    ----------
    twin, family : str
    zero_error : float
        Constant on the recorded input (A).
    constant_tap : float
        Size of the constant tap beside the RMS of the others; zero for none.
    configured : bool
        Whether both are as in config.yaml.
    signals, gpo_first : int
        Signals, and those on which the GPO filter has the least MSE.
    not_first : str
        The others, each with the filter that has.
    pairs_calibrated, pairs_held_out : (int, int)
        Pairs of filters under one signal in the paper's order, and all.
    diverged : int
        Runs that diverged.
    mean : mapping of str to float
        Geometric mean of the MSE over the signals (um^2) by filter.
    """

    twin: str
    family: str
    zero_error: float
    constant_tap: float
    configured: bool
    signals: int
    gpo_first: int
    not_first: str
    pairs_calibrated: tuple[int, int]
    pairs_held_out: tuple[int, int]
    diverged: int
    mean: Mapping[str, float]


def write_constants(rows: Iterable[Row], path: Path) -> None:
    """Write a line for each; a mean with a diverged run in it is none."""
    lines = []
    for each in rows:
        means = [each.mean.get(model, math.inf) for model in FILTERS]
        lines.append(
            [
                each.twin,
                each.family,
                f"{1e3 * each.zero_error:.4g}",
                f"{each.constant_tap:g}",
                "yes" if each.configured else "",
                each.gpo_first,
                each.signals,
                each.not_first,
                *(
                    f"{agree} of {total}"
                    for agree, total in (each.pairs_calibrated, each.pairs_held_out)
                ),
                each.diverged,
                *("" if math.isinf(mean) else f"{mean:.3g}" for mean in means),
            ]
        )
    write_csv(path, COLUMNS, lines)


def read_constants(path: str | Path) -> tuple[Row, ...]:
    """Read what :func:`write_constants` wrote."""

    def pair(text: str) -> tuple[int, int]:
        agree, _, total = text.partition(" of ")
        return int(agree), int(total)

    return tuple(
        Row(
            twin=row["twin"],
            family=row["family"],
            zero_error=float(row["zero_error_mA"]) / 1e3,
            constant_tap=float(row["constant_tap"]),
            configured=row["configured"] == "yes",
            signals=int(row["signals"]),
            gpo_first=int(row["gpo_first"]),
            not_first=row["first_elsewhere"],
            pairs_calibrated=pair(row["pairs_calibrated"]),
            pairs_held_out=pair(row["pairs_held_out"]),
            diverged=int(row["diverged"]),
            mean={
                model: float(text) if text else math.inf
                for model in FILTERS
                for text in [row[f"mean_mse_{model}_um2"]]
            },
        )
        for row in read_rows(path, COLUMNS)
    )

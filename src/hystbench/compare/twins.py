"""What other twins say beside the twin: spreads of errors, and where claims hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from hystbench.compare.rows import read_items
from hystbench.errors import InputError, nearest
from hystbench.published import Metric


@dataclass(frozen=True)
class TwinError:
    """Errors of a model on a signal of a twin; infinite where it diverged."""

    twin: str
    family: str
    signal: str
    model: str
    mse: float
    re: float
    status: str


@dataclass(frozen=True)
class TwinClaim:
    """Whether a claim holds on a twin; experiment 0 is the configured one."""

    twin: str
    family: str
    experiment: int
    claim: str
    holds: str


#: What ``holds`` may say.
HOLDS = ("yes", "no", "not testable")


@dataclass(frozen=True)
class Holding:
    """In how many experiments on the twins of a family a claim holds.

    Parameters
    ----------
    family : str
        Name of the block that makes the hysteresis.
    held, judged : int
        Experiments in which it holds, and in which it could be judged.
    """

    family: str
    held: int
    judged: int

    @property
    def throughout(self) -> bool:
        """Whether it holds in each of them."""
        return self.held == self.judged

    def __str__(self) -> str:
        return f"{self.family} {self.held} of {self.judged}"


def holding_text(holdings: Sequence[Holding]) -> str:
    """Say on which families a claim holds; empty where it was judged on none."""
    if not holdings:
        return ""
    said = ", ".join(map(str, holdings))
    return said if len(holdings) > 1 else f"{said}; no other family was run"


def read_spreads(
    path: str | Path,
) -> dict[tuple[str, str, Metric], tuple[float, float]]:
    """Read the range of each error over the twins of the first twin's family.

    Returns
    -------
    dict
        Smallest and largest by signal, model and metric, infinite where a run
        diverged. Empty where the family has one twin: it has no spread.
    """
    rows = read_items(path, TwinError)
    alike = [row for row in rows if row.family == rows[0].family]
    if len({row.twin for row in alike}) < 2:
        return {}
    values: dict[tuple[str, str, Metric], list[float]] = {}
    for row in alike:
        values.setdefault((row.signal, row.model, "mse"), []).append(row.mse)
        values.setdefault((row.signal, row.model, "re"), []).append(row.re)
    return {cell: (min(found), max(found)) for cell, found in values.items()}


def read_holdings(path: str | Path) -> dict[str, tuple[Holding, ...]]:
    """Read in how many experiments on twins of each family each claim holds.

    Raises
    ------
    InputError
        If a row says neither yes, no nor not testable.
    """
    counts: dict[str, dict[str, list[bool]]] = {}
    for number, row in enumerate(read_items(path, TwinClaim), 1):
        if row.holds not in HOLDS:
            raise InputError(
                f"{path}: row {number}: holds {row.holds!r}; "
                f"{nearest(row.holds, HOLDS)}"
            )
        if row.holds != "not testable":
            families = counts.setdefault(row.claim, {})
            families.setdefault(row.family, []).append(row.holds == "yes")
    return {
        claim: tuple(
            Holding(family, sum(found), len(found))
            for family, found in families.items()
        )
        for claim, families in counts.items()
    }

"""How long the jobs of a dataset computed, for a table of several datasets."""

import os
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from hystbench.compare.rows import read_items
from hystbench.files import write_csv


class Took(NamedTuple):
    """What jobs of a dataset took."""

    dataset: str
    cpu_seconds: float
    """Of computing: what the processor did, whatever else the machine does."""


def write_took(dataset: str, path: Path) -> None:
    """Write how long this process has computed so far, its start included."""
    seconds = sum(os.times()[:4])  # of copies of the process as well
    write_csv(path, Took._fields, [Took(dataset, round(seconds, 1))])


def write_seconds(tables: Iterable[Path], path: Path) -> None:
    """Add up what jobs took: one row a dataset.

    Parameters
    ----------
    tables : iterable of Path
        As :func:`write_took` wrote them.
    path : Path
    """
    seconds: dict[str, float] = {}
    for table in tables:
        for took in read_items(table, Took):
            seconds[took.dataset] = seconds.get(took.dataset, 0.0) + took.cpu_seconds
    write_csv(path, Took._fields, [(x, round(s, 1)) for x, s in seconds.items()])

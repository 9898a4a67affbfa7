"""``hystbench job blind-elsewhere``: the score of cases that another plant made."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import atomic_path


@click.command()
@click.argument("cases", nargs=-1, required=True, type=options.DATASET)
@options.out
def blind_elsewhere(cases: tuple[Path, ...], out: Path) -> None:
    """Score CASES, folders with truth.yaml and result/gap.json, as a table."""
    from hystbench.challenge.contest.elsewhere import score  # late: it needs pandas

    table = score(cases)
    with atomic_path(out) as fresh:
        table.to_csv(fresh, index=False)

"""``hystbench job blind-elsewhere``: the score of cases that another plant made."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.files import atomic_path


@click.command()
@click.argument("cases", nargs=-1, required=True, type=options.DATASET)
@click.option(
    "--own", type=options.FILE, multiple=True, help="Cases of the contest, as judged."
)
@options.out
def blind_elsewhere(cases: tuple[Path, ...], own: tuple[Path, ...], out: Path) -> None:
    """Score CASES, folders with truth.yaml and result/gap.json, as a table."""
    from hystbench.challenge.contest.elsewhere import beside, rows  # late: pandas
    from hystbench.challenge.contest.frames import frame, read_rows
    from hystbench.gap.schema import SCHEMA

    mine = read_rows(own)
    table = beside(mine[mine["solver"] == "gap"], frame(rows(cases, SCHEMA)))
    with atomic_path(out) as fresh:
        table.to_csv(fresh, index=False)

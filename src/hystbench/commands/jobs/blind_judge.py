"""``hystbench job blind-judge``: answers to a chunk against the truth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.challenge.contest.chunk import judge_chunk
from hystbench.challenge.contest.plan import chunks, plan
from hystbench.challenge.contest.score import write_rows
from hystbench.files import read_json
from hystbench.gap.schema import SCHEMA


@click.command()
@click.argument("answers", type=options.FILE, nargs=-1, required=True)
@options.settings
@options.out
def blind_judge(answers: tuple[Path, ...], settings: dict[str, Any], out: Path) -> None:
    """Judge the ANSWERS of all solvers to a chunk, a row a case and solver."""
    entries = chunks(plan(**settings["plan"]), settings["size"])
    given = [read_json(path) for path in answers]
    write_rows(out, list(judge_chunk(entries[settings["chunk"]], given, SCHEMA)))

"""Ours beside theirs: cells, claims, summary, tables and verdict of a comparison."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from hystbench.compare.beside import write_margins
from hystbench.compare.cells import (
    CELL_COLUMNS,
    OFF_COLUMNS,
    ComparedCell,
    compare_cells,
    off_cells,
)
from hystbench.compare.claims import CLAIM_COLUMNS, judge_all
from hystbench.compare.claims.claim import Judgement
from hystbench.compare.measured import ERROR_COLUMNS, errors_table
from hystbench.compare.rows import or_diverged, write_fields
from hystbench.compare.runs import ClaimEvidence
from hystbench.compare.summary import summarise
from hystbench.compare.tables import TITLES, PrintedTable, paper_table
from hystbench.compare.verdict import first_result, print_tables, verdict_page
from hystbench.files import write_json, write_text
from hystbench.published import load_errors, signals
from hystbench.published.discrepancies import write_audit

WRITTEN = (
    *("cells.csv", "off.csv", "claims.csv", "audit.csv", "summary.json", "margins.csv"),
    *("first.md", "verdict.rst", "verdict.md", "tables.txt", "tables/table-*"),
    *("added.csv", "tables/added.*"),
)
"""Files of a comparison, as names or patterns.

``first.md`` is for the README, ``tables.txt`` for the terminal; ``added`` is there
where models or signals ran that the paper does not have.
"""


@dataclass(frozen=True)
class Comparison:
    """Evidence beside the paper, and all that is found in it.

    Models and signals that the paper does not have stand in a table of their own;
    neither claims nor summary are of such models.
    """

    evidence: ClaimEvidence
    held_out: Collection[str] = ()
    """Signals whose published errors were not used in choosing the twin; the summary
    then tells both groups apart."""

    @cached_property
    def own(self) -> ClaimEvidence:
        """What is said of the paper's own models."""
        return self.evidence.of_the_paper

    @cached_property
    def cells(self) -> tuple[ComparedCell, ...]:
        """Ours beside every printed number."""
        return compare_cells(self.own, self.held_out)

    @cached_property
    def claims(self) -> tuple[Judgement, ...]:
        """The ledger of claims."""
        return judge_all(self.own, self.held_out)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """How near ours come, and how many claims hold."""
        return summarise(self.own, self.cells, self.claims, self.held_out)

    @cached_property
    def tables(self) -> tuple[PrintedTable, ...]:
        """Tables 1-4, and a table of what is in none of them, if there is any.

        There, models that the paper does not have stand beside its own.
        """
        counts = {name: len(drawn.rms) for name, drawn in self.own.drawn.items()}
        tables = tuple(paper_table(number, self.cells, counts) for number in TITLES)
        found = self.evidence
        models, names = found.added_models, found.added_signals
        if not models and not names:
            return tables
        why = f"The paper has no numbers for {', '.join((*models, *names))}."
        runs = list(found.runs.values()) if models else list(found.added)
        return (*tables, errors_table("added", "Our errors on the twin.", why, runs))

    def text(self) -> str:
        """Give the comparison for a terminal."""
        return print_tables(self.tables, self.claims, self.summary)

    def write(self, out_dir: str | Path) -> None:
        """Write the files of :data:`WRITTEN` into a folder."""
        out = Path(out_dir)
        write_fields(out / "cells.csv", CELL_COLUMNS, self.cells, or_diverged)
        write_fields(out / "off.csv", OFF_COLUMNS, off_cells(self.cells, self.own))
        write_fields(out / "claims.csv", CLAIM_COLUMNS, self.claims)
        write_audit(out / "audit.csv")
        write_margins(self.evidence.edges, self.held_out, out / "margins.csv")
        write_json(out / "summary.json", self.summary)
        write_text(out / "verdict.rst", verdict_page(self.summary, "rst"))
        write_text(out / "verdict.md", verdict_page(self.summary, "pipe"))
        write_text(out / "first.md", first_result(self.summary))
        write_text(out / "tables.txt", self.text())
        for table in self.tables:
            table.write(out / "tables")
        if added := self.evidence.added:
            write_fields(out / "added.csv", ERROR_COLUMNS, added, or_diverged)


def held_out_signals(calibrated: Iterable[str]) -> tuple[str, ...]:
    """List the signals of the tables that a calibration did not see."""
    seen = set(calibrated)
    return tuple(name for name in signals(load_errors()) if name not in seen)

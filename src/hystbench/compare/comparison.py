"""Ours beside theirs: cells, claims, summary, tables and verdict of a comparison."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hystbench.compare.beside import write_margins
from hystbench.compare.cells import (
    CELL_COLUMNS,
    OFF_COLUMNS,
    ComparedCell,
    OffCell,
    compare_cells,
    off_cells,
)
from hystbench.compare.claims import CLAIM_COLUMNS, judge_all
from hystbench.compare.claims.claim import Judgement
from hystbench.compare.evidence import ClaimEvidence
from hystbench.compare.measured import ERROR_COLUMNS, errors_table
from hystbench.compare.rows import or_diverged, write_fields
from hystbench.compare.summary import summarise
from hystbench.compare.tables import PrintedTable, paper_tables
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
    """All that a comparison finds."""

    evidence: ClaimEvidence
    held_out: frozenset[str]
    cells: tuple[ComparedCell, ...]
    off: tuple[OffCell, ...]
    claims: tuple[Judgement, ...]
    summary: dict[str, Any]
    tables: tuple[PrintedTable, ...]

    def text(self) -> str:
        """Give the comparison for a terminal."""
        return print_tables(self.tables, self.claims, self.summary)

    def write(self, out_dir: str | Path) -> None:
        """Write the files of :data:`WRITTEN` into a folder."""
        out = Path(out_dir)
        write_fields(out / "cells.csv", CELL_COLUMNS, self.cells, or_diverged)
        write_fields(out / "off.csv", OFF_COLUMNS, self.off)
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


def compare_evidence(
    evidence: ClaimEvidence, held_out: Iterable[str] = ()
) -> Comparison:
    """Compare evidence with the paper.

    Models and signals that the paper does not have stand in a table of their own;
    neither claims nor summary are of such models.

    Parameters
    ----------
    evidence : ClaimEvidence
    held_out : iterable of str
        Signals whose published errors were not used in choosing the twin; the summary
        then tells both groups apart.
    """
    unseen, own = frozenset(held_out), evidence.of_the_paper
    cells = compare_cells(own, unseen)
    claims = judge_all(own, unseen)
    counts = {name: len(drawn.rms) for name, drawn in own.drawn.items()}
    return Comparison(
        evidence,
        unseen,
        cells,
        off_cells(cells, own),
        claims,
        summarise(own, cells, claims, unseen),
        (*paper_tables(cells, counts), *_added_table(evidence)),
    )


def _added_table(evidence: ClaimEvidence) -> list[PrintedTable]:
    """Set side by side what ran and is in none of the paper's tables, if there is any.

    Models that the paper does not have stand beside its own.
    """
    models, names = evidence.added_models, evidence.added_signals
    if not models and not names:
        return []
    why = f"The paper has no numbers for {', '.join((*models, *names))}."
    runs = list(evidence.runs.values()) if models else list(evidence.added)
    return [errors_table("added", "Our errors on the twin.", why, runs)]

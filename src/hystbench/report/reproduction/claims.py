"""The paper's claims and the audit of its printed numbers, as tables."""

from collections import Counter
from collections.abc import Sequence

from markupsafe import Markup

from hystbench.report.markup import inline
from hystbench.report.picture import Link
from hystbench.report.reproduction.read import Row
from hystbench.report.table import (
    Body,
    Cell,
    Heading,
    PageTable,
    number,
    table_in,
)

#: How a verdict looks; one that is not listed looks as text.
_SIGNS = {"reproduced": ("✓", "good"), "not reproduced": ("✗", "bad")}
#: Held-out evidence leads; an empty basis is that of theory and notation.
BASES = ("held-out", "fitted", "constrained", "built-in", "")
#: The verdict of a claim that is fitted in part, on held-out signals alone.
ALONE = "on_held_out"


def counts_table(claims: Sequence[Row]) -> PageTable:
    """Count verdicts by what they rest on, held-out first; nothing is added up."""
    verdicts = list(dict.fromkeys(row["verdict"] for row in claims))
    counted: dict[str, Counter[str]] = {}
    for row in _in_order(claims):
        shown = row["basis"] or "nothing: theory, notation, or not testable"
        counted.setdefault(shown, Counter())[row["verdict"]] += 1
    if alone := Counter(row[ALONE] for row in claims if row.get(ALONE)):
        counted["fitted in part, on the held-out signals alone"] = alone
        verdicts += [verdict for verdict in alone if verdict not in verdicts]
    rows = [
        [Cell(shown), *(number(found[each]) for each in verdicts)]
        for shown, found in counted.items()
    ]
    return PageTable(
        "claims-counted",
        "Claims by what the twin knew of them before they were judged. Rows are not "
        "added up: only the held-out ones were open.",
        [Heading("basis"), *(Heading(verdict, True) for verdict in verdicts)],
        [Body(rows)],
    )


def claims_table(claims: Sequence[Row], caption: str, file: Link) -> PageTable:
    """Show every claim with its verdict and the evidence for it."""
    known = {"verdict": _verdict, "claim": _claim, "borne_out": _borne_out}
    about = (_in_order(claims), known, inline(caption))
    return table_in(__package__, "claims", *about, files=(file,))


def _in_order(claims: Sequence[Row]) -> list[Row]:
    """Put first what rests on held-out signals."""
    places = {name: place for place, name in enumerate(BASES)}
    return sorted(claims, key=lambda row: places.get(row["basis"], len(places)))


def _verdict(verdict: str) -> Cell:
    sign, mark = _SIGNS.get(verdict, ("", "quiet"))
    return Cell(f"{sign} {verdict}".strip(), verdict, mark)


def _claim(row: Row) -> Cell:
    shown = Markup('{} <span class="quiet small">({})</span>').format(
        row["claim"], row["where"]
    )
    if row.get("reading"):
        shown += Markup('<br><span class="quiet small">Read as: {}.</span>').format(
            row["reading"].rstrip(".")
        )
    return Cell(shown, row["claim"])


def _borne_out(row: Row) -> str:
    said = {"yes": "bear it out", "no": "do not bear it out"}
    bears = row.get("published_bears_out", "")
    evidence = row.get("published_evidence", "")
    return ": ".join(part for part in (said.get(bears, bears), evidence) if part)


def audit_table(audit: Sequence[Row], caption: str, file: Link) -> PageTable:
    """Show where the paper's own numbers contradict each other, conflicts first."""
    ordered = sorted(audit, key=lambda row: row["kind"] != "conflict")
    about = (ordered, {"kind": _kind}, inline(caption))
    return table_in(__package__, "audit", *about, files=(file,))


def _kind(row: Row) -> Cell:
    return Cell(row["kind"], mark="bad" if row["kind"] == "conflict" else "")

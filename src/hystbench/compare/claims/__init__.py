"""The ledger: every checkable sentence of the paper, judged.

The claims are the rows of ``claims.yaml``. A row names a measure, a function of one of
the modules here, and the conditions on the numbers that it finds. A measure takes all
numbers of what it measures, so that claims about the same share it.
"""

import inspect
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from importlib.resources import files
from typing import Any

from hystbench.compare.claims import errors, filters, operators, response
from hystbench.compare.claims.claim import (
    Claim,
    Judgement,
    Test,
    condition,
    judge_claim,
)
from hystbench.compare.runs import ClaimEvidence
from hystbench.yaml_files import parse_yaml

MEASURES = {
    f"{module.__name__.rpartition('.')[2]}.{name}": function
    for module in (errors, filters, operators, response)
    for name, function in vars(module).items()
    if inspect.isfunction(function) and function.__module__ == module.__name__
}

#: Columns of claims.csv; of a renamed one also the attribute of a Judgement.
CLAIM_COLUMNS = (
    *("id=claim.id", "claim=claim.claim", "where=claim.where", "kind=claim.kind"),
    *("basis=claim.basis", "reading=claim.reading", "verdict"),
    *("on_held_out=held_out_verdict", "holds_on", "evidence"),
    *("published_bears_out", "published_evidence"),
)


def _test(row: Mapping[str, Any]) -> Test:
    if "untestable" in row:
        return Test(None, says=row["untestable"])
    return Test(
        measure=MEASURES[row["measure"]],
        arguments=row.get("with", {}),
        holds=tuple(map(condition, row["holds"])),
        says=row["says"],
        otherwise=row.get("otherwise", ""),
    )


def read_claim(row: Mapping[str, Any]) -> Claim:
    """Make a claim of a row of the table.

    ``theirs`` of a row is what differs where the paper's own numbers are judged.
    """
    theirs = None
    if "theirs" in row:
        arguments = {**row.get("with", {}), **row["theirs"].get("with", {})}
        theirs = _test({**row, **row["theirs"], "with": arguments})
    told = {item.name: row[item.name] for item in fields(Claim) if item.name in row}
    return Claim(**{**told, "ours": _test(row), "theirs": theirs})


_TABLE = files(__package__).joinpath("claims.yaml").read_text(encoding="utf-8")
CLAIMS = tuple(map(read_claim, parse_yaml(_TABLE, "claims.yaml")))


def judge_all(
    evidence: ClaimEvidence, held_out: Iterable[str] = ()
) -> tuple[Judgement, ...]:
    """Judge every claim of the ledger.

    Parameters
    ----------
    evidence : ClaimEvidence
    held_out : iterable of str
        Signals that no fit has read. A claim that is judged by them and by others is
        also judged on them alone.
    """
    alone = evidence.on_signals(held_out)
    elsewhere = replace(alone, runs={}, records={}, envelope_errors={}, drawn={})

    def judged(claim: Claim) -> Judgement:
        found = judge_claim(claim, evidence)
        if claim.basis != "fitted":
            return found
        if claim.holds(elsewhere) is not None or claim.holds(alone) is None:
            return found  # it is not about these signals
        verdict = judge_claim(claim, alone).verdict
        if verdict == "refuted by the paper" != found.verdict:
            return found  # not even the paper's own errors show it on so few signals
        return replace(found, held_out_verdict=verdict)

    return tuple(map(judged, CLAIMS))

"""The audit of the paper's own numbers as one table."""

from collections.abc import Iterator
from dataclasses import astuple, fields
from pathlib import Path

from hystbench.files import write_csv
from hystbench.published import FILTERS, load_errors
from hystbench.published.consistency import SignalCheck, check
from hystbench.published.discrepancies import AuditRow, discrepancies


def _consistency(signal: str, found: SignalCheck) -> Iterator[AuditRow]:
    """Tell what MSE / RE^2 = mean(d^2) says about a signal."""
    rms = found.intervals
    for one, other in found.conflicts:
        yield AuditRow(
            "conflict",
            f"Tables 1-3, {signal}",
            f"the pairs of {one} and {other} cannot both be true",
            f"they imply an RMS of {rms[one]} um and {rms[other]} um",
        )
    for removed, left in zip(found.removals, found.rms, strict=True):
        ways = len(found.removals)
        rank = "the smallest set" if ways == 1 else f"one of {ways} smallest sets"
        agreed = "all filters agree"
        if removed:
            agreed = f"the filters agree without {' and '.join(removed)} ({rank})"
        yield AuditRow(
            "implied RMS",
            f"Tables 1-3, {signal}",
            agreed,
            f"RMS displacement {left} um",
        )
    for model in rms:
        standing = found.standing(model)
        if model in FILTERS or standing == "yes":
            continue
        yield AuditRow(
            "conflict" if standing == "no" else "undecided",
            f"Table 4, {signal}",
            f"the pair of {model} against the filters of Tables 1-3: "
            + ("it cannot be true of their record" if standing == "no" else "open"),
            f"it implies an RMS of {rms[model]} um; they leave "
            + " or ".join(f"{left} um" for left in found.rms),
        )


def audit() -> tuple[AuditRow, ...]:
    """List every finding, the inconsistent pairs first."""
    checks = check(load_errors()).items()
    rows = (row for signal, found in checks for row in _consistency(signal, found))
    return (*rows, *discrepancies())


def write_audit(path: str | Path) -> None:
    """Write the audit as CSV: kind, where, statement, evidence."""
    columns = [field.name for field in fields(AuditRow)]
    write_csv(path, columns, (astuple(row) for row in audit()))

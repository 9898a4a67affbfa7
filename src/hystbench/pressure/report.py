"""What the ensemble says, as files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tabulate import tabulate

from hystbench.compare.claims.halves import holds
from hystbench.compare.evidence import Evidence
from hystbench.compare.twins import CLAIM_COLUMNS, ERROR_COLUMNS
from hystbench.files import write_csv, write_json, write_text
from hystbench.pressure.judging import Count, Pressed, born_out, pressed_claims
from hystbench.pressure.runs import Ensemble

COLUMNS = (
    "claim",
    "sentence",
    "published_bears_out",
    "on_gpi_twin",
    "on_gpi_twin_finite",
    "on_held_out",
    "on_other_families",
    "on_other_families_finite",
    "by_family",
    "members",
    "finite",
)
TWIN_COLUMNS = ("claim", "twin", "family", "signals", "held", "members")

#: Fraction of an ensemble in which a claim that holds firmly does.
FIRM = 0.9


def write_twins(
    ensembles: Sequence[Ensemble],
    others: Iterable[Ensemble],
    errors: Path,
    claims: Path,
) -> None:
    """Write the errors on each twin as configured, and the claims in each experiment.

    Parameters
    ----------
    ensembles, others : Ensemble
        Each twin as configured, and in other experiments.
    errors, claims : Path
        Files to write.
    """
    error_rows: list[list[Any]] = []
    claim_rows: list[list[Any]] = []
    configured = [_evidence(each) for each in ensembles]
    pressed = pressed_claims(configured[0])
    for each, evidence in zip(ensembles, configured, strict=True):
        for run in evidence.runs.values():
            cell = [run.signal, run.model, run.mse, run.re, run.status]
            error_rows.append([each.twin.name, each.twin.family, *cell])
    for each in (*ensembles, *others):
        evidence = _evidence(each)
        place = [each.twin.name, each.twin.family, each.seed]
        for claim in pressed:
            found = holds(claim, evidence)
            word = {True: "yes", False: "no", None: "not testable"}[found]
            claim_rows.append([*place, claim.id, word])
    write_csv(errors, ERROR_COLUMNS, error_rows)
    write_csv(claims, CLAIM_COLUMNS, claim_rows)


WRITTEN = ("claims.csv", "by-twin.csv", "summary.json", "claims.md")
"""Files of the claims under pressure."""


def _evidence(ensemble: Ensemble) -> Evidence:
    return ensemble.evidence(dict.fromkeys((model for model, _ in ensemble.runs), 1.0))


def write_pressure(
    pressed: Sequence[Pressed],
    counts: Sequence[Count],
    design: dict[str, Any],
    out: Path,
) -> None:
    """Write ``claims.csv``, ``by-twin.csv``, ``claims.md`` and ``summary.json``."""
    rows = [
        [
            each.claim.id,
            each.claim.claim,
            born_out(each.claim),
            each.on_gpi_twin,
            each.on_gpi_twin_finite,
            each.on_held_out,
            each.on_other_families,
            each.on_other_families_finite,
            "; ".join(f"{name} {part:.3f}" for name, part in each.by_family.items()),
            each.members,
            each.finite,
        ]
        for each in pressed
    ]
    write_csv(out / "claims.csv", COLUMNS, rows)
    write_csv(out / "by-twin.csv", TWIN_COLUMNS, _by_twin(counts))
    summary = summarise(pressed, design)
    write_json(out / "summary.json", summary)
    write_text(out / "claims.md", markdown(pressed, summary))


def _by_twin(counts: Sequence[Count]) -> list[list[Any]]:
    """Sum over seeds."""
    sums: dict[tuple[str, str, str, str], list[int]] = {}
    for each in counts:
        signals = "held-out" if each.held_out_only else "all"
        key = (each.claim.id, each.twin, each.family, signals)
        held, members = sums.get(key, [0, 0])
        sums[key] = [held + each.held, members + each.members]
    return [[*key, *numbers] for key, numbers in sums.items()]


def summarise(pressed: Sequence[Pressed], design: dict[str, Any]) -> dict[str, Any]:
    """Count the claims that hold firmly, of all and of those the tables bear out."""
    borne = [each for each in pressed if born_out(each.claim) == "yes"]
    return {
        **design,
        "firm_from_fraction": FIRM,
        "claims": _firm(pressed),
        "claims_that_the_tables_bear_out": _firm(borne),
    }


def _firm(pressed: Sequence[Pressed]) -> dict[str, Any]:
    columns = (
        "on_gpi_twin",
        "on_gpi_twin_finite",
        "on_held_out",
        "on_other_families",
        "on_other_families_finite",
    )
    found: dict[str, Any] = {"number": len(pressed)}
    for column in columns:
        parts = {each.claim.id: getattr(each, column) for each in pressed}
        judged = {name: part for name, part in parts.items() if part is not None}
        found[column] = {
            "judged": len(judged),
            "firm": sum(part >= FIRM for part in judged.values()),
            "not_firm": [name for name, part in judged.items() if part < FIRM],
        }
    return found


def markdown(pressed: Sequence[Pressed], summary: dict[str, Any]) -> str:
    """Write the fractions and the design of the ensemble as Markdown."""
    lines = [
        [
            each.claim.id,
            born_out(each.claim),
            _percent(each.on_gpi_twin),
            _percent(each.on_gpi_twin_finite),
            _percent(each.on_held_out),
            _percent(each.on_other_families),
            _percent(each.on_other_families_finite),
        ]
        for each in pressed
    ]
    headers = [
        "claim",
        "the paper's tables bear it out",
        "on GPI twins",
        "on these, no filter diverged",
        "on these, held-out signals",
        "on twins of other families",
        "on the others, no filter diverged",
    ]
    table = tabulate(lines, headers, tablefmt="pipe", disable_numparse=True)
    return f"{_design(summary)}\n\n{table}\n\n{_firmly(summary)}\n"


def _design(summary: dict[str, Any]) -> str:
    twins = "; ".join(
        f"{number} {family}" for family, number in summary["twins"].items()
    )
    factors = ", ".join(f"{factor:g}" for factor in summary["step_factors"])
    return (
        f"Twins: {twins}. On each: {summary['seeds']} seeds, and with each seed "
        f"{summary['step_choices']} of the {summary['step_choices_possible']} choices "
        f"of a factor ({factors}) on the step sizes of each filter."
    )


def _firmly(summary: dict[str, Any]) -> str:
    said = []
    for key, name in (
        ("claims", "all claims in the table"),
        ("claims_that_the_tables_bear_out", "those that the paper's tables bear out"),
    ):
        parts = [
            f"{part['firm']} of {part['judged']} {where}"
            for column, where in (
                ("on_gpi_twin", "on GPI twins"),
                ("on_gpi_twin_finite", "on these where no filter diverged"),
                ("on_held_out", "on these with the held-out signals alone"),
                ("on_other_families", "on twins of other families"),
                ("on_other_families_finite", "on these where no filter diverged"),
            )
            if (part := summary[key][column])["judged"]
        ]
        firm = 100 * summary["firm_from_fraction"]
        said.append(f"Of {name}, {', '.join(parts)} hold in {firm:.0f} % or more.")
    return " ".join(said)


def _percent(part: float | None) -> str:
    return "" if part is None else f"{100 * part:.1f} %"

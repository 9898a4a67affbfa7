"""How near ours come to the paper, in a few numbers.

All are over MSE alone: RE is the same error over the same record again. The
filters' 52 pairs of Tables 1-3 count once each; Table 4's GPO column repeats them.
"""

import math
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import combinations
from statistics import median
from typing import Any, get_args

from hystbench.compare.beside import Edge, Ranking
from hystbench.compare.cells import NEAR_FACTOR, ComparedCell, rms_error_percent
from hystbench.compare.claims.claim import Basis, Judgement, Verdict
from hystbench.compare.runs import Cell, ClaimEvidence
from hystbench.published import FILTERS


def nearness(cells: Sequence[ComparedCell]) -> dict[str, Any]:
    """Sum up cells; a diverged run is outside every factor and infinitely far."""
    ran = [cell for cell in cells if cell.ran]
    distances = [cell.distance for cell in ran]
    middle = median(distances) if distances else None
    within = sum(d <= math.log10(NEAR_FACTOR) for d in distances)
    finite = [cell for cell in ran if math.isfinite(cell.distance)]
    worst = max(finite, key=lambda cell: cell.distance, default=None)
    return {
        "cells": len(ran),
        "cells_published": len(cells),
        "diverged": sum(cell.ours is None for cell in ran),
        "within_factor_2": within / len(ran) if ran else None,
        "median_abs_log10_ratio": (
            middle if middle is not None and math.isfinite(middle) else None
        ),
        "worst_finite": worst
        and {
            "signal": worst.signal,
            "model": worst.model,
            "log10_ratio": worst.log10_ratio,
        },
    }


def orderings(cells: Sequence[ComparedCell]) -> dict[str, int]:
    """Count the pairs of filters under one signal that ours order as the paper does."""
    theirs = {(c.signal, c.model): float(c.published) for c in cells}
    ours = {
        (c.signal, c.model): math.inf if c.ours is None else c.ours
        for c in cells
        if c.ran
    }
    agree, compared = pairs_in_order(ours, theirs)
    published = sum(math.comb(n, 2) for n in Counter(s for s, _ in theirs).values())
    return {"agree": agree, "compared": compared, "published": published}


def pairs_in_order(
    ours: Mapping[Cell, float], theirs: Mapping[Cell, float]
) -> tuple[int, int]:
    """Count pairs of models under one signal that both order alike, and all.

    Pairs that one of them does not have are left out. An infinite error is worse than
    a finite one; a pair with the same error, as where both diverged, has no order.
    """
    pairs = [
        (one, other)
        for one, other in combinations([cell for cell in ours if cell in theirs], 2)
        if one[0] == other[0]
    ]
    agree = [
        ours[a] != ours[b] and (ours[a] < ours[b]) == (theirs[a] < theirs[b])
        for a, b in pairs
    ]
    return sum(agree), len(pairs)


def claim_counts(judgements: Sequence[Judgement]) -> dict[str, Any]:
    """Count verdicts, in all, by kind of claim and by what they rest on."""
    by_basis = _by_basis(judgements)
    on_held_out = _on_held_out(judgements)
    told = {each["id"] for each in on_held_out}
    others = [each for each in judgements if each.claim.id not in told]
    return {
        "claims_total": len(judgements),
        "claims_reproduced_where": _where(judgements),
        "claims_by_kind": {
            kind: _verdicts(j for j in judgements if j.claim.kind == kind)
            for kind in dict.fromkeys(j.claim.kind for j in judgements)
        },
        "claims_by_basis": {basis: by_basis[basis] for basis in by_basis if basis},
        "claims_without_basis": by_basis[""],
        "claims_on_held_out": on_held_out,
        "claims_elsewhere": _by_basis(others),
    }


def _by_basis(judgements: Sequence[Judgement]) -> dict[str, dict[str, int]]:
    return {
        basis: _verdicts(j for j in judgements if j.claim.basis == basis)
        for basis in get_args(Basis)
    }


def _verdicts(judgements: Iterable[Judgement]) -> dict[str, int]:
    counts = Counter(each.verdict for each in judgements)
    return {word.replace(" ", "_"): counts[word] for word in get_args(Verdict)}


def _on_held_out(judgements: Iterable[Judgement]) -> list[dict[str, str]]:
    """List the results that can be judged on held-out signals alone, each with how.

    A claim that is fitted in part stands where it is reproduced on the held-out signals
    and on all: a trend over few of them says less. What the paper's own tables refute
    is no result to be reproduced.
    """
    found = []
    for each in judgements:
        verdict = {"held-out": each.verdict, "fitted": each.held_out_verdict}.get(
            each.claim.basis, ""
        )
        if verdict == "reproduced":
            verdict = each.verdict
        if (
            each.claim.kind == "result"
            and verdict in ("reproduced", "not reproduced")
            and each.verdict != "refuted by the paper"
        ):
            own = {"id": each.claim.id, "claim": each.claim.claim, "verdict": verdict}
            found.append(own | {"basis": each.claim.basis})
    return found


def eq19_finding(edges: Sequence[Edge]) -> dict[str, Any] | None:
    """Count the edges inside Eq. 19's bound; None without a sweep.

    ``example`` is the edge that lies deepest inside, or None.
    """
    if not edges:
        return None
    inside = [edge for edge in edges if edge.fails_below_bound]
    worst = min(inside, key=lambda edge: edge.edge_over_trace or 0, default=None)
    return {
        "edges": len(edges),
        "inside": len(inside),
        "example": worst
        and {
            "signal": worst.signal,
            "model": worst.model,
            "edge": worst.edge,
            "bound": worst.at_trace,
        },
    }


def constant_tap_finding(rows: Sequence[Ranking]) -> dict[str, Any] | None:
    """Set the rankings with constant taps, and other zero errors, beside the usual one.

    On the first twin; the halves of the pairs apart. None where no tap was tried.
    """
    mine = [row for row in rows if row.twin == rows[0].twin]
    usual = [row for row in mine if row.configured]
    taps = [row for row in mine if row.constant_tap and not row.configured]
    if not usual or not taps:
        return None
    offsets = [row for row in mine if not row.constant_tap]

    def told(row: Ranking) -> dict[str, Any]:
        pairs = ("pairs_calibrated", "pairs_held_out")
        return {
            "constant_tap": row.constant_tap,
            "zero_error_A": row.zero_error_mA / 1e3,
            "gpo_first": row.gpo_first,
            "signals": row.signals,
            **{key: [*map(int, getattr(row, key).split(" of "))] for key in pairs},
        }

    return {
        "without": told(usual[0]),
        "with": [told(row) for row in sorted(taps, key=lambda row: row.constant_tap)],
        "zero_errors": [
            told(row) for row in sorted(offsets, key=lambda row: row.zero_error_mA)
        ],
    }


def _where(judgements: Iterable[Judgement]) -> dict[str, int]:
    """Count reproduced results by the families of twins on which they hold.

    Those that a twin could have failed: what is demanded or built in holds on any.
    """
    counts = {"every_family": 0, "some_families": 0, "one_family_run": 0}
    for each in judgements:
        if each.verdict != "reproduced" or not each.holdings:
            continue
        if each.claim.basis not in ("held-out", "fitted"):
            continue
        if len(each.holdings) == 1:
            counts["one_family_run"] += 1
        elif all(holding.throughout for holding in each.holdings):
            counts["every_family"] += 1
        else:
            counts["some_families"] += 1
    return counts


def summarise(
    evidence: ClaimEvidence,
    cells: Sequence[ComparedCell],
    judgements: Sequence[Judgement],
    held_out: Collection[str] = (),
) -> dict[str, Any]:
    """Sum up a comparison.

    Parameters
    ----------
    evidence : ClaimEvidence
    cells : sequence of ComparedCell
        All cells, of both metrics.
    judgements : sequence of Judgement
        The ledger of claims.
    held_out : collection of str
        Signals whose published errors were not used in choosing the twin and its
        step sizes. The filters' cells are split by them where there are any.

    Returns
    -------
    dict
        Ready for JSON. Its top level, ``per_model``, ``calibrated``, ``held_out``
        and ``without_inconsistent`` are over filters; ``rdgpi`` stands apart.
    """
    mse = [cell for cell in cells if cell.metric == "mse"]
    filters = [cell for cell in mse if cell.model in FILTERS]
    sure = [c for c in filters if c.published_consistent == "yes"]
    not_refuted = [c for c in filters if c.published_consistent != "no"]
    rms_errors = rms_error_percent(evidence)
    return {
        "metric": "MSE",
        **nearness(filters),
        "per_model": _per_model(filters),
        "orderings": orderings(filters),
        **_split(filters, held_out, rms_errors, evidence.drawn),
        "rms_error_percent": rms_errors,
        "without_inconsistent": {
            "without_no": nearness(not_refuted),
            "without_no_and_undecided": nearness(sure),
        },
        "rdgpi": nearness([cell for cell in mse if cell.model == "rdgpi"]),
        "eq19": eq19_finding(evidence.edges),
        "constant_tap": constant_tap_finding(evidence.constants),
        **claim_counts(judgements),
    }


def _per_model(cells: Sequence[ComparedCell]) -> dict[str, dict[str, Any]]:
    return {m: nearness([c for c in cells if c.model == m]) for m in FILTERS}


def _split(
    cells: Sequence[ComparedCell],
    held_out: Collection[str],
    rms_errors: Mapping[str, float],
    drawn: Collection[str],
) -> dict[str, Any]:
    """Sum up both halves apart, with a median for each model.

    The RMS of a signal that is drawn many times was used, so it counts with the
    calibrated ones in that alone.
    """
    halves: dict[str, Any] = {}
    if not held_out:
        return halves
    unseen = set(held_out) - set(drawn)
    for key, inside in (("calibrated", False), ("held_out", True)):
        half = [c for c in cells if (c.signal in held_out) is inside]
        found = nearness(half)
        sizes = [abs(v) for s, v in rms_errors.items() if (s in unseen) is inside]
        per_model = _per_model(half)
        halves[key] = found | {
            "per_model": per_model,
            "median_abs_log10_ratio": {
                model: part["median_abs_log10_ratio"]
                for model, part in per_model.items()
            },
            "median_abs_log10_ratio_all": found["median_abs_log10_ratio"],
            "largest_rms_error_percent": max(sizes, default=None),
            "orderings": orderings(half),
        }
    return halves

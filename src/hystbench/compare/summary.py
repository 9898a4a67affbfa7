"""How near ours come to the paper, in a few numbers.

All are over MSE alone: RE is the same error over the same record again. The
filters' 52 pairs of Tables 1-3 count once each; Table 4's GPO column repeats them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import combinations
from statistics import median
from typing import Any

from hystbench.compare.cells import ComparedCell
from hystbench.compare.claims.claim import Judgement
from hystbench.published import FILTERS

FACTOR = 2.0


def nearness(cells: Sequence[ComparedCell]) -> dict[str, Any]:
    """Sum up cells; a diverged run is outside every factor and infinitely far."""
    ran = [cell for cell in cells if cell.ran]
    distances = [cell.distance for cell in ran]
    middle = median(distances) if distances else None
    within = sum(d <= math.log10(FACTOR) for d in distances)
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


def orderings(cells: Iterable[ComparedCell]) -> dict[str, int]:
    """Count the pairs of filters under one signal that ours order as the paper does.

    A diverged run is worse than a finite one; two diverged runs have no order.
    """
    by_signal: dict[str, dict[str, ComparedCell]] = {}
    for cell in cells:
        by_signal.setdefault(cell.signal, {})[cell.model] = cell
    published = compared = agree = 0
    for models in by_signal.values():
        for one, other in combinations(models.values(), 2):
            published += 1
            if one.ran and other.ran:
                compared += 1
                agree += _agree(one, other)
    return {"agree": agree, "compared": compared, "published": published}


def _agree(one: ComparedCell, other: ComparedCell) -> bool:
    ours = [math.inf if c.ours is None else c.ours for c in (one, other)]
    theirs = [float(c.published) for c in (one, other)]
    return ours[0] != ours[1] and (ours[0] < ours[1]) == (theirs[0] < theirs[1])


def claim_counts(judgements: Iterable[Judgement]) -> dict[str, Any]:
    """Count verdicts, in all and by kind of claim."""
    listed = list(judgements)
    by_kind: dict[str, dict[str, int]] = {}
    for kind in dict.fromkeys(j.claim.kind for j in listed):
        verdicts = Counter(j.verdict for j in listed if j.claim.kind == kind)
        by_kind[kind] = {
            "reproduced": verdicts["reproduced"],
            "not_reproduced": verdicts["not reproduced"],
            "not_testable": verdicts["not testable"],
        }
    return {
        "claims_reproduced": sum(k["reproduced"] for k in by_kind.values()),
        "claims_not_reproduced": sum(k["not_reproduced"] for k in by_kind.values()),
        "claims_not_testable": sum(k["not_testable"] for k in by_kind.values()),
        "claims_total": len(listed),
        "claims_by_kind": by_kind,
    }


def summarise(
    cells: Sequence[ComparedCell],
    judgements: Iterable[Judgement],
    held_out: Iterable[str] = (),
) -> dict[str, Any]:
    """Sum up a comparison.

    Parameters
    ----------
    cells : sequence of ComparedCell
        All cells, of both metrics.
    judgements : iterable of Judgement
        The ledger of claims.
    held_out : iterable of str
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
    return {
        "metric": "MSE",
        **nearness(filters),
        "per_model": {
            model: nearness([c for c in filters if c.model == model])
            for model in FILTERS
        },
        "orderings": orderings(filters),
        **_split(filters, set(held_out)),
        "without_inconsistent": {
            "without_no": nearness(not_refuted),
            "without_no_and_undecided": nearness(sure),
        },
        "rdgpi": nearness([cell for cell in mse if cell.model == "rdgpi"]),
        **claim_counts(judgements),
    }


def _split(cells: Sequence[ComparedCell], held_out: set[str]) -> dict[str, Any]:
    if not held_out:
        return {}
    return {
        "calibrated": nearness([c for c in cells if c.signal not in held_out]),
        "held_out": nearness([c for c in cells if c.signal in held_out]),
    }

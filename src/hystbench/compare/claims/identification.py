"""Measures of Algorithm 1 and of the thresholds and envelopes that it found."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from hystbench.compare.claims.claim import NotTestable, Numbers
from hystbench.compare.evidence import ClaimEvidence
from hystbench.published.equations import Envelope, gamma_left, gamma_right
from hystbench.record import FloatArray


def identified(evidence: ClaimEvidence) -> Mapping[str, Any]:
    """Give the identification.

    Raises
    ------
    NotTestable
        If it was not run.
    """
    if evidence.identification is None:
        raise NotTestable("not run: identification")
    return evidence.identification


def algorithm(evidence: ClaimEvidence) -> Numbers:
    """Measure what Algorithm 1 found: J over the iterations, thresholds, envelopes.

    Envelopes are compared as curves, for many a_j make the same loop.
    """
    found = identified(evidence)
    sums, epsilon, r = found["J"], found["epsilon"], found["thresholds"]
    steps = np.diff(r)
    text = evidence.text
    return {
        "reached": found["reached"],
        "iterations": len(sums),
        "epsilon": epsilon,
        "first": sums[0],
        "last": sums[-1],
        "limit": max(sums[0], epsilon),
        "thresholds": len(r),
        "weights": len(found["weights"]),
        "least_threshold": r[0],
        "step": steps.mean(),
        "uneven": float(np.ptp(steps) / steps.mean()),
        "apart": shape_difference(text.envelope, found["envelope"], text.amplitude_a),
        "re": found["relative_error"],
        "published_re": found["published_relative_error"],
    }


def shape_difference(wanted: Envelope, found: Envelope, limit: float) -> float:
    """Relative RMS that is left of both curves after one scale and one offset."""
    v: FloatArray = np.linspace(-limit, limit, 501)
    target, ours = (
        np.concatenate([gamma_left(v, e), gamma_right(v, e)]) for e in (wanted, found)
    )
    basis = np.column_stack([ours, np.ones_like(ours)])
    coefficients = np.linalg.lstsq(basis, target, rcond=None)[0]
    rest = target - basis @ coefficients
    return float(np.sqrt(np.mean(rest**2)) / np.std(target))


def two_envelopes(evidence: ClaimEvidence) -> Numbers:
    """Count the signals on which the filter is no worse with identified envelopes."""
    errors = evidence.envelope_errors
    both = [
        signal
        for signal, envelopes in errors
        if envelopes == "identified" and (signal, "published") in errors
    ]
    if not both:
        raise NotTestable("not run: the filter with identified and published envelopes")
    better = sum(
        math.isfinite(errors[s, "identified"])
        and errors[s, "identified"] <= errors[s, "published"]
        for s in both
    )
    return {"better": better, "both": len(both)}

"""Claims on Algorithm 1 and the envelopes it found."""

from __future__ import annotations

import math

import numpy as np

from hystbench.compare.claims.claim import Finding, NotTestable, claim_on
from hystbench.compare.evidence import Evidence, Identification
from hystbench.published.equations import Envelope, gamma_left, gamma_right
from hystbench.record import FloatArray

SAME_SHAPE = 0.05
"""Relative RMS difference below which two envelope pairs count as one shape."""


def identified(evidence: Evidence) -> Identification:
    """Give the identification.

    Raises
    ------
    NotTestable
        If it was not run.
    """
    if evidence.identification is None:
        raise NotTestable("not run: identification")
    return evidence.identification


@claim_on(
    "algorithm-converges",
    "'if J is less than tolerable error, then end the algorithm'",
    "Section 3.1, Algorithm 1, step 7",
    "result",
    "the stop at J < epsilon is reached",
    basis="built-in",
)
def algorithm_converges(evidence: Evidence) -> Finding:
    """See whether Algorithm 1 came to its end."""
    found = identified(evidence)
    return Finding(
        found.reached,
        f"J = {found.sums[-1]:.4g} after {len(found.sums)} iterations; tolerable "
        f"error {found.epsilon:.4g}",
    )


@claim_on(
    "identification-iterative",
    "weights and envelopes 'can be identified through minimization' of the sum of "
    "squared errors, iteratively",
    "Section 2.3, Eq. 11",
    "condition",
    "J falls over the iterations, or is below the tolerable error at the first",
    basis="built-in",
)
def identification_iterative(evidence: Evidence) -> Finding:
    """Follow J over the iterations."""
    found = identified(evidence)
    first, last = float(found.sums[0]), float(found.sums[-1])
    return Finding(
        last < first or last < found.epsilon,
        f"J goes from {first:.4g} to {last:.4g} in {len(found.sums)} iterations; "
        f"RE of the loop {found.relative_error:.4g}",
    )


@claim_on(
    "identified-envelopes",
    "the envelopes identified from the 1 Hz sine have the published parameters",
    "Section 4",
    "result",
    "up to one scale and one offset, which trade off with gain and weights, the "
    f"identified pair of curves is within {100 * SAME_SHAPE:.0f} % RMS of the "
    "published one",
    basis="built-in",
)
def identified_envelopes(evidence: Evidence) -> Finding:
    """Compare curves, for many a_j make the same loop."""
    found = identified(evidence)
    limit = evidence.text.amplitude_a
    apart = shape_difference(evidence.text.envelope, found.envelope, limit)
    return Finding(
        apart <= SAME_SHAPE,
        f"the curves differ by {100 * apart:.1f} %; RE of the loop "
        f"{found.relative_error:.4g} with ours and "
        f"{found.published_relative_error:.4g} with the published envelopes",
    )


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


@claim_on(
    "envelopes-serve-every-rate",
    "the operators identified at low frequency serve the filter at every rate",
    "Section 4",
    "result",
    "with identified envelopes the GPO-based filter's MSE is at most that with the "
    "published ones on at least half of the signals",
    basis="built-in",
)
def envelopes_serve_every_rate(evidence: Evidence) -> Finding:
    """Compare the two pairs of envelopes in the filter."""
    errors = evidence.envelope_errors
    both = [
        signal
        for signal, envelopes in errors
        if envelopes == "identified" and (signal, "published") in errors
    ]
    if not both:
        raise NotTestable("not run: the filter with identified and published envelopes")
    better = [
        s
        for s in both
        if math.isfinite(errors[s, "identified"])
        and errors[s, "identified"] <= errors[s, "published"]
    ]
    return Finding(
        2 * len(better) >= len(both),
        f"MSE is as small or smaller with identified envelopes on {len(better)} of "
        f"{len(both)} signals",
    )

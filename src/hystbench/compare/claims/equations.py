"""Claims on the printed equations of Sections 2 and 3.1."""

from __future__ import annotations

import numpy as np

from hystbench.compare.claims.claim import Finding, claim_on
from hystbench.compare.claims.identification import identified
from hystbench.compare.claims.operators import EXACT, sine
from hystbench.compare.evidence import Evidence
from hystbench.published.equations import (
    Envelope,
    gamma_left,
    gamma_right,
    generalized_play,
    generalized_play_eq12,
    thresholds,
)
from hystbench.record import FloatArray


def judge_extreme(evidence: Evidence, largest: bool) -> Finding:
    """Hold Eq. 7 or 8 as printed, and with v in place of gamma(v), against a run."""
    envelope, limit = evidence.text.envelope, evidence.text.amplitude_a
    v, r = sine(limit, 3), thresholds(evidence.text.filter_length, limit, envelope)
    run = generalized_play(v, r, envelope)
    extreme = run.max(axis=0) if largest else run.min(axis=0)
    gamma = gamma_right if largest else gamma_left
    pick = np.max if largest else np.min

    def formula(argument: float) -> FloatArray:
        at = np.array([argument])
        rising, falling = gamma_right(at, envelope), gamma_left(at, envelope)
        inner = np.minimum(falling + r, run[0])
        return np.asarray(np.maximum(rising - r, inner))

    height = float(np.ptp(run, axis=0).max())
    printed = np.abs(formula(float(pick(gamma(v, envelope)))) - extreme).max() / height
    with_v = np.abs(formula(float(pick(v))) - extreme).max() / height
    return Finding(
        bool(printed <= 1e-6),
        f"under a sine it is off by {100 * printed:.2g} % of the largest loop's "
        f"height; with v in place of gamma(v) it is off by {100 * with_v:.2g} %",
    )


EXTREME_READING = (
    "as printed, with the published envelopes, on a sine of the paper's amplitude"
)


@claim_on(
    "eq7",
    "the largest output of a generalized play is f(max gamma_r(v), w(0))",
    "Section 2.2, Eq. 7",
    "notation",
    EXTREME_READING,
)
def eq7(evidence: Evidence) -> Finding:
    """Test the maximum."""
    return judge_extreme(evidence, largest=True)


@claim_on(
    "eq8",
    "the smallest output of a generalized play is f(min gamma_l(v), w(0))",
    "Section 2.2, Eq. 8",
    "notation",
    EXTREME_READING,
)
def eq8(evidence: Evidence) -> Finding:
    """Test the minimum."""
    return judge_extreme(evidence, largest=False)


@claim_on(
    "eq12",
    "'Based on Equations (3) and (4), the GPOs can be rewritten as' Eq. 12",
    "Section 3.1, Eq. 12",
    "theory",
    "same output from rest, with the published envelopes, on three cycles of a sine",
)
def eq12(evidence: Evidence) -> Finding:
    """Run both forms along a sine."""
    envelope, limit = evidence.text.envelope, evidence.text.amplitude_a
    v, r = sine(limit, 3), thresholds(evidence.text.filter_length, limit, envelope)
    apart = np.abs(
        generalized_play(v, r, envelope) - generalized_play_eq12(v, r, envelope)
    ).max(axis=1)
    later = apart[len(v) // 3 :].max()
    return Finding(
        bool(apart.max() <= EXACT),
        f"they differ by at most {apart.max():.2g} in the first cycle and "
        f"{later:.2g} after it",
    )


@claim_on(
    "eq14",
    "under a quasi-static input the filter 'can be approximated as a GPI model'",
    "Section 3.1, Eq. 14",
    "theory",
    "with the identified operators and weights: RMS difference at 1 Hz and 10 kHz "
    "sampling, relative to the RMS output, below the smallest RE of Table 1 and "
    "below that at 100 Hz",
)
def eq14(evidence: Evidence) -> Finding:
    """Run the filter with its delay line and without, slowly and fast."""
    found = identified(evidence)
    rate, limit = evidence.text.sampling_hz, evidence.text.amplitude_a
    slow, fast = (
        delay_line_difference(
            sine(limit, 2, round(rate / hz)),
            found.thresholds,
            found.weights,
            found.envelope,
        )
        for hz in (1.0, 100.0)
    )
    smallest = min(pair.re.value for pair in evidence.published if pair.table == 1)
    return Finding(
        slow < min(smallest, fast),
        f"the delay line changes the output by {100 * slow:.3g} % at 1 Hz and "
        f"{100 * fast:.3g} % at 100 Hz; the smallest RE of Table 1 is "
        f"{100 * smallest:.3g} %",
    )


def delay_line_difference(
    v: FloatArray, r: FloatArray, weights: FloatArray, envelope: Envelope
) -> float:
    """Relative RMS of sum w_i (H_i[x(k-i)] - H_i[x(k)]), Eq. 14, in steady state."""
    outputs = generalized_play(v, r, envelope)
    half = len(v) // 2
    static = outputs[half:] @ weights
    delayed = sum(w * outputs[half - i : len(v) - i, i] for i, w in enumerate(weights))
    return float(np.sqrt(np.mean((delayed - static) ** 2) / np.mean(static**2)))


@claim_on(
    "eq10",
    "the thresholds 'can be chosen to be equal intervals'",
    "Section 2.3, Eq. 10",
    "condition",
    "N + 1 identified thresholds rise in equal steps from zero, one weight each",
    basis="built-in",
)
def eq10(evidence: Evidence) -> Finding:
    """Test the thresholds of the identification."""
    found = identified(evidence)
    r, weights = found.thresholds, found.weights
    steps = np.diff(r)
    uneven = float(np.ptp(steps) / steps.mean())
    return Finding(
        len(r) == len(weights) and abs(r[0]) <= EXACT and 0 <= uneven <= 1e-9,
        f"{len(r)} thresholds and {len(weights)} weights from {r[0]:.2g}; steps of "
        f"{steps.mean():.4g} differ by {uneven:.1e} of a step",
    )

"""Claims on the operators and envelopes of Sections 1 and 2."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hystbench.compare.claims.claim import (
    Claim,
    Finding,
    claim_on,
    untestable,
)
from hystbench.compare.claims.identification import identified
from hystbench.compare.evidence import Evidence
from hystbench.published.discrepancies import crossings
from hystbench.published.equations import (
    Envelope,
    gamma_left,
    gamma_right,
    generalized_play,
    play,
    thresholds,
)
from hystbench.record import FloatArray

EXACT = 1e-12
"""Largest difference that rounding in double precision explains here."""

Operator = Callable[[FloatArray, FloatArray], FloatArray]


def sine(amplitude: float, cycles: int, samples: int = 400) -> FloatArray:
    """Make a sine of so many cycles and samples a cycle, from zero."""
    phase = 2 * np.pi * np.arange(cycles * samples + 1) / samples
    return amplitude * np.sin(phase)


def plays(evidence: Evidence) -> FloatArray:
    """Give thresholds of plays: 31 across the amplitude of the sines."""
    count = evidence.text.filter_length + 1
    return np.arange(count) / count * evidence.text.amplitude_a


def judge_rate_independence(
    operator: Operator, v: FloatArray, r: FloatArray
) -> Finding:
    """Run an operator along one path at two speeds; also bound its steps."""
    once = operator(v, r)
    slow = np.interp(np.arange(2 * len(v) - 1) / 2, np.arange(len(v)), v)
    twice = operator(slow, r)[::2]
    apart = float(np.abs(once - twice).max())
    steps = np.abs(np.diff(once, axis=0)) - np.abs(np.diff(v))[:, None]
    excess = float(steps.max())
    return Finding(
        apart <= EXACT and excess <= EXACT,
        f"run at half the speed it differs by at most {apart:.1e}; no step of its "
        f"output exceeds the step of its input by more than {max(excess, 0.0):.1e}",
    )


def judge_symmetry(operator: Operator, v: FloatArray, r: FloatArray) -> Finding:
    """Compare the loop with its own mirror image through the centre."""
    asymmetry = loop_asymmetry(operator, v, r)
    return Finding(
        asymmetry <= 1e-9,
        f"rising and falling branch differ from each other's mirror image by "
        f"{asymmetry:.1e} of the loop's height",
    )


def loop_asymmetry(operator: Operator, v: FloatArray, r: FloatArray) -> float:
    """Largest |F(t) - c + F(t + half a period) - c| of a steady loop, per height."""
    period = (len(v) - 1) // 3
    loop = operator(v, r)[-period:].mean(axis=1)
    centred = loop - (loop.max() + loop.min()) / 2
    return float(np.abs(centred + np.roll(centred, period // 2)).max() / np.ptp(loop))


@claim_on(
    "play-rate-independent",
    "the play operator 'is a rate-independent and continuous hysteresis operator'",
    "Section 2.1, Eqs. 1-2",
    "theory",
    "the same path at half the speed gives the same output; the output never moves "
    "farther than the input",
)
def play_rate_independent(evidence: Evidence) -> Finding:
    """Run plays along a sine at two speeds."""
    return judge_rate_independence(
        play, sine(evidence.text.amplitude_a, 3), plays(evidence)
    )


@claim_on(
    "play-symmetric",
    "'The classic Prandtl-Ishlinskii model is limited to symmetric hysteresis loops'",
    "Section 2.2",
    "theory",
    "a steady loop of plays under a sine is its own mirror image",
)
def play_symmetric(evidence: Evidence) -> Finding:
    """Mirror the loop of a Prandtl-Ishlinskii model of equal weights."""
    return judge_symmetry(play, sine(evidence.text.amplitude_a, 3), plays(evidence))


@claim_on(
    "gpo-asymmetric",
    "because of its operators the GPO-based filter can describe hysteresis 'with "
    "asymmetric and saturation properties'",
    "Section 1",
    "theory",
    "with the published envelopes a steady loop differs from its mirror image by "
    "more than 1 % of its height, and the slope of each envelope falls at an end of "
    "the range below 90 % of its maximum",
)
def gpo_asymmetric(evidence: Evidence) -> Finding:
    """Mirror the loop of generalized plays of equal weights."""
    envelope, limit = evidence.text.envelope, evidence.text.amplitude_a
    r = thresholds(evidence.text.filter_length, limit, envelope)
    asymmetry = loop_asymmetry(
        lambda v, r: generalized_play(v, r, envelope), sine(limit, 3), r
    )
    v = np.linspace(-limit, limit, 2001)
    flat = [
        float(min(slope[0], slope[-1]) / slope.max())
        for slope in (np.gradient(gamma(v, envelope), v) for gamma in _GAMMAS)
    ]
    return Finding(
        asymmetry > 0.01 and max(flat) < 0.9,
        f"the loop differs from its mirror image by {100 * asymmetry:.0f} % of its "
        f"height; the slope of gamma_l falls to {100 * flat[0]:.0f} % and that of "
        f"gamma_r to {100 * flat[1]:.0f} % of its maximum",
    )


_GAMMAS = (gamma_left, gamma_right)


def judge_non_decreasing(envelope: Envelope, limit: float) -> Finding:
    """Test the slope of both envelopes on the working range."""
    v = np.linspace(-limit, limit, 2001)
    slopes = [float(np.diff(gamma(v, envelope)).min()) for gamma in _GAMMAS]
    return Finding(
        min(slopes) >= 0,
        f"on |u| <= {limit:g} A the smallest steps of gamma_l and gamma_r over "
        f"{v[1] - v[0]:.2g} A are {slopes[0]:.2g} and {slopes[1]:.2g}",
    )


def judge_order(envelope: Envelope, limit: float) -> Finding:
    """Test gamma_l > gamma_r on the working range."""
    found = crossings(dict(envelope), -limit, limit)
    if not found:
        return Finding(True, f"gamma_l > gamma_r on all of |u| <= {limit:g} A")
    start, end, excess = found[0]
    return Finding(
        False,
        f"gamma_r >= gamma_l for {start:.3f} < u < {end:.3f} A, by at most "
        f"{excess:.1e}",
    )


def _non_decreasing(evidence: Evidence) -> Finding:
    return judge_non_decreasing(evidence.text.envelope, evidence.text.amplitude_a)


def _order(evidence: Evidence) -> Finding:
    return judge_order(evidence.text.envelope, evidence.text.amplitude_a)


@claim_on(
    "envelopes-non-decreasing",
    "the envelopes are 'continuous non-decreasing functions'",
    "Section 2.2, Eqs. 5-6",
    "condition",
    "ours: the identified envelopes, which the search holds to it; theirs: the "
    "published ones",
    theirs=_non_decreasing,
    basis="built-in",
)
def envelopes_non_decreasing(evidence: Evidence) -> Finding:
    """Test the identified envelopes."""
    return judge_non_decreasing(
        identified(evidence).envelope, evidence.text.amplitude_a
    )


@claim_on(
    "envelopes-ordered",
    "'gamma_l > gamma_r'",
    "Section 2.2",
    "condition",
    "ours: the identified envelopes, which the search holds to it; theirs: the "
    "published ones",
    theirs=_order,
    basis="built-in",
)
def envelopes_ordered(evidence: Evidence) -> Finding:
    """Test the identified envelopes."""
    return judge_order(identified(evidence).envelope, evidence.text.amplitude_a)


backlash_is_pi: Claim = untestable(
    "backlash-is-pi",
    "the backlash filter 'constitutes a Prandtl-Ishlinskii model' with adaptive "
    "weights",
    "Section 1",
    "theory",
    "a definition; the paper does not say whether its backlashes take x(k) or the "
    "tapped delay line",
)

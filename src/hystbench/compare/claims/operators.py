"""Measures of operators, envelopes and equations, and of what Algorithm 1 found."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from hystbench.compare.claims.claim import NotTestable, Numbers
from hystbench.compare.runs import ClaimEvidence
from hystbench.published.discrepancies import crossings
from hystbench.published.equations import (
    Envelope,
    gamma_left,
    gamma_right,
    generalized_play,
    generalized_play_eq12,
    play,
    thresholds,
)
from hystbench.record import FloatArray

Operator = Callable[[FloatArray, FloatArray], FloatArray]


def sine(amplitude: float, cycles: int, samples: int = 400) -> FloatArray:
    """Make a sine of so many cycles and samples a cycle, from zero."""
    phase = 2 * np.pi * np.arange(cycles * samples + 1) / samples
    return amplitude * np.sin(phase)


def of_play(evidence: ClaimEvidence) -> Numbers:
    """Run 31 plays along a sine at two speeds, and mirror the loop of equal weights."""
    count, limit = evidence.text.filter_length + 1, evidence.text.amplitude_a
    v, r = sine(limit, 3), np.arange(count) / count * limit
    return {**at_two_speeds(play, v, r), "asymmetry": loop_asymmetry(play(v, r))}


def at_two_speeds(operator: Operator, v: FloatArray, r: FloatArray) -> Numbers:
    """Run an operator along one path at two speeds; also bound its steps."""
    once = operator(v, r)
    slow = np.interp(np.arange(2 * len(v) - 1) / 2, np.arange(len(v)), v)
    apart = float(np.abs(once - operator(slow, r)[::2]).max())
    steps = np.abs(np.diff(once, axis=0)) - np.abs(np.diff(v))[:, None]
    return {"apart": apart, "excess": max(float(steps.max()), 0.0)}


def loop_asymmetry(run: FloatArray) -> float:
    """Largest |F(t) - c + F(t + half a period) - c| of a steady loop, per height.

    The loop is the last of three, of all operators with equal weights.
    """
    period = (len(run) - 1) // 3
    loop = run[-period:].mean(axis=1)
    centred = loop - (loop.max() + loop.min()) / 2
    return float(np.abs(centred + np.roll(centred, period // 2)).max() / np.ptp(loop))


def of_generalized_play(evidence: ClaimEvidence) -> Numbers:
    """Run generalized plays along a sine: by Eq. 4, Eq. 12, and beside Eqs. 7 and 8.

    The loop of equal weights is mirrored, and the envelopes' slopes at the ends of the
    range are taken.
    """
    limit, envelope = evidence.text.amplitude_a, evidence.text.envelope
    v, r = sine(limit, 3), thresholds(evidence.text.filter_length, limit, envelope)
    run = generalized_play(v, r, envelope)
    apart = np.abs(run - generalized_play_eq12(v, r, envelope)).max(axis=1)
    found = {
        "asymmetry": loop_asymmetry(run),
        "apart": apart.max(),
        "later": apart[len(v) // 3 :].max(),
    }
    height = float(np.ptp(run, axis=0).max())

    def off(argument: float, reached: FloatArray) -> float:
        at = np.array([argument])
        inner = np.minimum(gamma_left(at, envelope) + r, run[0])
        formula = np.maximum(gamma_right(at, envelope) - r, inner)
        return float(np.abs(formula - reached).max() / height)

    u = np.linspace(-limit, limit, 2001)
    for side, gamma, pick in (
        ("left", gamma_left, np.min),
        ("right", gamma_right, np.max),
    ):
        slope = np.gradient(gamma(u, envelope), u)
        reached = pick(run, axis=0)
        found[side] = float(min(slope[0], slope[-1]) / slope.max())
        # gamma_l makes the smallest output, gamma_r the largest.
        found[f"{side}_printed"] = off(float(pick(gamma(v, envelope))), reached)
        found[f"{side}_with_v"] = off(float(pick(v)), reached)
    return found


def _envelope(evidence: ClaimEvidence, of: str) -> Envelope:
    if of == "published":
        return evidence.text.envelope
    envelope: Envelope = identified(evidence)["envelope"]
    return envelope


def envelopes(evidence: ClaimEvidence, of: str) -> Numbers:
    """Find the smallest steps of both envelopes, and where gamma_r >= gamma_l."""
    envelope, limit = _envelope(evidence, of), evidence.text.amplitude_a
    v = np.linspace(-limit, limit, 2001)
    left, right = (
        float(np.diff(gamma(v, envelope)).min()) for gamma in (gamma_left, gamma_right)
    )
    found = crossings(dict(envelope), -limit, limit)
    start, end, most = found[0] if found else (limit, limit, 0.0)
    return {
        "limit": limit,
        "step": v[1] - v[0],
        "left": left,
        "right": right,
        "crossings": len(found),
        "start": start,
        "end": end,
        "excess": most,
    }


def delay_line(evidence: ClaimEvidence) -> Numbers:
    """Run the filter with its delay line and without, slowly and fast."""
    found = identified(evidence)
    rate, limit = evidence.text.sampling_hz, evidence.text.amplitude_a
    slow, fast = (
        delay_line_difference(
            sine(limit, 2, round(rate / hz)),
            np.array(found["thresholds"]),
            np.array(found["weights"]),
            found["envelope"],
        )
        for hz in (1.0, 100.0)
    )
    smallest = min(pair.re.value for pair in evidence.published if pair.table == 1)
    return {"slow": slow, "fast": fast, "smallest": smallest}


def delay_line_difference(
    v: FloatArray, r: FloatArray, weights: FloatArray, envelope: Envelope
) -> float:
    """Relative RMS of sum w_i (H_i[x(k-i)] - H_i[x(k)]), Eq. 14, in steady state."""
    outputs = generalized_play(v, r, envelope)
    half = len(v) // 2
    static = outputs[half:] @ weights
    delayed = sum(w * outputs[half - i : len(v) - i, i] for i, w in enumerate(weights))
    return float(np.sqrt(np.mean((delayed - static) ** 2) / np.mean(static**2)))


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

"""What a form explains of the residual, what it costs, and what chance would give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft, special

from hystbench.gap.locate.samples import Samples
from hystbench.record import FloatArray

# The residual counts as this many independent facts in all, however finely sampled:
# an error of a model is not white (docs/gap-method.md, "The score").
FACTS = 300
# What a form must save, in nats, to be read beside a wrong shape of the base's loop and
# not as a part of that shape.
BESIDE = 20.0
# Bins over which the spectrum of what is left is smoothed.
SMOOTH = 17


@dataclass(frozen=True)
class Form:
    """A fitted form: some function of an axis, with its number of free parameters.

    Parameters
    ----------
    fitted : ndarray
        What the form says of the residual, in its unit; empty where the form was
        fitted in the frequency domain.
    explained : float
        Mean square that leaves the residual with it.
    freedom : int
    saved : float
        Description length saved, in nats.
    """

    fitted: FloatArray
    explained: float
    freedom: int
    saved: float


def saved(samples: Samples, explained: float, freedom: int) -> float:
    """Give the description length that a form saves, in nats.

    ``facts / 2 * log(power before / power after) - freedom / 2 * log(facts)``: the
    Bayesian information criterion with a number of facts that does not grow with the
    sampling rate. Power after is never less than the noise: fitting noise saves
    nothing.
    """
    after = max(samples.power - explained, samples.noise, 1e-300)
    before = max(samples.power, after)
    facts = min(FACTS, len(samples.residual))
    return float(
        0.5 * facts * np.log(before / after) - 0.5 * freedom * np.log(max(facts, 2))
    )


def fit_form(
    samples: Samples, columns: Sequence[FloatArray], searched: int = 0
) -> Form:
    """Fit columns to the residual by least squares, alone and beside a wrong loop.

    A base is never exact, and a wrong shape of its loop hides what else is wrong. So a
    form that explains half of the gap is also fitted together with what such a shape
    could leave (:attr:`Samples.shapes`), all of it charged. It is ranked by that if it
    saves more than alone and, by a margin, more than the shape does without it.

    Parameters
    ----------
    samples : Samples
    columns : sequence of ndarray, shape (n,)
    searched : int
        Parameters inside the columns that were searched for, counted as freedom.

    Returns
    -------
    Form
        ``explained`` is that of the columns alone; ``fitted`` the columns' part.
    """
    design = np.stack(columns)
    gram, moments = design @ design.T, design @ samples.residual
    weights, rank = _solve(gram, moments)
    fitted = weights @ design
    explained = samples.power - float(np.mean((samples.residual - fitted) ** 2))
    freedom = rank + searched
    alone = saved(samples, explained, freedom)
    if explained < 0.5 * samples.gap_power:
        return Form(fitted, explained, freedom, alone)
    # The same beside a wrong shape of the loop, whose directions are taken out of the
    # columns and of the residual by their products alone.
    along = design @ samples.shapes.T
    extra_weights, extra_rank = _solve(
        gram - along @ along.T,
        moments - along @ samples.shaped,
        np.sqrt(np.diag(gram)),
    )
    gained = extra_weights @ (moments - along @ samples.shaped)
    both = float(gained + samples.shaped @ samples.shaped) / len(samples.residual)
    count = extra_rank + searched + len(samples.shapes)
    beside = saved(samples, both, count) - BESIDE
    shape = float(samples.shaped @ samples.shaped) / len(samples.residual)
    if beside <= max(alone, saved(samples, shape, len(samples.shapes))):
        return Form(fitted, explained, freedom, alone)
    own = extra_weights @ design
    return Form(own, explained, freedom, beside)


def fit_by_record(
    samples: Samples, columns: Sequence[FloatArray], searched: int = 0
) -> Form:
    """Fit columns with coefficients of each record's own."""
    design = np.stack(columns)
    fitted = np.empty_like(samples.residual)
    freedom = searched
    for part in samples.slices:
        own = design[:, part]
        weights, rank = _solve(own @ own.T, own @ samples.residual[part])
        fitted[part] = weights @ own
        freedom += rank
    explained = samples.power - float(np.mean((samples.residual - fitted) ** 2))
    return Form(fitted, explained, freedom, saved(samples, explained, freedom))


def _solve(
    gram: FloatArray, moments: FloatArray, scale: FloatArray | None = None
) -> tuple[FloatArray, int]:
    """Solve normal equations that may be singular; tell their rank.

    ``scale`` holds the columns' norms before anything was taken out of them: what is
    left of a column that lay in the span is rounding, not a direction.
    """
    if scale is None:
        scale = np.sqrt(np.diag(gram))
    scale = np.where(scale > 0, scale, np.inf)
    values, vectors = np.linalg.eigh(gram / np.outer(scale, scale))
    kept = values > 1e-9 * max(float(values[-1]), 1.0)
    basis = vectors[:, kept]
    return basis @ (basis.T @ (moments / scale) / values[kept]) / scale, int(kept.sum())


def best(forms: Sequence[Form]) -> Form:
    """Give the form that saves most."""
    return max(forms, key=lambda form: form.saved)


def fitted_p_value(samples: Samples, form: Form) -> float:
    """Give the F test's p-value of a form without searched parameters."""
    rest = samples.residual - form.fitted
    count = effective_count(samples, rest, form.fitted)
    share = form.explained / max(samples.power, 1e-300)
    return f_test(share, form.freedom, count)


def f_test(share: float, freedom: float, count: float) -> float:
    """Give the p-value of a share of variance explained.

    ``F = (share / freedom) / ((1 - share) / (count - freedom))`` with ``count`` the
    effective number of samples. With fewer samples than parameters nothing is
    significant.
    """
    left = count - freedom
    if left < 1:
        return 1.0
    share = float(np.clip(share, 0.0, 1.0))
    # The survival function of F through the incomplete beta function.
    return float(special.betainc(left / 2, freedom / 2, 1.0 - share))


def effective_count(samples: Samples, rest: FloatArray, fitted: FloatArray) -> float:
    """Count the independent samples among autocorrelated ones.

    A fit picks up the rest where both have power. With the spectra S of the rest,
    smoothed over its neighbours, and F of what was fitted, the count is
    ``n mean(S) mean(F) / mean(S F)``: n for a white rest, few for a slow fit to a slow
    rest (Bartlett 1946, in the frequency domain). It is never more than n.
    """
    rests, fits = [], []
    for part in samples.slices:
        power = np.abs(fft.rfft(rest[part])) ** 2
        window = np.ones(min(SMOOTH, len(power)))
        covered = np.convolve(np.ones_like(power), window, mode="same")
        rests.append(np.convolve(power, window, mode="same") / covered)
        fits.append(np.abs(fft.rfft(fitted[part])) ** 2)
    s, f = np.concatenate(rests), np.concatenate(fits)
    return colour_count(len(rest), s, f, np.ones_like(s))


def colour_count(
    n: int, rest: FloatArray, fitted: FloatArray, width: FloatArray
) -> float:
    """Give ``n mean(S) mean(F) / mean(S F)`` over bins of a width, n at most."""
    means = float(np.sum(rest * width)) * float(np.sum(fitted * width))
    shared = float(np.sum(rest * fitted * width)) * float(np.sum(width))
    return n * min(1.0, means / shared) if shared > 0 else float(n)


def hats(values: FloatArray, knots: FloatArray) -> list[FloatArray]:
    """Give the piecewise-linear basis over knots; its functions add to one."""
    identity = np.eye(len(knots))
    return [np.interp(values, knots, row) for row in identity]


def narrowest(
    axis: FloatArray, weights: FloatArray, hold: float = 0.8, bins: int = 50
) -> tuple[float, float]:
    """Give the range of fewest samples that holds most of the weight.

    Parameters
    ----------
    axis, weights : ndarray, shape (n,)
    hold : float
        Share of the weight that the range must hold.
    bins : int
        Bins of as many samples each.
    """
    order = np.argsort(axis)
    starts = np.unique(np.linspace(0, len(axis), bins + 1)[:-1].astype(np.int64))
    held = np.add.reduceat(weights[order], starts)
    first, last = narrowest_bins(held, hold)
    end = starts[last + 1] if last + 1 < len(starts) else len(axis) - 1
    return float(axis[order[starts[first]]]), float(axis[order[end]])


def narrowest_bins(held: FloatArray, hold: float = 0.8) -> tuple[int, int]:
    """Give the first and the last of the fewest neighbours that hold most."""
    total = np.concatenate([[0.0], np.cumsum(held)])
    wanted = total[:-1] + hold * total[-1]
    ends = np.searchsorted(total, wanted - 1e-12 * total[-1])
    possible = ends < len(total)
    starts = np.flatnonzero(possible)
    # Among ranges of one width, the one that holds most.
    cost = (
        ends[starts]
        - starts
        - (total[ends[starts]] - total[starts]) / (2 * max(total[-1], 1e-300))
    )
    best_start = int(starts[np.argmin(cost)])
    return best_start, max(int(ends[best_start]) - 1, best_start)

"""A form: what it explains of the residual, and the view that it gives.

A view is one way in which an engineer reads where the gap is.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import fft, special

from hystbench.gap.locate.picture import ViewPicture
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.view_kinds import ViewKind
from hystbench.record import FloatArray
from hystbench.sentences import percent

FACTS = 300
"""The residual counts as so many independent facts, however finely sampled: an error of
a model is not white (docs/gap-method.md, "The score")."""
HELD_SHARE = 0.8
"""Share of what a view explains that its range holds."""
RANGE_BINS = 50
"""Bins of as many samples each, in which the narrowest range is looked for."""
SMOOTHED_BINS = 17
"""Bins over which the spectrum of what is left is smoothed."""
LEAST_SINGULAR = 1e-5
"""Least singular value of columns of one length, as a share of the largest: a smaller
one counts as zero."""
SIGNIFICANT = 0.01
"""Largest p-value at which a part of a view is told as there."""
LEAST_SHARE = 0.01
"""Least share of the gap's power at which a part of a view is told at all."""


@dataclass(frozen=True)
class View:
    """Where the gap lies, in one kind of view."""

    view: ViewKind
    axis: str
    """What ``start`` and ``end`` are values of."""
    start: float | str
    end: float | str
    """The narrowest range that holds four fifths of what this view explains, in
    ``unit``; of branches and records, the names of the first and the last."""
    unit: str
    share_of_gap_power: float
    """Power that this view explains over the power of the gap above the noise, from 0
    to 1. The shares of several views may add to more than 1."""
    p_value: float
    """How often a residual without this structure, but of the same colour, would look
    as much like it."""
    sentence: str
    """The same in words."""
    saved: float
    """Description length that it saves: see :func:`hystbench.gap.locate.locate`."""
    named: bool = False
    """Whether it shows what a named effect adds."""
    pictures: tuple[ViewPicture, ...] = ()
    kinds: tuple[str, ...] = ()
    """How modes move with the level, in the view by level."""

    def to_mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``where``."""
        return {
            "view": self.view,
            "axis": self.axis,
            "from": self.start,
            "to": self.end,
            "unit": self.unit,
            "share_of_gap_power": self.share_of_gap_power,
            "p_value": self.p_value,
            "sentence": self.sentence,
        }


@dataclass(frozen=True)
class FittedForm:
    """A fitted form: some function of an axis, with its number of free parameters."""

    words: str
    """What it is, behind "of the gap is"."""
    fitted: FloatArray
    """Shape (n,). What the form says of the residual, in its unit."""
    explained: float
    """Mean square that leaves the residual with it."""
    freedom: float
    saved: float
    """Description length saved, in nats."""
    share: float
    """Share of the gap's power, what noise buys taken off."""
    weights: FloatArray
    """Shape (columns,). Of the last record, where each has its own."""
    added: tuple[FloatArray, ...] = ()
    """What a named effect adds to each record; none of a form of the view's own."""
    p_value: float = 1.0
    """How often a residual without this structure, but of the same colour, would look
    as much like it."""

    @property
    def named(self) -> bool:
        """Whether it is what a named effect adds."""
        return bool(self.added)

    def seen(
        self,
        view: ViewKind,
        axis: str,
        ends: tuple[float, float] | tuple[str, str],
        unit: str,
        told: str,
        *pictures: ViewPicture,
    ) -> View:
        """Give the view that it tells.

        Its range has two ``ends``; behind "so much of the gap" stands what is ``told``.
        """
        return View(
            view=view,
            axis=axis,
            start=ends[0],
            end=ends[1],
            unit=unit,
            share_of_gap_power=self.share,
            p_value=self.p_value,
            sentence=f"{percent(self.share)} of the gap {told}",
            saved=self.saved,
            named=self.named,
            pictures=pictures,
        )


def saved(samples: ViewSamples, explained: float, freedom: float) -> float:
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
    samples: ViewSamples,
    words: str,
    columns: Sequence[FloatArray],
    searched: float = 0,
    by_record: bool = False,
) -> FittedForm:
    """Fit columns to the residual by least squares.

    Parameters
    ----------
    samples : ViewSamples
    words : str
    columns : sequence of ndarray, shape (n,)
    searched : float
        Parameters inside the columns that were searched for, counted as freedom.
    by_record : bool
        Whether each record has coefficients of its own.
    """
    design = np.array(columns)
    fitted = np.empty_like(samples.residual)
    freedom = searched
    for part in samples.kept.slices if by_record else (slice(None),):
        weights, rank = _least_squares(design[:, part], samples.residual[part])
        fitted[part] = weights @ design[:, part]
        freedom += rank
    explained = samples.power - float(np.mean((samples.residual - fitted) ** 2))
    gained = saved(samples, explained, freedom)
    share = samples.share(explained, freedom)
    return FittedForm(words, fitted, explained, freedom, gained, share, weights)


def _least_squares(rows: FloatArray, wanted: FloatArray) -> tuple[FloatArray, int]:
    """Give the weights of rows that come nearest, the least of them, and their rank."""
    gram = rows @ rows.T
    size = np.sqrt(gram.diagonal())
    size = np.where(size > 0, size, 1.0)
    squares, vectors = np.linalg.eigh(gram / np.outer(size, size))
    there = squares > max(LEAST_SINGULAR**2 * squares[-1], 0.0)
    vectors = vectors[:, there]
    along = vectors.T @ (rows @ wanted / size) / squares[there]
    return vectors @ along / size, int(there.sum())


def named_or(
    samples: ViewSamples,
    view: ViewKind,
    forms: Sequence[FittedForm],
    tests: Sequence[FittedForm] = (),
) -> FittedForm:
    """Give what named effects add in a view; without any the best form of its own.

    Parameters
    ----------
    samples : ViewSamples
    view : str
    forms : sequence of FittedForm
        The view's own.
    tests : sequence of FittedForm
        Whose p-value counts where no effect is named, none of them with a searched
        parameter; by default the forms.
    """
    named = [
        replace(
            fit_form(samples, item.words, [column], item.freedom - 1),
            added=item.added,
        )
        for item in samples.contributions
        if item.view == view
        for column in [samples.thinned(item.added)]
    ]
    found = max(named or forms, key=lambda form: form.saved)
    tested = [found] if named else tests or forms
    # The least of several is multiplied by their number.
    chance = len(tested) * min(_p_value(samples, one) for one in tested)
    return replace(found, p_value=min(1.0, chance))


def _p_value(samples: ViewSamples, form: FittedForm) -> float:
    """Give the F test's p-value, for as many samples as are independent."""
    rest = samples.residual - form.fitted
    count = effective_count(samples.kept.slices, rest, form.fitted)
    share = form.explained / max(samples.power, 1e-300)
    return f_test(share, form.freedom, count)


def f_test(share: float, freedom: float, count: float) -> float:
    """Give the p-value of a share of variance explained.

    ``F = (share / freedom) / ((1 - share) / (count - freedom))`` with ``count`` the
    effective number of samples. With fewer samples than parameters nothing is
    significant.
    """
    left = count - freedom
    if left < 1 or freedom <= 0:
        return 1.0
    # The survival function of F through the incomplete beta function.
    return float(special.betainc(left / 2, freedom / 2, np.clip(1.0 - share, 0.0, 1.0)))


def effective_count(
    slices: Sequence[slice], rest: FloatArray, fitted: FloatArray
) -> float:
    """Count the independent samples among autocorrelated ones.

    A fit picks up the rest where both have power. With the spectra S of the rest,
    smoothed over its neighbours, and F of what was fitted, the count is
    ``n mean(S) mean(F) / mean(S F)``: n for a white rest, few for a slow fit to a slow
    rest (Bartlett 1946, in the frequency domain). It is never more than n.
    """
    rests, fits = [], []
    for part in slices:
        power = np.abs(fft.rfft(rest[part])) ** 2
        window = np.ones(min(SMOOTHED_BINS, len(power)))
        covered = np.convolve(np.ones_like(power), window, mode="same")
        rests.append(np.convolve(power, window, mode="same") / covered)
        fits.append(np.abs(fft.rfft(fitted[part])) ** 2)
    s, f = np.concatenate(rests), np.concatenate(fits)
    shared = float(np.mean(s * f))
    return len(rest) * min(1.0, float(s.mean() * f.mean()) / shared if shared else 1.0)


def hats(values: FloatArray, knots: int) -> list[FloatArray]:
    """Give the piecewise-linear basis over evenly spread knots; it adds to one."""
    low, high = float(np.min(values)), float(np.max(values))
    places = np.linspace(low, high if high > low else low + 1.0, knots)
    return [np.interp(values, places, row) for row in np.eye(knots)]


def narrowest(axis: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Give the range of fewest samples that holds most of the weight.

    Parameters
    ----------
    axis, weights : ndarray, shape (n,)
    """
    order = np.argsort(axis)
    starts = np.unique(np.linspace(0, len(axis), RANGE_BINS + 1)[:-1].astype(np.int64))
    first, last = narrowest_bins(np.add.reduceat(weights[order], starts))
    end = starts[last + 1] if last + 1 < len(starts) else len(axis) - 1
    return float(axis[order[starts[first]]]), float(axis[order[end]])


def narrowest_bins(held: FloatArray) -> tuple[int, int]:
    """Give the first and the last of the fewest neighbours that hold most."""
    sums = np.concatenate([[0.0], np.cumsum(held)])
    wanted = (HELD_SHARE - 1e-12) * sums[-1]

    def most(count: int) -> float:
        return float(np.max(sums[count:] - sums[:-count]))

    count = 1 + bisect_left(range(1, len(held)), wanted, key=most)
    first = int(np.argmax(sums[count:] - sums[:-count]))
    return first, first + count - 1

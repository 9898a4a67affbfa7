"""Orders of a linear base: fitted to the records, and judged on folds of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TypeVar

import numpy as np

from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.starts import plainest_start, possible_starts
from hystbench.cores import each
from hystbench.gap.bases.output_error import OutputError, own_columns
from hystbench.gap.bases.poles import lasting_ones
from hystbench.gap.bases.spectral import (
    Ratio,
    Spectra,
    fit_ratio,
    with_a_mode,
    with_poles,
)
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.first_state import with_state_of
from hystbench.gap.records.folds import Fold, make_folds
from hystbench.gap.records.scored_samples import without
from hystbench.gap.thresholds import (
    ANOTHER_MODE,
    LOOSE,
    NUMBER_PAYS,
    TIMING_PAYS,
)
from hystbench.record import ComplexArray, FloatArray, Mask

#: Highest order that is tried, of all poles at once, and with modes added one by one.
HIGHEST = 6
HIGHEST_WITH_MODES = 20
#: Static stiffness of a free mass over what brakes it: none, in windows of any length.
UNHELD = 1e-9
#: Order from which on a further mode is looked for: two modes and a lag do not do.
MANY = 5
#: Orders in a row that are allowed to bring nothing; one more ends the search.
IN_VAIN = 2
#: Share of each record at its beginning that does not count: what it remembers of the
#: time before would pull the poles.
LEAD = 0.1
#: Steps of least squares on simulation: of all records, then of each fold.
ROUNDS = 20
FOLD_ROUNDS = 4
#: Order and steps of a linear model in turn with which something else is found.
ROUGH, ROUGH_ROUNDS = 3, 3


Model = TypeVar("Model", bound="Judged")


@dataclass(frozen=True)
class Judged:
    """A model with its errors."""

    fit: float
    """Error on all records."""
    folds: float
    """Error on folds that did not fit it."""
    constant: float
    """Error of a constant on these folds."""

    @property
    def holds(self) -> bool:
        """Whether it does better than a constant on folds that did not fit it."""
        return self.folds < (1 - NUMBER_PAYS) * self.constant

    @property
    def fades(self) -> bool:
        """Whether every swing that it begins fades within the records."""
        return True


def lowers(better: Judged, item: Judged, share: float = NUMBER_PAYS) -> bool:
    """Tell whether one model lowers both errors of another by more than a share.

    Those of fit and of folds: a gain on folds alone is their luck.
    """
    most = 1 - share
    return better.fit < most * item.fit and better.folds < most * item.folds


def none_lowers_both(item: Judged, others: Sequence[Judged]) -> bool:
    """Tell whether no other model lowers both errors of one by what a number pays.

    One that does worse on folds than a constant has no place beside one that does not.
    """
    if not item.holds and any(other.holds for other in others):
        return False
    return not any(lowers(other, item) for other in others)


def first_none_lowers(tried: Sequence[Model]) -> Model:
    """Give the first model of which no other one lowers both errors."""
    return next(item for item in tried if none_lowers_both(item, tried))


def without_lasting_swings(tried: Sequence[Model]) -> Sequence[Model]:
    """Leave out models with a swing that hardly fades, if no input is needed for it.

    Such a swing goes on by itself and imitates what no input causes, on folds of the
    same record too. Without that of a device much more is left: four times the power,
    and more as well if the swing is free to be in each record, whatever its input.
    """
    fading = [item for item in tried if item.fades]
    best, other = first_none_lowers(tried), first_none_lowers(fading)
    if not isinstance(best, Found) or best.fades:
        return tried
    if best.folds**2 >= LOOSE * other.folds**2:
        return fading
    driven = not isinstance(other, Found) or lowers(best, other.beside(best.lasting))
    return tried if driven else fading


@dataclass(frozen=True)
class Found(Judged):
    """A ratio that was fitted, and the records that it was fitted to."""

    orders: Orders
    task: OutputError
    ratio: Ratio

    @property
    def fades(self) -> bool:
        """Whether a swing has less than half of its power in a record's second half.

        One that repeats never ends, and no swing is begun in it.
        """
        return len(self.lasting) == 0

    @property
    def lasting(self) -> ComplexArray:
        """Poles of swings that hardly fade, in 1/s, one of each pair."""
        records = self.task.records
        if any(record.repeats for record in records):
            return np.zeros(0, complex)
        seconds = max(len(record) * record.dt for record in records)
        lasting = lasting_ones(self.ratio.poles(self.task.scale), seconds)
        return lasting[lasting.imag > 0.0]

    def beside(self, swings: ComplexArray) -> Found:
        """Fit it again with swings of such poles free in each record."""
        freed = tuple(with_state_of(record, swings) for record in self.task.records)
        return self.orders.judged(replace(self.task, records=freed), self.ratio)


@dataclass(frozen=True)
class Orders:
    """Records that ratios of all orders are fitted to."""

    evidence: Evidence
    late: float = 0.0
    """Sampling intervals by which their input was made later; below zero earlier."""

    @cached_property
    def whole(self) -> tuple[Mask, ...]:
        """Samples that count: those behind the lead."""
        return tuple(
            (np.arange(len(x)) >= LEAD * len(x)) & x.counted for x in self.evidence.fit
        )

    @cached_property
    def folds(self) -> tuple[Fold, ...]:
        """Those of them that fit, and those that judge."""
        return tuple(
            Fold(_both(fold.train, self.whole), _both(fold.validation, self.whole))
            for fold in make_folds(self.evidence.fit)
        )

    @cached_property
    def constant(self) -> float:
        """Error of a constant on the folds, beside what each record has of its own."""
        fit = self.evidence.fit
        ys, own = [x.y for x in fit], own_columns(fit, self.evidence.own_offsets)
        squares, count = 0.0, 0
        for fold in self.folds:
            mean = float(np.mean(np.concatenate(_taken(ys, fold.train))))
            judged = _taken(ys, fold.validation)
            beside = _taken(own, fold.validation)
            for taken, of in zip(judged, beside, strict=True):
                squares += float(np.sum(without(taken - mean, of) ** 2))
                count += len(taken)
        return float(np.sqrt(squares / count))

    @cached_property
    def spectra(self) -> Spectra:
        """Spectra of the records."""
        fit = self.evidence.fit
        if self.evidence.own_offsets:  # a constant makes one, but for a transient
            fit = tuple(replace(x, u=x.u - x.u.mean(), y=x.y - x.y.mean()) for x in fit)
        return Spectra.of(fit, self.evidence.input_hold)

    @cached_property
    def decay_s(self) -> float | None:
        """Time constant of a mass that nothing holds, if the records are of one."""
        return next((x.decay_s for x in self.evidence.fit if x.decay_s), None)

    @cached_property
    def _begun(self) -> dict[tuple[int, int], Ratio]:
        return {}

    def begun(self, order: int, zeros: int) -> Ratio:
        """Fit a ratio to the spectra; it is kept, as halves begin with it too."""
        key = order, zeros
        if key not in self._begun:
            self._begun[key] = fit_ratio(self.spectra, order, zeros)
        return self._begun[key]

    def of(self, order: int, zeros: int) -> Found:
        """Fit one order to all records, and from there to each fold's.

        Of a mass that nothing holds one pole stays at zero.
        """
        if self.decay_s is None:
            first = self.begun(order, zeros)
        else:
            brake = 1 / (self.decay_s * self.spectra.scale)
            first = with_poles(self.spectra, brake * np.array([UNHELD, 1.0]), zeros)
            first = replace(first, offset=0.0)  # every window begins at zero
        evidence = self.evidence
        task = OutputError(
            evidence.fit,
            evidence.input_hold,
            self.spectra.scale,
            own_offsets=evidence.own_offsets,
            free_starts=evidence.free_starts,
            held=int(self.decay_s is not None),
        )
        return self.judged(with_plainest_start(task, first), first)

    def roughly(self, zeros: int) -> tuple[OutputError, Ratio]:
        """Fit a mode and a lag by a few steps, where what is beside them is sought."""
        first = self.begun(ROUGH, zeros)
        evidence = self.evidence
        task = OutputError(evidence.fit, evidence.input_hold, self.spectra.scale)
        task = with_plainest_start(task, first)
        return task, task.refined(first, self.whole, ROUGH_ROUNDS)

    def judged(self, task: OutputError, first: Ratio) -> Found:
        """Fit a ratio to all records, and from there to each fold's."""
        count = sum(int(mask.sum()) for mask in self.whole)
        ratio = task.refined(first, self.whole, ROUNDS)

        def squares(fold: Fold) -> float:
            fitted = task.refined(ratio, fold.train, FOLD_ROUNDS)
            return task.squares(fitted, fold.validation)

        judged = sum(each(squares, self.folds, "orders on folds", len(ratio.a)))
        fit, folds = (float(np.sqrt(x / count)) for x in (ratio.cost, judged))
        return Found(fit, folds, self.constant, self, task, ratio)

    def searched(self, without: Judged) -> list[Found]:
        """Fit orders from one on, while they matter beside a model without any pole.

        With many, one mode more at a time. A mass that nothing holds has two poles.
        """
        if self.decay_s is not None:
            return [self.of(2, 2)]
        found: list[Found] = []
        plain: Judged = without
        in_vain = 0
        for order in range(1, HIGHEST + 1):
            found.append(self.of(order, order))
            in_vain = 0 if lowers(found[-1], plain) else in_vain + 1
            plain = next(x for x in (without, *found) if none_lowers_both(x, found))
            if in_vain > IN_VAIN:
                break
        if isinstance(plain, Found) and len(plain.ratio.a) >= MANY:
            found += self._further_modes(plain)
        return found

    def _further_modes(self, last: Found) -> list[Found]:
        """Add one mode at a time where most is left, while it matters.

        Of many poles at once a fit to the spectra finds no good start.
        """
        found: list[Found] = []
        while len(last.ratio.a) + 2 <= HIGHEST_WITH_MODES:
            left = last.task.left(last.ratio)
            begun = each(
                partial(last.task.refined, masks=self.whole, rounds=FOLD_ROUNDS),
                list(with_a_mode(self.spectra, last.ratio, left)),
                "a further mode",
            )
            best = min(begun, key=lambda ratio: ratio.cost)
            further = self.judged(last.task, best)
            if not lowers(further, last, ANOTHER_MODE):
                break
            found.append(further)
            last = further
        return found

    def moved(self, late: float, step: float) -> Orders:
        """Give them with the input so many sampling intervals of a step later."""
        block = InputDelay.by(late * step, self.evidence.input_hold)
        fit = tuple(
            replace(item, u=block.simulate(item.u, item.u, item.dt))
            for item in self.evidence.fit
        )
        return Orders(replace(self.evidence, fit=fit), late)


def simplest_as_good(
    found: Found, others: Sequence[Judged], step: float | None
) -> Found:
    """Leave out zeros that a ratio does not need, and take its input in time.

    A sample between input and output looks like a zero, or like a pole and some.

    Parameters
    ----------
    found : Found
        As many zeros as poles.
    others : sequence of Judged
        Models that none of its numbers may be missed beside.
    step : float, optional
        Sampling interval of the records as they were measured; without one no timing
        is tried.
    """
    tried = _shorter(found, others)
    motion = found.orders.evidence.quantities.causality == "force to motion"
    for plain in tried[-2:]:
        timed = None if step is None else in_time(plain, step)
        if timed is None or not none_lowers_both(timed, others):
            continue
        simpler = _simpler(timed, [*others, timed])
        # What grows with the frequency, as the force on a mass that is moved, asks for
        # poles that would have to come early: no timing makes up for that.
        if motion or len(simpler.ratio.b) <= len(simpler.ratio.a):
            return simpler
    return _last_good(tried, others)


def _simpler(timed: Found, others: Sequence[Judged]) -> Found:
    """Leave out the poles and zeros that stood for the sample."""
    order, zeros = len(timed.ratio.a), len(timed.ratio.b) - 1
    lower = (
        timed.orders.of(k, min(k, zeros)) for k in range(1, min(order, HIGHEST + 1))
    )
    found = next((item for item in lower if none_lowers_both(item, others)), timed)
    return _last_good(_shorter(found, others), others)


def _shorter(found: Found, others: Sequence[Judged]) -> list[Found]:
    """Leave out one zero after the other, up to the first that is needed."""
    order, tried = len(found.ratio.a), [found]
    fewer = reversed(range(len(found.ratio.b) - 1)) if order <= HIGHEST else ()
    for zeros in fewer:
        tried.append(found.orders.of(order, zeros))
        if not none_lowers_both(tried[-1], others):
            break
    return tried


def _last_good(tried: Sequence[Found], others: Sequence[Judged]) -> Found:
    return next(item for item in reversed(tried) if none_lowers_both(item, others))


def in_time(plain: Found, step: float) -> Found | None:
    """Fit with the input half a sample or a whole one early or late.

    None where that does not lower the errors, or more than a sample would lower them
    further: this is the device's own, a lag or a delay.

    Parameters
    ----------
    plain : Found
        A ratio with the input as it is.
    step : float
        Sampling interval of the records.
    """
    order, zeros = len(plain.ratio.a), len(plain.ratio.b) - 1

    def late(samples: float) -> Found:
        orders = plain.orders.moved(samples, step)
        if order <= HIGHEST:
            return orders.of(order, zeros)
        task = replace(plain.task, records=orders.evidence.fit)
        return orders.judged(task, plain.ratio)

    best = min(late(-0.5), late(0.5), key=lambda item: item.fit)
    if best.fit > plain.fit:
        return None
    half = best.orders.late
    for farther in (2 * half, 3 * half):
        beyond = late(farther)
        if beyond.fit > best.fit:
            pays = best.fit < (1 - TIMING_PAYS) * plain.fit
            return best if pays and best.folds < plain.folds else None
        best = beyond
    return None


def with_plainest_start(task: OutputError, ratio: Ratio) -> OutputError:
    """Take the plainest start of the records that does nearly as well as any."""
    everything = [record.counted for record in task.records]
    tasks = [replace(task, start=start) for start in possible_starts(task.records)]
    costs = [task.squares(ratio, everything) for task in tasks]
    return tasks[plainest_start(costs)]


def _taken(signals: Sequence[FloatArray], masks: Sequence[Mask]) -> list[FloatArray]:
    """Give the masked samples of each signal that has any."""
    every = (x[mask] for x, mask in zip(signals, masks, strict=True))
    return [x for x in every if len(x)]


def _both(masks: tuple[Mask, ...], others: tuple[Mask, ...]) -> tuple[Mask, ...]:
    return tuple(a & b for a, b in zip(masks, others, strict=True))

"""The best linear base: a transfer function of an order that the folds ask for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.transfer_function import possible_starts
from hystbench.errors import InputError
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Ratio, Spectra, Stretch, fit_ratio, with_a_mode
from hystbench.gap.bases.split_linear import best_split, chain_of, is_bent
from hystbench.gap.bases.summed import constant, impedance, static
from hystbench.gap.bases.wiener_hammerstein import HalvesError
from hystbench.gap.records.coarser import coarser
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.folds import Fold, make_folds
from hystbench.model import Model
from hystbench.record import Mask, Record

#: Highest order that is tried, of all poles at once, and with modes added one by one.
HIGHEST = 6
MOST_ORDERS = 12
#: Order from which on a further mode is looked for: two modes and a lag do not do.
MANY = 5
#: Damping ratio at which a further mode is begun.
BEGUN_DAMPING = 0.01
#: Peaks of what is left at which a further mode is begun.
PEAKS = 3
#: An order is needed if it lowers the error on the folds by more than this share.
ORDER_PAYS = 0.005
#: Orders above are not tried once so many in a row have not mattered.
IN_VAIN = 2
#: Share of each record at its beginning that does not count: what it remembers of the
#: time before would pull the poles.
LEAD = 0.1
#: The plainest start is taken whose sum of squares is within this factor of the best.
CLEARLY = 1.01
#: Two halves are the base only if their error is within this factor of its.
SAME = 1.02
#: Steps of least squares on simulation: of all records, then of each fold.
ROUNDS = 20
FOLD_ROUNDS = 4


LINEAR = "linear"
"""Name of the base that is identified as a linear model."""


def is_identified(base: Model) -> bool:
    """Tell whether a base is the linear model that was identified from the records."""
    return base.name == LINEAR and bool(base.free)


class Linear(NamedTuple):
    """A linear base, and how it was found.

    Parameters
    ----------
    model : Model
    note : str
        One sentence.
    fit_rms, fold_rms : float
        Error on the fit records, and on the folds of them that did not fit it, in
        units of the output, both after the first tenth of each record.
    """

    model: Model
    note: str
    fit_rms: float
    fold_rms: float


class _Found(NamedTuple):
    task: OutputError
    ratio: Ratio
    fit: float
    folds: float


def identified_linear(evidence: Evidence) -> Linear:
    """Find the linear model that simulates the fit records best.

    A ratio of polynomials in s and a constant, in output error. Orders from 0 (a gain)
    to 6 are fitted to the spectra first, then by least squares on simulation with the
    dataset's hold, without the first tenth of each record. Where the folds ask for 5 or
    more, modes are added one by one, up to order 12. The order is the lowest
    whose error on folds of the fit records is within half a percent of the best; then
    the numerator is shortened by the same rule. Where a motion makes a force, the
    impedance of a mass on a spring is tried as well. Deterministic.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are looked at.

    Raises
    ------
    InputError
        If a record is too short for folds, or no linear model predicts the folds
        better than a constant.
    """
    all_of_it, evidence = evidence, _coarse(evidence)
    records, whole = evidence.fit, _behind_the_lead(evidence.fit)
    folds = _folds(records, whole)
    gain = static(evidence, whole, folds)
    spectra = _spectra(evidence)

    def dynamic(order: int, zeros: int) -> _Found:
        return _dynamic(evidence, spectra, order, zeros, whole, folds)

    found: list[_Found] = []
    best, in_vain = gain.folds, 0
    for order in range(1, HIGHEST + 1):
        found.append(dynamic(order, order))
        in_vain = 0 if found[-1].folds < (1 - ORDER_PAYS) * best else in_vain + 1
        best = min(best, found[-1].folds)
        if in_vain > IN_VAIN:
            break
    enough = best / (1 - ORDER_PAYS)
    likely = next((item for item in found if item.folds <= enough), None)
    if likely is not None and len(likely.ratio.a) >= MANY:
        found += _further_modes(spectra, likely, whole, folds)
        best = min(gain.folds, *(item.folds for item in found))
    moved = impedance(evidence, whole, folds)
    if moved is not None:
        best = min(best, moved[0].folds)
    enough = best / (1 - ORDER_PAYS)
    chosen = next((item for item in found if item.folds <= enough), None)
    chain: tuple[Block, ...]
    if gain.folds <= enough:
        every = _behind_the_lead(all_of_it.fit)
        gain = static(all_of_it, every, _folds(all_of_it.fit, every))
        value, offset = gain.numbers
        chain = (Gain(value=value, offset=offset),)
        fit, fold, what = gain.fit, gain.folds, "order 0 (a gain and an offset)"
    elif moved is not None and moved[0].folds <= enough:
        (fit, fold, _), block = moved
        chain, what = (block,), "the impedance of a mass on a spring"
    else:
        assert chosen is not None  # noqa: S101  (one of them is the best)
        order = len(chosen.ratio.a)
        for zeros in range(order - 1, -1, -1) if order <= HIGHEST else ():
            shorter = dynamic(order, zeros)
            if shorter.folds > enough:
                break
            chosen = shorter
        if evidence is not all_of_it:  # the same order, on every sample
            chosen = _on_all_samples(chosen, all_of_it.fit)
        ratio = chosen.task.block(chosen.ratio)
        chain = (ratio, Gain(value=1.0, offset=float(chosen.ratio.offset)))
        fit, fold = chosen.fit, chosen.folds
        zeros = len(chosen.ratio.b) - 1
        what = f"order {order}, {zeros} zero{'s' * (zeros != 1)}, start: {ratio.start}"
    unit, still = evidence.output.unit, constant(evidence, whole, folds).folds
    if fold > (1 - ORDER_PAYS) * still:
        raise InputError(
            f"{evidence.name}: linear: on folds of the fit records the best linear "
            f"model is {fold:.4g} {unit} off, a constant {still:.4g}; expected an "
            "output that follows the input, or a model file in --model"
        )
    note = (
        f"linear base: {what}; rms error {fit:.4g} {unit} on the fit records, "
        f"{fold:.4g} {unit} on folds of them"
    )
    series = not isinstance(chain[0], Impedance)
    bent = series and _is_bent(evidence, spectra, found, whole)
    if bent and evidence is not all_of_it:
        found = [_on_all_samples(item, all_of_it.fit) for item in found]
        spectra = _spectra(all_of_it)
    halves = _halves(all_of_it, spectra, found) if bent else None
    if halves is not None:
        chain, fit, more = halves
        note += more
    model = Model(LINEAR, evidence.input, evidence.output, chain)
    return Linear(model, note, fit, fold)


def _coarse(evidence: Evidence) -> Evidence:
    """Leave out samples of long records of a slow input: the same where none are.

    A force that follows a motion is not slow.
    """
    if evidence.quantities.causality == "motion to force":
        return evidence
    records = coarser(evidence.fit, evidence.hold)
    if all(a is b for a, b in zip(records, evidence.fit, strict=True)):
        return evidence
    return replace(evidence, fit=records)


def _spectra(evidence: Evidence) -> Spectra:
    stretches = [Stretch(item.u, item.y, item.dt) for item in evidence.fit]
    return Spectra.of(stretches, evidence.hold)


def _folds(records: Sequence[Record], whole: tuple[Mask, ...]) -> tuple[Fold, ...]:
    return tuple(
        Fold(_both(fold.train, whole), _both(fold.validation, whole))
        for fold in make_folds(records)
    )


def _behind_the_lead(records: Sequence[Record]) -> tuple[Mask, ...]:
    return tuple(
        (np.arange(len(item)) >= LEAD * len(item)) & item.counted for item in records
    )


def _on_all_samples(found: _Found, records: tuple[Record, ...]) -> _Found:
    """Fit a ratio that was found on fewer samples to all of them."""
    whole = _behind_the_lead(records)
    task = _plainest(replace(found.task, records=records), found.ratio)
    ratio = task.refined(found.ratio, whole, ROUNDS)
    count = sum(int(mask.sum()) for mask in whole)
    fit = float(np.sqrt(ratio.cost / count))
    return found._replace(task=task, ratio=ratio, fit=fit)


def _further_modes(
    spectra: Spectra,
    last: _Found,
    whole: tuple[Mask, ...],
    folds: tuple[Fold, ...],
) -> list[_Found]:
    """Add one mode at a time where most is left, while it matters on the folds.

    Of many poles at once a fit to the spectra finds no good start.
    """
    found: list[_Found] = []
    while len(last.ratio.a) + 2 <= MOST_ORDERS:
        begun = [
            last.task.refined(ratio, whole, FOLD_ROUNDS)
            for ratio in with_a_mode(
                spectra,
                last.ratio,
                last.task.left(last.ratio),
                BEGUN_DAMPING,
                PEAKS,
            )
        ]
        best = min(begun, key=lambda ratio: ratio.cost)
        further = _judged(last.task, best, whole, folds)
        if further.folds >= (1 - ORDER_PAYS) * last.folds:
            break
        found.append(further)
        last = further
    return found


def _is_bent(
    evidence: Evidence, spectra: Spectra, found: list[_Found], whole: tuple[Mask, ...]
) -> bool:
    """Tell whether a static curve somewhere pays at all."""
    start = found[-1].task.start
    task = HalvesError(evidence.fit, whole, evidence.hold, spectra.scale, start)
    return is_bent(task, [item.ratio for item in found])


def _halves(
    evidence: Evidence, spectra: Spectra, found: list[_Found]
) -> tuple[tuple[Block, ...], float, str] | None:
    """Write the base as two in series, where a static curve between explains much.

    Returns the chain, its own error on the fit records, and a few words.
    """
    whole = _behind_the_lead(evidence.fit)
    folds, start = _folds(evidence.fit, whole), found[-1].task.start
    task = HalvesError(evidence.fit, whole, evidence.hold, spectra.scale, start)
    free_run = OutputError(evidence.fit, evidence.hold, spectra.scale, start)
    ratios = [
        free_run.refined(fit_ratio(spectra, order, zeros), whole, ROUNDS)
        for order in range(2, HIGHEST + 1)
        for zeros in (order - 1, order)
    ]
    halves = best_split(task, ratios, folds)
    if halves is None:
        return None
    count = sum(int(mask.sum()) for mask in whole)
    chain, error = chain_of(task, halves)
    if error > SAME**2 * min(item.ratio.cost for item in found):
        return None
    unit = evidence.output.unit
    words = (
        f"; written as two in series, of order {len(halves.front_a)} and "
        f"{len(halves.back_a)}, since a static curve between them leaves "
        f"{np.sqrt(halves.cost / count):.4g} {unit}"
    )
    return chain, float(np.sqrt(error / count)), words


def _both(masks: tuple[Mask, ...], others: tuple[Mask, ...]) -> tuple[Mask, ...]:
    return tuple(a & b for a, b in zip(masks, others, strict=True))


def _dynamic(
    evidence: Evidence,
    spectra: Spectra,
    order: int,
    zeros: int,
    whole: tuple[Mask, ...],
    folds: tuple[Fold, ...],
) -> _Found:
    """Fit one order to all records, and from there to each fold's."""
    first = fit_ratio(spectra, order, zeros)
    task = OutputError(evidence.fit, evidence.hold, spectra.scale)
    return _judged(_plainest(task, first), first, whole, folds)


def _plainest(task: OutputError, ratio: Ratio) -> OutputError:
    """Take the plainest start of the records that does nearly as well as any."""
    everything = [record.counted for record in task.records]
    tasks = [replace(task, start=start) for start in possible_starts(task.records)]
    costs = [task.squares(ratio, everything) for task in tasks]
    return next(
        task
        for task, cost in zip(tasks, costs, strict=True)
        if cost <= CLEARLY * min(costs)
    )


def _judged(
    task: OutputError, first: Ratio, whole: tuple[Mask, ...], folds: tuple[Fold, ...]
) -> _Found:
    """Fit a ratio to all records, and from there to each fold's."""
    count = sum(int(mask.sum()) for mask in whole)
    ratio = task.refined(first, whole, ROUNDS)
    judged = sum(
        task.squares(task.refined(ratio, fold.train, FOLD_ROUNDS), fold.validation)
        for fold in folds
    )
    return _Found(
        task, ratio, float(np.sqrt(ratio.cost / count)), float(np.sqrt(judged / count))
    )

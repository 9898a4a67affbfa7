"""The best linear base: a transfer function of an order that the folds ask for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.impedance import INPUTS, NUMBERS, Impedance
from hystbench.blocks.transfer_function import STARTS
from hystbench.errors import InputError
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Ratio, Spectra, Stretch, fit_ratio, with_a_mode
from hystbench.gap.bases.split_linear import best_split, chain_of, is_bent
from hystbench.gap.bases.wiener_hammerstein import HalvesError
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.folds import Fold, make_folds
from hystbench.model import Model
from hystbench.record import FloatArray, Mask

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
    records = evidence.fit
    whole = tuple(
        (np.arange(len(item)) >= LEAD * len(item)) & item.counted for item in records
    )
    folds = tuple(
        Fold(_both(fold.train, whole), _both(fold.validation, whole))
        for fold in make_folds(records)
    )
    ones = [np.ones((len(item), 1)) for item in records]
    inputs = [
        np.column_stack([item.u, one]) for item, one in zip(records, ones, strict=True)
    ]
    static = _summed(inputs, evidence, whole, folds)
    constant = _summed(ones, evidence, whole, folds).folds
    spectra = Spectra.of([Stretch(r.u, r.y, r.dt) for r in records], evidence.hold)

    def dynamic(order: int, zeros: int) -> _Found:
        return _dynamic(evidence, spectra, order, zeros, whole, folds)

    found: list[_Found] = []
    best, in_vain = static.folds, 0
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
        best = min(static.folds, *(item.folds for item in found))
    moved = _impedance(evidence, whole, folds)
    if moved is not None:
        best = min(best, moved[0].folds)
    enough = best / (1 - ORDER_PAYS)
    chosen = next((item for item in found if item.folds <= enough), None)
    chain: tuple[Block, ...]
    if static.folds <= enough:
        value, offset = static.numbers
        chain = (Gain(value=value, offset=offset),)
        fit, fold, what = static.fit, static.folds, "order 0 (a gain and an offset)"
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
        ratio = chosen.task.block(chosen.ratio)
        chain = (ratio, Gain(value=1.0, offset=float(chosen.ratio.offset)))
        fit, fold = chosen.fit, chosen.folds
        zeros = len(chosen.ratio.b) - 1
        what = f"order {order}, {zeros} zero{'s' * (zeros != 1)}, from {ratio.start}"
    unit = evidence.output.unit
    if fold > (1 - ORDER_PAYS) * constant:
        raise InputError(
            f"{evidence.name}: linear: on folds of the fit records the best linear "
            f"model is {fold:.4g} {unit} off, a constant {constant:.4g}; expected an "
            "output that follows the input, or a model file in --model"
        )
    note = (
        f"linear base: {what}; rms error {fit:.4g} {unit} on the fit records, "
        f"{fold:.4g} {unit} on folds of them"
    )
    series = not isinstance(chain[0], Impedance)
    halves = _halves(evidence, spectra, found, whole, folds) if series else None
    if halves is not None:
        chain, fit, more = halves
        note += more
    model = Model("linear", evidence.input, evidence.output, chain)
    return Linear(model, note, fit, fold)


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


def _halves(
    evidence: Evidence,
    spectra: Spectra,
    found: list[_Found],
    whole: tuple[Mask, ...],
    folds: tuple[Fold, ...],
) -> tuple[tuple[Block, ...], float, str] | None:
    """Write the base as two in series, where a static curve between explains much.

    Returns the chain, its own error on the fit records, and a few words.
    """
    start = found[-1].task.start
    task = HalvesError(evidence.fit, whole, evidence.hold, spectra.scale, start)
    if not is_bent(task, [item.ratio for item in found]):
        return None
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


class _Sum(NamedTuple):
    """A model that is the sum of some signals, each times a number."""

    fit: float
    folds: float
    numbers: tuple[float, ...]


def _summed(
    signals: Sequence[FloatArray],
    evidence: Evidence,
    whole: tuple[Mask, ...],
    folds: tuple[Fold, ...],
) -> _Sum:
    """Fit a sum of signals: error on all records, on the folds, and the numbers.

    Parameters
    ----------
    signals : sequence of ndarray, shape (n, k)
        Of each record, in columns.
    """
    sizes = np.maximum(np.sqrt(np.mean(np.vstack(signals) ** 2, axis=0)), 1e-300)
    scaled = [columns / sizes for columns in signals]
    outputs = [record.y for record in evidence.fit]

    def solved(masks: tuple[Mask, ...]) -> FloatArray:
        left = np.vstack([x[mask] for x, mask in zip(scaled, masks, strict=True)])
        right = np.concatenate(
            [x[mask] for x, mask in zip(outputs, masks, strict=True)]
        )
        found: FloatArray = np.linalg.lstsq(left, right, rcond=None)[0]
        return found

    def squares(numbers: FloatArray, masks: tuple[Mask, ...]) -> float:
        return sum(
            float(np.sum((y - x @ numbers)[mask] ** 2))
            for x, y, mask in zip(scaled, outputs, masks, strict=True)
        )

    best = solved(whole)
    judged = sum(squares(solved(fold.train), fold.validation) for fold in folds)
    count = sum(int(mask.sum()) for mask in whole)
    return _Sum(
        float(np.sqrt(squares(best, whole) / count)),
        float(np.sqrt(judged / count)),
        tuple((best / sizes).tolist()),
    )


def _impedance(
    evidence: Evidence, whole: tuple[Mask, ...], folds: tuple[Fold, ...]
) -> tuple[_Sum, Block] | None:
    """Fit the force of a mass on a spring to a motion; none to any other input.

    It grows with the frequency: a ratio of polynomials that can be run has no such.
    """
    about = evidence.quantities
    if about.causality != "motion to force" or about.input not in INPUTS:
        return None
    signals = [
        Impedance.columns(about.input, evidence.hold, record.u, record.dt)
        for record in evidence.fit
    ]
    found = _summed(signals, evidence, whole, folds)
    numbers: dict[str, Any] = dict(zip(NUMBERS, found.numbers, strict=True))
    return found, Impedance(**numbers, input=about.input, hold=evidence.hold)


def _dynamic(
    evidence: Evidence,
    spectra: Spectra,
    order: int,
    zeros: int,
    whole: tuple[Mask, ...],
    folds: tuple[Fold, ...],
) -> _Found:
    """Fit one order to all records, and from there to each fold's."""
    everything = [record.counted for record in evidence.fit]
    first = fit_ratio(spectra, order, zeros)
    tasks = [
        OutputError(evidence.fit, evidence.hold, spectra.scale, start)
        for start in STARTS
    ]
    costs = [task.squares(first, everything) for task in tasks]
    task = next(
        task
        for task, cost in zip(tasks, costs, strict=True)
        if cost <= CLEARLY * min(costs)
    )
    return _judged(task, first, whole, folds)


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

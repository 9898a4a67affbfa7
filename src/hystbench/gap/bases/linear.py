"""The best linear base: a transfer function of an order that the folds ask for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases.dead_time import behind_a_dead_time
from hystbench.gap.bases.free_starts import start_fades, with_free_starts
from hystbench.gap.bases.orders import (
    HIGHEST,
    MANY,
    ROUNDS,
    Found,
    Orders,
    first_none_lowers,
    simplest_as_good,
    with_plainest_start,
    without_lasting_swings,
)
from hystbench.gap.bases.slow_drive import behind_a_slow_drive
from hystbench.gap.bases.split_linear import ENOUGH, best_split, chain_of, is_bent
from hystbench.gap.bases.static_curve import behind_a_curve
from hystbench.gap.bases.sums import Sum, impedance, static
from hystbench.gap.bases.unsigned import with_signs
from hystbench.gap.bases.wiener_hammerstein import HalvesError
from hystbench.gap.records.coarser import coarser
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import LOOSE, NUMBER_PAYS
from hystbench.model import Model

LINEAR = "linear"
"""Name of the base that is identified as a linear model."""
NO_SIGN, SLOW, LATE = "sensor-nonlinearity", "slew-limit", "input-delay"
CURVE = "static curve"
"""What a linear model is found together with: effects, and a curve of no name yet."""


@dataclass(frozen=True)
class IdentifiedModel(Model):
    """A linear model that was identified from the fit records, with the gap in them."""

    found_with: str = ""
    """What it was found together with, which is no part of it."""
    free_starts: bool = False
    """Whether records that do not repeat may begin in any of its states."""


def is_identified_linear(base: Model) -> bool:
    """Tell whether a base is linear, was identified and may be re-tuned."""
    return isinstance(base, IdentifiedModel) and bool(base.free)


def found_with(base: Model) -> str:
    """Say what a base was found together with; nothing for most."""
    return base.found_with if isinstance(base, IdentifiedModel) else ""


def has_free_starts(base: Model) -> bool:
    """Tell whether records may begin in any state of a base."""
    return isinstance(base, IdentifiedModel) and base.free_starts


def how_found(base: Model) -> dict[str, Any]:
    """Give what of an identified linear base no model file holds; else nothing."""
    if not isinstance(base, IdentifiedModel):
        return {}
    return {"found_with": base.found_with, "free_starts": base.free_starts}


def with_its_numbers_free(base: Model) -> Model:
    """Free the numbers of an identified base that may be re-tuned.

    It was fitted with the gap in it: what is added may take its part back. Of many
    poles, a small step of one coefficient alone may make the model unstable; and its
    timing is how records were stamped.
    """
    bare = replace(base, free=(), tolerances={}, provenance={})
    numbers = [
        name
        for name in bare.parameter_names()
        if not isinstance(value := bare.value(name), str)
        and not name.startswith("input-delay.")
        and not (
            name.endswith(".denominator") and len(np.atleast_1d(value)) > HIGHEST + 1
        )
    ]
    return replace(bare, free=tuple(numbers))


class Linear(NamedTuple):
    """A linear base, and how it was found."""

    model: IdentifiedModel
    note: str
    """One sentence."""
    fit_rms: float
    fold_rms: float
    """Error on the fit records, and on the folds of them that did not fit it, in units
    of the output, both after the first tenth of each record."""
    constant_rms: float
    """Error of a constant on these folds."""
    split_rms: float = math.inf
    """Error on the fit records of two in series with a static curve between them."""


def identified_linear(evidence: Evidence) -> Linear:
    """Find the linear model that simulates the fit records best.

    The model is of input and output. One of an output with a sign is tried too if the
    output is never below zero, one behind a drive that goes no faster than a rate, one
    behind a dead time if order 5 or more was needed, and one behind a static curve. Any
    is taken if it leaves less than a quarter of the power on folds, and a static curve
    inside does not leave less than a quarter of its. Behind a dead time it is enough
    if each pole that is spared would have lowered the error by no more than 2 %.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are looked at.

    Raises
    ------
    InputError
        If no linear model predicts the folds better than a constant.
    """
    plain, unit = linear_of(evidence), evidence.output.unit
    best = plain
    for effect, words, without, other in _found_beside(evidence, plain):
        found = linear_of(other)
        between = plain.split_rms**2 < LOOSE * found.fit_rms**2
        if found.model.free_starts and not start_fades(found.model, evidence):
            continue
        spared = max(_poles(best.model) - _poles(found.model), 0)
        most = math.sqrt(LOOSE) * best.fold_rms
        if effect == LATE and best is plain and spared:
            # Each pole more would have to pay.
            most = best.fold_rms / (1 - NUMBER_PAYS) ** spared
        if found.fold_rms < most and not between:
            note = (
                f"{found.note}, {words} ({without} {plain.fold_rms:.4g} {unit} on "
                "folds)"
            )
            model = replace(found.model, found_with=effect)
            if effect == CURVE:
                model = _of_mean_output(model, evidence)
            constant = plain.constant_rms
            best = found._replace(model=model, note=note, constant_rms=constant)
    fold, still = best.fold_rms, best.constant_rms
    if fold > (1 - NUMBER_PAYS) * still:
        raise InputError(
            f"{evidence.name}: linear: on folds of the fit records the best linear "
            f"model is {fold:.4g} {unit} off, a constant {still:.4g}; expected an "
            "output that follows the input, or a model file in --model"
        )
    return best


def _of_mean_output(model: IdentifiedModel, evidence: Evidence) -> IdentifiedModel:
    """Give a model the offset with which its mean is that of the fit records."""
    held = model.with_hold(evidence.input_hold)
    rest = np.concatenate(
        [(x.y - held.begun_on(x).simulate(x.u, x.dt))[x.counted] for x in evidence.fit]
    )
    *others, last = model.chain
    mean = float(np.mean(rest))
    if isinstance(last, Impedance):
        last = replace(last, bias=last.bias + mean)
    else:
        assert isinstance(last, Gain)  # noqa: S101  (for the type checker)
        last = replace(last, offset=last.offset + mean)
    return replace(model, chain=(*others, last))


def _found_beside(
    evidence: Evidence, plain: Linear
) -> Iterator[tuple[str, str, str, Evidence]]:
    """Give what no linear model shows, with records that are freed of each.

    Beside the name, if it has one, stand words for a base of these records, and for one
    of the records as they were measured.
    """
    free = with_free_starts(evidence, plain.fit_rms)
    if free is not None:
        yield "", "begun anyhow, as it remembers for long", "begun alike", free
    signed = with_signs(evidence)
    if signed is not None:
        words = "of an output with a sign that the sensor may not show"
        yield NO_SIGN, words, "without a sign", signed
    slowed = behind_a_slow_drive(evidence)
    if slowed is not None:
        slow, drive = slowed
        down = f" up and {drive.falling:.4g} down" if drive.falling else ""
        rates = f"{drive.rate:.4g}{down} {evidence.input.unit}/s"
        words = f"behind a drive of {rates} at most"
        yield SLOW, words, "without that limit", slow
    if _poles(plain.model) >= MANY and (dead := behind_a_dead_time(evidence)):
        late, seconds = dead
        yield LATE, f"behind a dead time of {seconds:.4g} s", "without that", late
    curved = behind_a_curve(evidence, plain.model.chain, plain.fit_rms)
    if curved is not None:
        yield CURVE, "behind a static curve", "without that curve", curved


def _poles(model: Model) -> int:
    """Count the poles of the transfer functions in a chain."""
    parts = (block for block in model.chain if isinstance(block, TransferFunction))
    return sum(len(block.denominator) - 1 for block in parts)


def linear_of(evidence: Evidence) -> Linear:
    """Find the linear model that simulates the output of the fit records best.

    A ratio of polynomials in s and a constant, in output error. Orders from 0 (a gain)
    to 6 are fitted to the spectra first, then by least squares on simulation with the
    dataset's hold, without the first tenth of each record, and with an offset of each
    record where its zero is not physical. Where order 5 or more is needed, modes are
    added one by one, up to order 20. The order is the lowest of which no other one
    lowers both errors by more than 2 %, that on folds of the fit records and that on
    all of them, of those that do better on folds than a constant. Then the numerator is
    shortened by the same rule, and the input may come up to a sample early or late.
    Where a motion makes a force, the impedance of a mass on a spring is tried as well.
    Deterministic.

    Parameters
    ----------
    evidence : Evidence
        Only its fit records are looked at.
    """
    best, found, orders, everything = _chosen(evidence)
    (chain, what), fit, between = _written(best), best.fit, math.inf
    unit = evidence.output.unit
    own = " and with an offset of its own" if evidence.own_offsets else ""
    note = (
        f"linear base: {what}; rms error {fit:.4g} {unit} on the fit records, "
        f"{best.folds:.4g} {unit} on folds of them, each behind its first tenth{own}"
    )
    # A free mass adds up what drives it: it is no filter with a curve in the middle.
    one_filter = evidence.in_windows or evidence.free_starts
    split = not one_filter and not isinstance(chain[0], Impedance)
    if split and is_bent(_errors(orders, found), [item.ratio for item in found]):
        halves = _halves(everything, found)
        if halves is not None:
            chain, fit, between, more = halves
            note += more
    if orders.late:
        half = "half " if abs(orders.late) < 1 else ""
        when = "late" if orders.late > 0 else "early"
        note += f"; its input is taken {half}a sample {when}"
        delay = InputDelay.by(orders.late * evidence.fit[0].dt, evidence.input_hold)
        chain = (delay, *chain)
    model = IdentifiedModel(
        LINEAR,
        evidence.input,
        evidence.output,
        chain,
        free_starts=evidence.free_starts,
    )
    return Linear(model, note, fit, best.folds, best.constant, between)


class Chosen(NamedTuple):
    """The best linear base, and what halves of it would begin with."""

    best: Sum | Found
    """Fitted to every sample."""
    found: Sequence[Found]
    """Ratios of one timing, found on as many samples as the search takes."""
    orders: Orders
    """Those samples, in that timing."""
    everything: Orders
    """Every sample, in that timing."""


def _chosen(evidence: Evidence) -> Chosen:
    """Choose the order, then the zeros and the timing; fit that to every sample."""
    everything, coarse = Orders(evidence), _coarse(evidence)
    orders = everything if coarse is evidence else Orders(coarse)
    gain, moved = static(orders), impedance(orders)
    found = orders.searched(gain)
    every: list[Sum | Found] = [gain, *([] if moved is None else [moved]), *found]
    tried = without_lasting_swings(every)
    best = first_none_lowers(tried)
    if isinstance(best, Sum):
        # An impedance was fitted to all samples, as its records are never coarse.
        best = static(everything) if best is gain else best
        return Chosen(best, found, orders, everything)
    steps = {item.dt for item in evidence.fit}
    best = simplest_as_good(best, tried, min(steps) if len(steps) == 1 else None)
    if best.orders.late:
        found, orders = [best], best.orders
        spared = len(orders.evidence.fit[0]) < len(evidence.fit[0])
        everything = everything.moved(orders.late, min(steps)) if spared else orders
    return Chosen(_on_all_samples(best, everything), found, orders, everything)


def _written(best: Sum | Found) -> tuple[tuple[Block, ...], str]:
    """Write a base as a chain, and say in a few words what it is."""
    if isinstance(best, Sum):
        return best.chain, best.words
    ratio = best.task.block(best.ratio)
    zeros = len(best.ratio.b) - 1
    order = f"order {len(best.ratio.a)}, {zeros} zero{'s' * (zeros != 1)}"
    chain = (ratio, Gain(value=1.0, offset=float(best.ratio.offset)))
    return chain, f"{order}, start: {ratio.start}"


def _coarse(evidence: Evidence) -> Evidence:
    """Leave out samples of long records of a slow input: the same where none are.

    A force that follows a motion is not slow.
    """
    if evidence.quantities.causality == "motion to force":
        return evidence
    records = coarser(evidence.fit, evidence.input_hold)
    return evidence if records is evidence.fit else replace(evidence, fit=records)


def _on_all_samples(found: Found, everything: Orders) -> Found:
    """Fit a ratio that was found on fewer samples to all of them."""
    if found.orders is everything:
        return found
    records = everything.evidence.fit
    task = with_plainest_start(replace(found.task, records=records), found.ratio)
    ratio = task.refined(found.ratio, everything.whole, ROUNDS)
    count = sum(int(mask.sum()) for mask in everything.whole)
    fit = float(np.sqrt(ratio.cost / count))
    return replace(found, orders=everything, task=task, ratio=ratio, fit=fit)


def _errors(orders: Orders, found: Sequence[Found]) -> HalvesError:
    """Give the records for two halves with a curve between them."""
    task = found[-1].task
    return HalvesError(
        orders.evidence.fit, orders.whole, task.hold, orders.spectra.scale, task.start
    )


def _halves(
    everything: Orders, found: Sequence[Found]
) -> tuple[tuple[Block, ...], float, float, str] | None:
    """Write the base as two in series, where a static curve between explains much.

    Returns the chain, its error on the fit records without the curve and with it, and a
    few words.
    """
    found = [_on_all_samples(item, everything) for item in found]
    task, spectra = _errors(everything, found), everything.spectra
    free_run = replace(found[-1].task, scale=spectra.scale)
    ratios = [
        free_run.refined(everything.begun(order, zeros), everything.whole, ROUNDS)
        for order in range(2, HIGHEST + 1)
        for zeros in (order - 1, order)
    ]
    halves = best_split(task, ratios, everything.folds)
    if halves is None:
        return None
    count = sum(int(mask.sum()) for mask in everything.whole)
    chain, error = chain_of(task, halves)
    # It may leave a third more than the best linear model: a curve without an odd part
    # leaves nothing to a linear base, and a sharp one at an end shapes poles that do
    # nothing without it.
    if ENOUGH * error > min(item.ratio.cost for item in found):
        return None
    unit = everything.evidence.output.unit
    between = float(np.sqrt(halves.cost / count))
    words = (
        f"; written as two in series, of order {len(halves.front.a)} and "
        f"{len(halves.back.a)}, since a static curve between them leaves "
        f"{between:.4g} {unit}"
    )
    return chain, float(np.sqrt(error / count)), between, words

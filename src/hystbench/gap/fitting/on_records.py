"""Models on whole records: the base that a search starts from, and any other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from hystbench.blocks.held import Hold
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.records.floor import Floor, noise_floor
from hystbench.gap.records.scored_samples import Compared, ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model, check_bounded
from hystbench.record import FloatArray, Record


def start_state(
    records: tuple[Record, ...],
    base: Model,
    hold: Hold = "band-limited",
    declared: float | None = None,
    offered: tuple[str, ...] | None = None,
) -> tuple[ModelState, Floor]:
    """Simulate the base on the fit records and measure the noise floor.

    Parameters
    ----------
    records : tuple of Record
    base : Model
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    declared : float, optional
        RMS noise, where it is known.
    offered : tuple of str, optional
        Effects that a search may add; all by default.

    Raises
    ------
    InputError
        If the base's output is not finite.
    """
    base = base.with_hold(hold)
    state = ModelState(
        base.chain,
        records,
        ScoredSamples.of(records),
        free=free_numbers(base),
        hold=hold,
        offered=offered,
    )
    check_finite(base.name, records, state.exact)
    return state.settled(), noise_floor(compared_records(state), declared)


def on_records(state: ModelState, records: tuple[Record, ...]) -> ModelState:
    """Give a model on other records of the same lengths."""
    return replace(state, records=records, correction=None).settled()


def run_base(
    base: Model, records: tuple[Record, ...], hold: Hold
) -> tuple[FloatArray, ...]:
    """Simulate the base as it is shown, with plain steps.

    Parameters
    ----------
    base : Model
    records : tuple of Record
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.

    Returns
    -------
    tuple of ndarray, shape (n,) each

    Raises
    ------
    InputError
        If an output is not finite.
    """
    outputs = Simulation(base.with_hold(hold).chain, records, hold).output
    check_finite(base.name, records, outputs)
    return outputs


def check_finite(
    name: str, records: Sequence[Record], outputs: Sequence[FloatArray]
) -> None:
    """Refuse a model whose output is not finite on a record.

    Raises
    ------
    InputError
        With the model's name, the time and the record.
    """
    for record, simulated in zip(records, outputs, strict=True):
        check_bounded(name, simulated, record.dt, record.name)


def free_numbers(base: Model) -> tuple[Free, ...]:
    """Give the numbers that a model leaves free, with the size of a likely change.

    A tolerance is a share of the value, and the most that a number may change by. A
    zero has none; in a list, as of an integrator, it stays fixed. A step of a refit is
    damped by the size of its number.
    """
    places = {label: k for k, (label, _) in enumerate(base.labelled())}
    found: list[Free] = []
    for name in base.free:
        label, _, parameter = name.rpartition(".")
        share = base.tolerances.get(name)
        found += free_within(places[label], parameter, base.value(name), share)
    return tuple(found)


def free_within(
    place: int, name: str, value: Any, share: float | None
) -> Iterator[Free]:
    """Free a parameter, each of its numbers within a share of what it is.

    Without a share it goes anywhere. So does a zero alone; one among others stays.
    """
    many = isinstance(value, tuple)
    for element, number in enumerate(value if many else (value,)):
        if isinstance(number, str) or (many and share and not number):
            continue
        own = Free(place, name, element if many else None)
        if share and number:
            size = share * abs(number)
            ends = {"low": number - size, "high": number + size}
            own = own._replace(tolerance=size, given=number, **ends)
        yield own


def compared_records(state: ModelState) -> list[Compared]:
    """Simulate a model on its records, in free run, with what lies beside it."""
    outputs = [y.copy() for y in state.exact] if state.beside else state.exact
    each = state.by_signal(state.beside_amplitudes) if state.beside else []
    # The shapes over whole records, as the scored samples fit them.
    for (beside, values), rows in zip(state.beside, each, strict=True):
        for record, y, own in zip(state.records, outputs, rows, strict=True):
            y += beside.columns(record, values, beside.order) @ own
    pairs = zip(state.records, outputs, strict=True)
    return [Compared(record, y) for record, y in pairs]

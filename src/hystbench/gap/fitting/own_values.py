"""A delay, a gain and an offset that a record has of its own.

A trigger that fires late or an amplifier switched to another range is no law of the
device: it says nothing of the next record. So records may differ from each other by

    y(t) = gain * x(t - delay) + offset

with ``x`` what the simulator gives. Records share one such triple, the simulator's or
another; a record has its own where that lowers the score by more than its numbers are
charged. What the records share is left to the effects.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from hystbench.blocks.held import Hold
from hystbench.blocks.input_delay import InputDelay, later
from hystbench.gap.fitting.score import record_weight
from hystbench.gap.records.nuisance import FIRST
from hystbench.gap.thresholds import PARAMETER, PAYS, RECORD_WEIGHT, SCALE
from hystbench.record import FloatArray, Record

KINDS = ("delay", "gain", "offset")
LONGEST = 1 / 20
"""Share of a record that it may be late or early by, as for a delay that all share."""
FINER = 1e-3
"""Share of a sampling interval to which a delay is found."""
NEWTON = 8
"""Steps of Gauss and Newton to it, at most."""


class Own(NamedTuple):
    """By how much a record is late, and what its output is scaled and moved by."""

    delay_s: float = 0.0
    gain: float = 1.0
    offset: float = 0.0

    def of(self, signal: FloatArray, dt: float) -> FloatArray:
        """Give a simulated output as the record has it, shape (n,)."""
        return self.gain * later(signal, self.delay_s / dt) + self.offset

    def beside(self, other: Own) -> Own:
        """Give what comes after another triple to make this one."""
        ratio = self.gain / other.gain
        moved = self.offset - ratio * other.offset
        return Own(self.delay_s - other.delay_s, ratio, moved)


@dataclass(frozen=True)
class OwnValues:
    """What some records have of their own."""

    kinds: tuple[str, ...] = ()
    """Those of ``delay``, ``gain`` and ``offset`` in which records differ."""
    records: tuple[tuple[str, Own], ...] = ()
    """Records that differ from the others, each with its name."""
    share: float = 0.0
    """Share of the gap's power above the noise floor that it takes away."""

    @property
    def charge(self) -> float:
        """Charge in the score for all their numbers."""
        return PARAMETER * len(self.kinds) * len(self.records)

    def taken_off(self, records: Sequence[Record], hold: Hold) -> tuple[Record, ...]:
        """Give records as they would be without: the input late, the output scaled.

        So a simulator answers them as if it had been late itself.
        """
        known = dict(self.records)
        return tuple(
            _without(item, known[item.name], hold) if item.name in known else item
            for item in records
        )

    def mapping(self, unit: str) -> dict[str, Any] | None:
        """Give what gap.json holds under ``record_values``."""
        if not self.records:
            return None
        return {
            "kinds": list(self.kinds),
            "records": [{"name": name, **own._asdict()} for name, own in self.records],
            "share_of_gap_power": self.share,
            "sentence": self._sentence(unit),
        }

    @classmethod
    def of_mapping(cls, content: Mapping[str, Any] | None) -> OwnValues:
        """Give back what :meth:`mapping` gave."""
        if content is None:
            return NONE
        told = [
            (item["name"], Own(*(item[key] for key in Own._fields)))
            for item in content["records"]
        ]
        kinds, share = tuple(content["kinds"]), content["share_of_gap_power"]
        return cls(kinds, tuple(told), share)

    @property
    def scales(self) -> bool:
        """Whether responses differ in size: no late trigger and no zero makes that."""
        return "gain" in self.kinds

    @property
    def reason(self) -> str:
        """Say that it is a gap, though nothing else is left."""
        return (
            f"{self.words} of some records' own takes {100 * self.share:.0f} % of the "
            "gap's power, and its cause is in no record"
        )

    @property
    def words(self) -> str:
        """Name what it is, as ``a delay and a gain``."""
        articles = {"delay": "a delay", "gain": "a gain", "offset": "an offset"}
        return " and ".join(articles[kind] for kind in self.kinds)

    def fitted_first(self, record: Record, simulated: FloatArray, square: float) -> Own:
        """Fit the same to a hold-out record, to the part that is not scored.

        Nothing where it lowers the score by less than its numbers are charged.
        """
        record, simulated = record.as_measured, simulated[record.past :]
        until = round(FIRST * len(record))
        own = values_of_record(record, simulated, self.kinds, until)
        squares = [
            np.mean((record.y - one.of(simulated, record.dt))[:until] ** 2)
            for one in (Own(), own)
        ]
        gain = RECORD_WEIGHT * np.diff(-np.log(np.maximum(squares, square)))[0]
        return own if gain > PARAMETER * len(self.kinds) else Own()

    def _sentence(self, unit: str) -> str:
        each = "; ".join(
            f"{name} " + ", ".join(_said(kind, own, unit) for kind in self.kinds)
            for name, own in self.records
        )
        have, whose = ("has", "its") if len(self.records) == 1 else ("have", "their")
        return (
            f"{len(self.records)} of the fit records {have} {self.words} of {whose} "
            "own, which is known of no other record and takes "
            f"{100 * self.share:.0f} % of the gap's power above the noise floor on the "
            f"fit records: {each}. On each hold-out record the same is fitted to the "
            f"first {100 * FIRST:.0f} %, with the base and with the model alike, and "
            "the rest is scored."
        )


def _said(kind: str, own: Own, unit: str) -> str:
    if kind == "delay":
        return (
            f"{1e3 * abs(own.delay_s):.3g} ms {'late' if own.delay_s > 0 else 'early'}"
        )
    if kind == "gain":
        return f"gain {own.gain:.4g}"
    return f"offset {own.offset:.3g} {unit}"


NONE = OwnValues()


def own_values(
    records: Sequence[Record],
    simulated: Sequence[FloatArray],
    square: float,
    kinds: Sequence[str] = KINDS,
) -> OwnValues:
    """Find what records have of their own: those kinds and records that score least.

    Each record counts by ``W log(max(s, f))``, with ``s`` the mean square of its
    residual and ``f`` the floor, as in the score that ranks effects, and each number by
    its charge.

    Parameters
    ----------
    records : sequence of Record
    simulated : sequence of ndarray, shape (n,) each
    square : float
        Mean square of the noise.
    kinds : sequence of str
        Those that may differ.
    """
    pairs = [
        (record.as_measured, signal[record.past :])
        for record, signal in zip(records, simulated, strict=True)
    ]
    weight = record_weight(len(pairs))

    def costs(owns: Sequence[Own]) -> FloatArray:
        rests = (
            record.y - own.of(signal, record.dt)
            for (record, signal), own in zip(pairs, owns, strict=True)
        )
        squares = [float(np.mean(rest**2)) for rest in rests]
        return weight * np.log(np.maximum(squares, square))

    as_simulated = costs([Own()] * len(pairs))
    best, chosen = float(as_simulated.sum()), None
    if best - weight * len(pairs) * np.log(square) < PAYS:
        return NONE  # noise alone costs no less
    # With the most freedom first: what that does not gain, less cannot.
    for count in range(len(kinds), 0, -1):
        for some in combinations(kinds, count):
            each = [values_of_record(*pair, some) for pair in pairs]
            own = costs(each)
            if count == len(kinds) and best - own.sum() < PAYS:
                return NONE
            own += PARAMETER * count
            value = float(np.minimum(as_simulated, own).sum())
            if value < best:
                best, chosen = value, (some, each, own)
    if chosen is None:
        return NONE
    some, each, own = chosen
    charge = PARAMETER * len(some)
    shared, alike = Own(), as_simulated
    for one in each:
        like = costs([one] * len(pairs))
        value = float(np.minimum(like, own).sum()) + charge
        # On a tie the simulator's values stay, unless no record differs from ``one``.
        none_differs = bool((like <= own).all())
        if value < best + (STILL if none_differs else -STILL):
            best, shared, alike = value, one, like
    told = [
        (record.name, one.beside(shared))
        for record, one, mine, theirs in zip(records, each, own, alike, strict=True)
        if mine < theirs
    ]
    return OwnValues(some, tuple(told)) if told else NONE


STILL = 1e-6
"""Share of the score below which two are the same."""


def values_of_record(
    record: Record,
    simulated: FloatArray,
    kinds: Sequence[str],
    until: int | None = None,
) -> Own:
    """Fit a delay, a gain and an offset to a record, by least squares.

    Of delays that fit alike, as whole periods do, the shortest is taken.

    Parameters
    ----------
    record : Record
    simulated : ndarray, shape (n,)
    kinds : sequence of str
        The other ones stay as the simulator has them.
    until : int, optional
        Samples from the first on that count; by default all.
    """
    y = record.y[:until]

    def at(shift: float) -> tuple[float, Own]:
        x = later(simulated, shift)[:until]
        gain, offset = _scaled(x, y, kinds)
        rest = y - gain * x - offset
        return float(np.mean(rest**2)), Own(shift * record.dt, gain, offset)

    if "delay" not in kinds:
        return at(0.0)[1]
    longest = max(1, int(LONGEST * len(y)))
    shifts = np.arange(-longest, longest + 1)
    if len(shifts) > COARSE:
        shifts = np.unique(np.linspace(-longest, longest, COARSE).round().astype(int))
        shifts = np.unique([*shifts, *range(-NEAREST, NEAREST + 1)])
    squares = _squares(simulated, y, shifts, kinds)
    alike = squares <= squares.min() * np.exp(SCALE / RECORD_WEIGHT)
    alike |= squares <= ROUNDING * np.mean(y**2)
    place = int(np.flatnonzero(alike)[np.argmin(np.abs(shifts[alike]))])
    low, high = shifts[max(place - 1, 0)], shifts[min(place + 1, len(shifts) - 1)]
    shift = float(shifts[place])
    best = at(shift)
    for _ in range(NEWTON):
        own = best[1]
        x = own.of(simulated, record.dt)
        # Later by a sample, the signal is less by its slope.
        columns = [-np.gradient(x)[:until]]
        columns += [x[:until]] if "gain" in kinds else []
        columns += [np.ones(len(y))] if "offset" in kinds else []
        found = np.linalg.lstsq(np.column_stack(columns), y - x[:until], rcond=None)[0]
        moved = float(np.clip(shift + found[0], low, high))
        there = at(moved)
        if there[0] >= best[0] or abs(moved - shift) < FINER:
            break
        shift, best = moved, there
    return min(best, there, key=lambda item: item[0])[1]


COARSE, NEAREST = 401, 40
"""Delays that are tried first, and samples within which every one is."""
ROUNDING = 1e-12
"""Share of the output's power: what is below comes from the sums of
:func:`_squares`."""


def _squares(
    signal: FloatArray, y: FloatArray, shifts: NDArray[np.intp], kinds: Sequence[str]
) -> FloatArray:
    """Mean squares that whole delays leave, each with its best gain and offset.

    By sums over what each delay lays beside ``y``, for all delays at once.
    """
    count, reach = len(y), int(np.abs(shifts).max())
    if "offset" in kinds:
        signal, y = signal - signal.mean(), y - y.mean()
    rested = np.pad(signal, reach, mode="edge")
    at = reach - shifts
    size = fft.next_fast_len(len(rested), real=True)
    across = fft.rfft(rested, size) * fft.rfft(y, size).conj()
    products = fft.irfft(across, size)[at]
    powers = _running(rested**2, count)[at]
    if "offset" in kinds:
        powers = powers - _running(rested, count)[at] ** 2 / count
    gain = np.ones(len(shifts))
    if "gain" in kinds:
        np.divide(products, powers, out=gain, where=(powers > 0) & (products > 0))
    squares = y @ y - 2 * gain * products + gain**2 * powers
    return np.asarray(np.maximum(squares, 0) / count)


def _running(values: FloatArray, count: int) -> FloatArray:
    """Sum so many values in a row, from each on."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray(sums[count:] - sums[:-count])


def _scaled(x: FloatArray, y: FloatArray, kinds: Sequence[str]) -> tuple[float, float]:
    """Give the gain and the offset that fit best; the gain keeps its sign."""
    middle = (x.mean(), y.mean()) if "offset" in kinds else (0.0, 0.0)
    gain = 1.0
    if "gain" in kinds:
        power = float(np.sum((x - middle[0]) ** 2))
        product = float(np.sum((x - middle[0]) * (y - middle[1])))
        gain = product / power if power > 0 and product > 0 else 1.0
    return gain, float(middle[1] - gain * middle[0])


def _without(record: Record, own: Own, hold: Hold) -> Record:
    u = record.u
    if own.delay_s:
        u = InputDelay.by(own.delay_s, hold).simulate(u, u, record.dt)
    return replace(record, u=u, y=(record.y - own.offset) / own.gain)

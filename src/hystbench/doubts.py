"""What in a dataset is hardly meant: copies, a wrong unit of time, a wrong prefix.

A copy that is held out is refused. The rest are warnings, one line each, with what to
write in dataset.yaml where it is meant after all.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise

import numpy as np

from hystbench.copies import CommonPiece, Written, common_piece
from hystbench.dataset import CHANNELS, Dataset
from hystbench.errors import InputError
from hystbench.record import FloatArray, Record
from hystbench.spectra import fastest_hz
from hystbench.units import by_thousands, named_otherwise, plain, seconds

SLOWEST_HZ = 0.02
"""Fastest content of all records together: somewhere a test of an actuator goes faster
than a loop in 50 s. What is slower on purpose, such as a process, says so."""
LONGEST_S = 5400.0
"""An hour and a half: actuators are not tested for so long in one record."""
SHORTEST_STEP_S = 1e-7
"""A sampling rate of 10 MHz: recorders of displacement end there."""
THOUSAND = 1000 / 10**0.5
"""A factor that is nearer to a thousand than to a hundred."""
JUMPS, JUMP = 10, 0.02
"""Fewest lone steps of a staircase, and the share of the range that most of them
exceed."""
LEVELS = 5
"""A slow signal that a coarse encoder reads goes through more levels, a step each."""
IN_BAND = 0.99
"""Share of the input's power up to its fastest content."""
TIMES = ("ns", "us", "ms", "s", "min", "h")


def doubts(
    dataset: Dataset, records: Sequence[Record], about: str | None = None
) -> tuple[str, ...]:
    """Give warnings on records of one dataset.

    Parameters
    ----------
    dataset : Dataset
    records : sequence of Record
        Those that were read; more of them tell more.
    about : str, optional
        Only what concerns this record, and the dataset as a whole.

    Returns
    -------
    tuple of str
        One line each.

    Raises
    ------
    InputError
        If a record that is held out is also among those to fit, all of it or half of
        the shorter one, as it is or rounded.
    """
    concerned = [item for item in records if about in (None, item.name)]
    found = [*_other_columns(dataset), *_strange_time(dataset, concerned)]
    written = [Written.of(record) for record in records]
    for (one, its), (two, others) in combinations(
        zip(records, written, strict=True), 2
    ):
        if about not in (None, one.name, two.name):
            continue
        piece = common_piece(its, others)
        if piece is None:
            continue
        if one.use != two.use:
            _refuse_copy(dataset, one, two, piece)
        if not any("copy" in dataset.meant(item.name) for item in (one, two)):
            found.append(
                f"{_said(dataset, one, two, piece)}; it counts twice; leave one out, "
                "or where both are meant say 'meant: [copy]' of one of them in "
                "dataset.yaml"
            )
    for channel in ("input", "output"):
        found += _other_size(dataset, records, channel, about)
    found += _staircases(dataset, concerned)
    return tuple(found)


def _refuse_copy(
    dataset: Dataset, one: Record, two: Record, piece: CommonPiece
) -> None:
    if one.use == "fit":
        one, two, piece = two, one, piece.turned()
    raise InputError(
        f"{_said(dataset, one, two, piece)}, which is to be fitted; expected records "
        "held out that no fit has seen: measure another, or give both 'use: fit'"
    )


def _said(dataset: Dataset, one: Record, two: Record, piece: CommonPiece) -> str:
    files = dataset.record_files
    # One row is the header; a record of some 'rows' begins further down.
    begins = [dataset.entry(item.name).get("rows", (1,))[0] for item in (one, two)]
    row, other_row = piece.first + begins[0] + 1, piece.other_first + begins[1] + 1
    where = (
        f"equals {files[two.name].name}"
        if piece.samples == len(one) == len(two) and files[one.name] != files[two.name]
        else f"{piece.samples} of {len(one)} samples, from row {row} on, "
        f"equal those of {files[two.name].name} from row {other_row} on"
    )
    return f"{files[one.name]}: {where}{'' if piece.exact else ' up to rounding'}"


def _other_columns(dataset: Dataset) -> Iterator[str]:
    """Tell of columns whose names end with another unit than the one that is said."""
    for key in CHANNELS:
        about = dataset.about.get(key)
        if about is None or about.get("meant"):
            continue
        named = named_otherwise(about["column"], about["unit"])
        if named is not None:
            yield (
                f"{dataset.path}: {key}: unit: {plain(about['unit'])!r}, but the "
                f"column is called {about['column']!r}; write 'unit: {named}', or "
                f"where it is meant 'meant: true' beside it"
            )


def _strange_time(dataset: Dataset, records: Sequence[Record]) -> Iterator[str]:
    """Tell of times that no test of an actuator has, and of the unit that is likely."""
    about = dataset.about.get("time", {"meant": True})
    if about.get("meant") or not records:
        return
    if named_otherwise(about["column"], about["unit"]) is not None:
        return  # the column's name has told it
    # Slow records beside fast ones are what creep is measured with.
    slow = dataset.quantities.causality == "storage"  # as tanks and heated bodies are
    fastest = max(records, key=_fastest_hz)
    factor = seconds(f"{dataset.path}: time: unit", about["unit"])
    for record in (fastest, *(item for item in records if item is not fastest)):
        why = _absurd(record, 1.0, slow)
        crawls = not slow and _fastest_hz(record) < SLOWEST_HZ
        if record is fastest and why is None and crawls:
            hz = _fastest_hz(record)
            why = f"nothing in any record is faster than {hz:.2g} Hz"
        if why is None:
            continue
        likely = [
            unit
            for unit in TIMES
            if _absurd(record, seconds("", unit) / factor, slow) is None
            and (_fastest_hz(fastest) / (seconds("", unit) / factor) >= SLOWEST_HZ)
        ]
        likely.sort(key=lambda unit: abs(np.log(seconds("", unit) / factor)))
        guess = f"is it {likely[0]!r}? Then write 'unit: {likely[0]}', or " * bool(
            likely
        )
        yield (
            f"{dataset.path}: time: unit: {about['unit']!r}: {why} "
            f"({dataset.record_files[record.name].name}); {guess}where it is meant "
            "write 'meant: true' beside it"
        )
        return


def _absurd(record: Record, factor: float, slow: bool) -> str | None:
    """Tell what is strange of a record whose times are multiplied by a factor."""
    step, length = record.dt * factor, record.dt * factor * len(record)
    if length > LONGEST_S and not slow:
        return f"a record of {length / 3600:.3g} hours"
    if step < SHORTEST_STEP_S:
        return f"a record sampled at {1e-6 / step:.3g} MHz"
    return None


def _fastest_hz(record: Record) -> float:
    return fastest_hz(record.u, record.dt, IN_BAND)


def _staircases(dataset: Dataset, records: Sequence[Record]) -> Iterator[str]:
    """Tell of inputs that stand still and jump, where the input is said to move."""
    hold = dataset.input_hold
    for record in records:
        if hold == "zero-order" or "hold" in dataset.meant(record.name):
            continue
        if _is_staircase(record.u):
            yield (
                f"{dataset.record_files[record.name]}: the input stands still and "
                f"jumps, but between samples it is taken as {hold}; if a converter "
                "held it, write 'hold: zero-order' at input in dataset.yaml (for all "
                "records); if not, write 'meant: [hold]' at this record"
            )


def _is_staircase(u: FloatArray) -> bool:
    """Tell whether a signal stands still but for many lone jumps."""
    steps = np.diff(u)
    at = np.flatnonzero(steps)
    if len(at) < JUMPS:
        return False
    lone = np.diff(at) > 1
    sizes = np.abs(steps[at])
    coarse = len(np.unique(u)) > LEVELS and np.ptp(sizes) < 0.01 * sizes.max()
    return bool(np.all(lone) and np.mean(sizes > JUMP * np.ptp(u)) > 0.5 and not coarse)


def _other_size(
    dataset: Dataset, records: Sequence[Record], channel: str, only: str | None
) -> Iterator[str]:
    """Tell of records whose range is a thousand times that of the others, or less."""
    about = dataset.about[channel]
    signals = {"input": lambda item: item.u, "output": lambda item: item.y}
    sizes = [(float(np.ptp(signals[channel](item))), item.name) for item in records]
    ranges = sorted(pair for pair in sizes if pair[0] > 0)  # one may stand still
    steps = [high / low for (low, _), (high, _) in pairwise(ranges)]
    if not steps or max(steps) < THOUSAND:
        return
    cut = steps.index(max(steps)) + 1
    low, high = ranges[:cut], ranges[cut:]
    few, many = (low, high) if len(low) < len(high) else (high, low)
    for size, name in few:
        if only not in (None, name) or "amplitude" in dataset.meant(name):
            continue
        other = min(many, key=lambda item: abs(np.log(item[0] / size)))
        ratio = size / other[0]
        unit = plain(about["unit"])
        likely = by_thousands(unit, ratio)
        times = 10.0 ** (-3 * round(np.log10(ratio) / 3))
        guess = f"is it in {likely}? Then multiply it by {times:g}, or " * bool(likely)
        yield (
            f"{dataset.record_files[name]}: column {about['column']!r}: a range of "
            f"{size:.3g} {unit} where {dataset.record_files[other[1]].name} has "
            f"{other[0]:.3g} {unit}; {guess}where it is meant say "
            "'meant: [amplitude]' of this record in dataset.yaml"
        )

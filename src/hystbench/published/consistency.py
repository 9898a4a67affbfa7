"""Whether the printed errors of a signal can all be true.

MSE / RE^2 = mean(d^2) is a property of the measured displacement d alone, so the
rows of one signal must imply one RMS displacement within the rounding of their
digits. Intervals on a line share a point if and only if each two of them do.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations
from statistics import fmean
from typing import Literal

from hystbench.published import FILTERS, Interval, Pair, signals

Standing = Literal["yes", "no", "undecided"]


def common(intervals: Iterable[Interval]) -> Interval | None:
    """Intersect intervals; None where they share no point or there are none."""
    listed = list(intervals)
    if not listed:
        return None
    low = max(interval.low for interval in listed)
    high = min(interval.high for interval in listed)
    return Interval(low, high) if low <= high else None


def conflicts(intervals: Mapping[str, Interval]) -> tuple[tuple[str, str], ...]:
    """List the pairs of names whose intervals share no point."""
    return tuple(
        (one, other)
        for one, other in combinations(intervals, 2)
        if not intervals[one].meets(intervals[other])
    )


def smallest_removals(
    intervals: Mapping[str, Interval],
) -> dict[tuple[str, ...], Interval]:
    """Find ALL smallest sets of names whose removal leaves a common interval, and it.

    Every subset is tried, smallest first; the empty set alone is the answer where
    nothing conflicts.
    """
    for size in range(len(intervals)):
        left = {
            removed: common(v for name, v in intervals.items() if name not in removed)
            for removed in combinations(intervals, size)
        }
        if any(left.values()):
            return {removed: rest for removed, rest in left.items() if rest}
    return {}


@dataclass(frozen=True)
class SignalCheck:
    """What the filters' rows of one signal (Tables 1-3) say about each other."""

    intervals: dict[str, Interval]
    """RMS displacement (um) that the row of each model implies, RDGPI included."""
    conflicts: tuple[tuple[str, str], ...]
    """Filters whose rows cannot both be true."""
    removals: dict[tuple[str, ...], Interval]
    """All smallest sets of filters whose removal restores consistency, each with the
    RMS displacement (um) that is left."""

    @property
    def implied_rms(self) -> float:
        """RMS displacement (um) of the signal: the middle of what is left."""
        return fmean(each.middle for each in self.removals.values())

    def standing(self, model: str) -> Standing:
        """Tell whether a row agrees with the largest consistent set(s) of filters.

        A filter is out ("no") if every smallest removal names it, "undecided" if
        some do. The RDGPI stands in a table of its own (Table 4), so it has no vote:
        it is held against the RMS that the filters leave.
        """
        if model in FILTERS:
            disagrees = [model in removed for removed in self.removals]
        else:
            own = self.intervals[model]
            disagrees = [not own.meets(rms) for rms in self.removals.values()]
        if all(disagrees):
            return "no"
        return "undecided" if any(disagrees) else "yes"


def check_signal(pairs: Iterable[Pair]) -> SignalCheck:
    """Check the rows of one signal."""
    intervals = {pair.model: pair.rms for pair in pairs}
    filters = {name: v for name, v in intervals.items() if name in FILTERS}
    return SignalCheck(intervals, conflicts(filters), smallest_removals(filters))


def check(pairs: tuple[Pair, ...]) -> dict[str, SignalCheck]:
    """Check every signal of the tables."""
    return {
        signal: check_signal(pair for pair in pairs if pair.signal == signal)
        for signal in signals(pairs)
    }


def standings(pairs: tuple[Pair, ...]) -> dict[tuple[str, str], Standing]:
    """Tell for each signal and model whether its published pair is consistent."""
    checks = check(pairs)
    return {
        (pair.signal, pair.model): checks[pair.signal].standing(pair.model)
        for pair in pairs
    }

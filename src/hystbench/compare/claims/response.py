"""Claims on the actuator's response, read off the records."""

from __future__ import annotations

import numpy as np

from hystbench.compare.claims.claim import Finding, NotTestable, claim_on
from hystbench.compare.claims.statistics import (
    cycles,
    minor_turning_points,
    rank_correlation,
    turning_points,
)
from hystbench.compare.evidence import Evidence
from hystbench.published import signals, sine_frequency
from hystbench.record import FloatArray, Record

REMARKABLE = 0.1
"""Relative change of a peak-to-peak displacement that counts as one."""


def records(evidence: Evidence, names: list[str]) -> list[Record]:
    """Give the twin's records of these signals.

    Raises
    ------
    NotTestable
        If one is missing, or none is asked for.
    """
    if not names:
        raise NotTestable("none of the signals that it is about is asked for")
    for name in names:
        if name not in evidence.records:
            raise NotTestable(f"not run: record of {name}")
        if evidence.records[name].origin != "twin":
            raise NotTestable(f"the record of {name} is not the twin's")
    return [evidence.records[name] for name in names]


def sine_records(evidence: Evidence) -> list[Record]:
    """Give the records of the sines of Table 1; raises as :func:`records`."""
    found = [s for s in signals(evidence.published) if sine_frequency(s) is not None]
    return records(evidence, found)


def _table(evidence: Evidence, number: int) -> list[str]:
    return list(
        dict.fromkeys(p.signal for p in evidence.published if p.table == number)
    )


def chirp_record(evidence: Evidence) -> Record:
    """Give the record of the chirp; raises as :func:`records`."""
    return records(evidence, _table(evidence, 2))[0]


def settled(x: FloatArray) -> FloatArray:
    """Give the second half of a record."""
    return x[len(x) // 2 :]


@claim_on(
    "sines-major-loops",
    "'only major loops of the GMA are actuated by the discrete frequency sinusoidal "
    "signals'",
    "Section 4, Figure 8",
    "result",
    "in the second half of each record neither input nor output turns back farther "
    "than 10 % of its range from both ends of it",
    basis="built-in",
)
def sines_major_loops(evidence: Evidence) -> Finding:
    """Count the turns inside the major loop."""
    counts = {
        record.name: minor_turning_points(settled(record.u))
        + minor_turning_points(settled(record.y))
        for record in sine_records(evidence)
    }
    most = max(counts, key=lambda name: counts[name])
    return Finding(
        counts[most] == 0,
        f"at most {counts[most]} turns inside the range, over {len(counts)} sines",
    )


def _published_peak_to_peak(evidence: Evidence) -> Finding:
    rms = {
        frequency: (pair.rms.low + pair.rms.high) / 2
        for pair in evidence.published
        if pair.model == "backlash"
        and (frequency := sine_frequency(pair.signal)) is not None
    }
    return _change(rms, "implied RMS displacement")


def _change(sizes: dict[float, float], name: str) -> Finding:
    change = max(sizes.values()) / min(sizes.values()) - 1
    low, high = min(sizes), max(sizes)
    return Finding(
        change > REMARKABLE,
        f"{name} {sizes[low]:.4g} um at {low:g} Hz and {sizes[high]:.4g} um at "
        f"{high:g} Hz; largest over smallest {1 + change:.2f}",
    )


@claim_on(
    "peak-to-peak-changes",
    "'the peak-peak displacements change with increasing frequency'",
    "Section 4, Figure 8",
    "result",
    "over the sines the largest peak-to-peak displacement is more than 10 % above "
    "the smallest; theirs: the RMS displacement that the backlash rows imply",
    theirs=_published_peak_to_peak,
    basis="fitted",
)
def peak_to_peak_changes(evidence: Evidence) -> Finding:
    """Compare the displacements under the sines."""
    sizes = {
        float(sine_frequency(record.name) or 0): float(np.ptp(settled(record.y)))
        for record in sine_records(evidence)
    }
    return _change(sizes, "peak-to-peak displacement")


def chirp_extremes(
    evidence: Evidence,
) -> tuple[tuple[FloatArray, FloatArray, FloatArray], int, int]:
    """Give the cycles of the chirp, and its dip and the peak that follows.

    The dip is the smallest peak-to-peak displacement before the time that the paper
    gives for the resonance; the peak is the largest after the dip.
    """
    record = chirp_record(evidence)
    found = cycles(record.u, record.y, record.dt)
    time, _, size = found
    before = np.flatnonzero(time < evidence.text.chirp_resonance.time_s)
    dip = int(before[np.argmin(size[before])])
    return found, dip, dip + int(np.argmax(size[dip:]))


def time_tolerance(evidence: Evidence) -> float:
    """Half the time between the paper's dip and peak, so that they stay apart."""
    text = evidence.text
    return (text.chirp_resonance.time_s - text.chirp_minimum.time_s) / 2


@claim_on(
    "chirp-decrease",
    "'when the time is less than 1.28 s' the peak-to-peak displacement 'decreased "
    "with increasing frequency'",
    "Section 4, Figure 9",
    "result",
    "by cycles of the input: the dip lies within 0.065 s, half the time between the "
    "paper's dip and peak, of 1.28 s, and up to it the rank correlation with "
    "frequency is at most -0.9",
    basis="constrained",
)
def chirp_decrease(evidence: Evidence) -> Finding:
    """Follow the displacement of the chirp down to its dip."""
    (time, frequency, size), dip, _ = chirp_extremes(evidence)
    claimed = evidence.text.chirp_minimum.time_s
    trend = rank_correlation(list(frequency[: dip + 1]), list(size[: dip + 1]))
    near = abs(time[dip] - claimed) <= time_tolerance(evidence)
    return Finding(
        bool(near and trend <= -0.9),
        f"it goes from {size[0]:.3g} um to {size[dip]:.3g} um at {time[dip]:.2f} s "
        f"({frequency[dip]:.1f} Hz); rank correlation with frequency {trend:.2f}",
    )


@claim_on(
    "chirp-increase",
    "'A remarkable increase of the peak-peak displacement is observed near 1.41 s'",
    "Section 4, Figure 9",
    "result",
    "from the dip it rises by more than 10 %, to a peak within 0.065 s of 1.41 s",
    basis="constrained",
)
def chirp_increase(evidence: Evidence) -> Finding:
    """Find the peak after the dip."""
    (time, frequency, size), dip, peak = chirp_extremes(evidence)
    claimed = evidence.text.chirp_resonance.time_s
    near = abs(time[peak] - claimed) <= time_tolerance(evidence)
    return Finding(
        bool(near and size[peak] > (1 + REMARKABLE) * size[dip]),
        f"it rises from {size[dip]:.3g} um to {size[peak]:.3g} um at "
        f"{time[peak]:.2f} s ({frequency[peak]:.1f} Hz)",
    )


@claim_on(
    "chirp-oscillation",
    "the resonance 'causes oscillation of the displacement when the frequency "
    "continues to increase'",
    "Section 4, Figure 9",
    "result",
    "after the peak the peak-to-peak displacement turns two times or more, by more "
    "than 1 % each",
    basis="held-out",
)
def chirp_oscillation(evidence: Evidence) -> Finding:
    """Count the turns of the displacement after the peak."""
    (_, _, size), _, peak = chirp_extremes(evidence)
    after = size[peak:]
    if len(after) < 3:
        raise NotTestable("the chirp ends at its peak")
    turns = len(turning_points(after, 0.01 * float(size[peak])))
    return Finding(turns >= 2, f"it turns {turns} times after the peak")


@claim_on(
    "resonance",
    "'the first-order resonance frequency of 69.7 Hz of the GMA system'",
    "Section 4, Figure 9",
    "result",
    "read off the chirp, as the paper does: after its dip the peak-to-peak "
    "displacement is largest, before the end, within 3.15 Hz of 69.7 Hz, half the "
    "distance to the dip at 63.4 Hz; so fast a sweep peaks above the resonance itself",
    basis="constrained",
)
def resonance(evidence: Evidence) -> Finding:
    """Read the frequency of the peak off the chirp."""
    (_, frequency, size), dip, peak = chirp_extremes(evidence)
    text = evidence.text
    claimed = text.chirp_resonance.frequency_hz
    tolerance = (claimed - text.chirp_minimum.frequency_hz) / 2
    inside = dip < peak < len(size) - 1
    return Finding(
        bool(inside and abs(frequency[peak] - claimed) <= tolerance),
        f"after its dip at {frequency[dip]:.1f} Hz it is largest at "
        f"{frequency[peak]:.1f} Hz" + ("" if inside else ", which is no peak"),
    )


@claim_on(
    "nonlocal-memory",
    "under the sums of sines 'nonlocal memory effects were revealed'",
    "Section 4, Figures 10-12",
    "result",
    "input and output of each sum turn back inside their range, which closes minor "
    "loops",
    basis="built-in",
)
def nonlocal_memory(evidence: Evidence) -> Finding:
    """Count the turns of input and output inside their range."""
    counts = {
        record.name: (
            minor_turning_points(settled(record.u)),
            minor_turning_points(settled(record.y)),
        )
        for record in records(evidence, _table(evidence, 3))
    }
    return Finding(
        all(min(pair) > 0 for pair in counts.values()),
        "turns inside the range of input and output: "
        + "; ".join(f"{u} and {y} on {name}" for name, (u, y) in counts.items()),
    )

"""Claims on the actuator's response and on the signals that drive it.

All is read off the records: what the input holds, and what the output does.
"""

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
        If one is missing.
    """
    for name in names:
        if name not in evidence.records:
            raise NotTestable(f"not run: record of {name}")
        if evidence.records[name].origin != "twin":
            raise NotTestable(f"the record of {name} is not the twin's")
    return [evidence.records[name] for name in names]


def _sine_records(evidence: Evidence) -> list[Record]:
    found = [s for s in signals(evidence.published) if sine_frequency(s) is not None]
    return records(evidence, found)


def _table(evidence: Evidence, number: int) -> list[str]:
    return list(
        dict.fromkeys(p.signal for p in evidence.published if p.table == number)
    )


def _chirp_record(evidence: Evidence) -> Record:
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
)
def sines_major_loops(evidence: Evidence) -> Finding:
    """Count the turns inside the major loop."""
    counts = {
        record.name: minor_turning_points(settled(record.u))
        + minor_turning_points(settled(record.y))
        for record in _sine_records(evidence)
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
)
def peak_to_peak_changes(evidence: Evidence) -> Finding:
    """Compare the displacements under the sines."""
    sizes = {
        float(sine_frequency(record.name) or 0): float(np.ptp(settled(record.y)))
        for record in _sine_records(evidence)
    }
    return _change(sizes, "peak-to-peak displacement")


def chirp_extremes(
    evidence: Evidence,
) -> tuple[tuple[FloatArray, FloatArray, FloatArray], int, int]:
    """Give the cycles of the chirp, and its dip and the peak that follows.

    The dip is the smallest peak-to-peak displacement before the time that the paper
    gives for the resonance; the peak is the largest after the dip.
    """
    record = _chirp_record(evidence)
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
)
def chirp_oscillation(evidence: Evidence) -> Finding:
    """Count the turns of the displacement after the peak."""
    (_, _, size), _, peak = chirp_extremes(evidence)
    after = size[peak:]
    if len(after) < 3:
        raise NotTestable("the chirp ends at its peak")
    turns = len(turning_points(after, 0.01 * float(size[peak])))
    return Finding(turns >= 2, f"it turns {turns} times after the peak")


def _published_chirp_rate(evidence: Evidence) -> Finding:
    text = evidence.text
    rates = [
        (moment.frequency_hz - text.chirp_from_hz) / moment.time_s
        for moment in (text.chirp_minimum, text.chirp_resonance)
    ]
    return Finding(
        abs(rates[1] / rates[0] - 1) < 0.01,
        f"a linear chirp from {text.chirp_from_hz:g} Hz reaches them at "
        f"{rates[0]:.2f} and {rates[1]:.2f} Hz/s",
    )


@claim_on(
    "chirp-times",
    "1.28 s is 'a frequency of about 63.4 Hz', 1.41 s 'about 69.7 Hz'",
    "Section 4, Figure 9",
    "condition",
    "the input's frequency at both times, by its cycles, is within 1 % of them; "
    "theirs: both give one sweep rate within 1 %",
    theirs=_published_chirp_rate,
)
def chirp_times(evidence: Evidence) -> Finding:
    """Read the frequency of the chirp at both times."""
    record = _chirp_record(evidence)
    time, frequency, _ = cycles(record.u, record.y, record.dt)
    text = evidence.text
    told = [
        (m, float(np.interp(m.time_s, time, frequency)))
        for m in (text.chirp_minimum, text.chirp_resonance)
    ]
    return Finding(
        all(abs(found / m.frequency_hz - 1) <= 0.01 for m, found in told),
        "; ".join(f"{found:.1f} Hz at {m.time_s:g} s" for m, found in told),
    )


@claim_on(
    "resonance",
    "'the first-order resonance frequency of 69.7 Hz of the GMA system'",
    "Section 4, Figure 9",
    "result",
    "read off the chirp, as the paper does: after its dip the peak-to-peak "
    "displacement is largest, before the end, within 3.15 Hz of 69.7 Hz, half the "
    "distance to the dip at 63.4 Hz; so fast a sweep peaks above the resonance itself",
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


@claim_on(
    "sampling",
    "'The sampling frequency was set to 10 kHz'",
    "Section 4",
    "condition",
)
def sampling(evidence: Evidence) -> Finding:
    """Read the sampling rate of the twin's records."""
    twin = [r for r in evidence.records.values() if r.origin == "twin"]
    if not twin:
        raise NotTestable("not run: records")
    rates = sorted({round(1 / record.dt, 6) for record in twin})
    return Finding(
        rates == [evidence.text.sampling_hz],
        f"{', '.join(f'{rate:g}' for rate in rates)} Hz in {len(twin)} records",
    )


@claim_on(
    "amplitude",
    "sines and chirp have 'amplitudes of 0.632 A'",
    "Section 4",
    "condition",
    "half the range of the input is within 0.5 % of it",
)
def amplitude(evidence: Evidence) -> Finding:
    """Read the amplitude of sines and chirp."""
    found = [*_sine_records(evidence), _chirp_record(evidence)]
    sizes = [float(np.ptp(record.u)) / 2 for record in found]
    units = sorted({record.input.unit for record in found})
    wanted = evidence.text.amplitude_a
    return Finding(
        units == ["A"] and all(abs(size / wanted - 1) <= 0.005 for size in sizes),
        f"{min(sizes):.4g} to {max(sizes):.4g} {', '.join(units)} in {len(found)} "
        "records",
    )


@claim_on(
    "sums-lines",
    "two sums are 0.1, 0.2, 0.3 at 10, 30, 50 Hz and 0.12 each at 5, 25, 50, 75, "
    "100 Hz",
    "Section 4",
    "condition",
    "the spectral lines of the input have these ratios within 1 %; their unit is not "
    "printed",
)
def sums_lines(evidence: Evidence) -> Finding:
    """Project the inputs of both sums on their sines."""
    worst = 0.0
    scales = []
    for name, lines in evidence.text.sums.items():
        (record,) = records(evidence, [name])
        found = {f: line_amplitude(record, f) for f in lines}
        scale = sum(found.values()) / sum(lines.values())
        scales.append(f"{scale:.4g} {record.input.unit} on {name}")
        worst = max(worst, *(abs(found[f] / (scale * a) - 1) for f, a in lines.items()))
    return Finding(
        worst <= 0.01,
        f"ratios off by at most {100 * worst:.2g} %; one unit of the paper is "
        + ", ".join(scales),
    )


def line_amplitude(record: Record, frequency: float) -> float:
    """Amplitude of the input at one frequency, over whole cycles of 5 Hz."""
    samples = round(0.2 / record.dt)
    whole = len(record) // samples * samples
    if whole == 0:
        raise NotTestable(f"the record of {record.name} is shorter than 0.2 s")
    phase = 2 * np.pi * frequency * np.arange(whole) * record.dt
    return float(2 * np.abs(np.mean(record.u[:whole] * np.exp(-1j * phase))))


@claim_on(
    "random-band",
    "the random sum contains 0-100 Hz, 'set as [0.0 0.02]' of the Nyquist frequency",
    "Section 4, Figure 12",
    "condition",
    "99 % or more of the input's power lies in the band",
)
def random_band(evidence: Evidence) -> Finding:
    """Measure the power of the random sum in its band."""
    (record,) = records(evidence, ["multisine-random-0-100hz"])
    limit = evidence.text.random_band_of_nyquist[1] * evidence.text.sampling_hz / 2
    power = np.abs(np.fft.rfft(record.u - record.u.mean())) ** 2
    frequency = np.fft.rfftfreq(len(record), record.dt)
    inside = float(power[frequency <= limit * (1 + 1e-9)].sum() / power.sum())
    return Finding(
        inside >= 0.99, f"{100 * inside:.2f} % of the power up to {limit:g} Hz"
    )

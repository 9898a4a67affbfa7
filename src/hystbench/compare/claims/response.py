"""Measures of the signals and of the actuator's response, read off the records."""

from collections.abc import Iterable, Sequence

import numpy as np

from hystbench.compare.claims.claim import NotTestable, Numbers
from hystbench.compare.claims.statistics import (
    cycles,
    minor_turning_points,
    rank_correlation,
    turning_points,
)
from hystbench.compare.runs import ClaimEvidence
from hystbench.published import signals, sines
from hystbench.record import FloatArray, Record

#: The sum of sines of random phases.
RANDOM = "multisine-random-0-100hz"


def records(evidence: ClaimEvidence, names: Iterable[str]) -> list[Record]:
    """Give the twin's records of these signals.

    Raises
    ------
    NotTestable
        If one is missing, or none is asked for.
    """
    names = list(names)
    if not names:
        raise NotTestable("none of the signals that it is about is asked for")
    for name in names:
        if name not in evidence.records:
            raise NotTestable(f"not run: record of {name}")
    return [evidence.records[name] for name in names]


def sine_records(evidence: ClaimEvidence) -> list[Record]:
    """Give the records of the sines of Table 1; raises as :func:`records`."""
    known = sines(evidence.published)
    return records(evidence, [s for s in signals(evidence.published) if s in known])


def chirp_record(evidence: ClaimEvidence) -> Record:
    """Give the record of the chirp; raises as :func:`records`."""
    return records(evidence, signals(evidence.published, 2))[0]


def settled(x: FloatArray) -> FloatArray:
    """Give the second half of a record."""
    return x[len(x) // 2 :]


def chirp_rates(evidence: ClaimEvidence) -> Numbers:
    """Take the sweep rate that each of the two printed moments implies."""
    first, second = evidence.text.chirp_rates
    return {
        "from_hz": evidence.text.chirp_from_hz,
        "first": first,
        "second": second,
        "apart": abs(second / first - 1),
    }


def sampling_rates(evidence: ClaimEvidence) -> Numbers:
    """Read the sampling rates of the twin's records."""
    if not evidence.records:
        raise NotTestable("not run: records")
    rates = sorted({round(1 / record.dt, 6) for record in evidence.records.values()})
    return {
        "off": max(abs(rate - evidence.text.sampling_hz) for rate in rates),
        "rates": ", ".join(f"{rate:g}" for rate in rates),
        "records": len(evidence.records),
    }


def input_amplitudes(evidence: ClaimEvidence) -> Numbers:
    """Read the amplitude of sines and chirp."""
    found = [*sine_records(evidence), chirp_record(evidence)]
    sizes = [float(np.sqrt(2) * record.u.std()) for record in found]
    units = sorted({record.input.unit for record in found})
    wanted = evidence.text.amplitude_a
    return {
        "off": max(abs(size / wanted - 1) for size in sizes),
        "low": min(sizes),
        "high": max(sizes),
        "units": ", ".join(units),
        "other_units": len(set(units) - {"A"}),
        "records": len(found),
    }


def input_lines(evidence: ClaimEvidence) -> Numbers:
    """Project the inputs of both sums on their sines."""
    worst = 0.0
    scales = []
    for name, lines in evidence.text.sums.items():
        (record,) = records(evidence, [name])
        found = {f: line_amplitude(record, f) for f in lines}
        scale = sum(found.values()) / sum(lines.values())
        scales.append(f"{scale:.4g} {record.input.unit} on {name}")
        worst = max(worst, *(abs(found[f] / (scale * a) - 1) for f, a in lines.items()))
    return {"worst": worst, "scales": ", ".join(scales)}


def line_amplitude(record: Record, frequency: float) -> float:
    """Amplitude of the input at one frequency, over whole cycles of 5 Hz."""
    samples = round(0.2 / record.dt)
    whole = len(record) // samples * samples
    if whole == 0:
        raise NotTestable(f"the record of {record.name} is shorter than 0.2 s")
    phase = 2 * np.pi * frequency * np.arange(whole) * record.dt
    return float(2 * np.abs(np.mean(record.u[:whole] * np.exp(-1j * phase))))


def power_in_band(evidence: ClaimEvidence) -> Numbers:
    """Measure the power of the random sum in its band."""
    (record,) = records(evidence, [RANDOM])
    limit = evidence.text.random_band_of_nyquist[1] * evidence.text.sampling_hz / 2
    power = np.abs(np.fft.rfft(record.u - record.u.mean())) ** 2
    frequency = np.fft.rfftfreq(len(record), record.dt)
    inside = float(power[frequency <= limit * (1 + 1e-9)].sum() / power.sum())
    return {"inside": inside, "limit": limit}


def turns(evidence: ClaimEvidence, tables: Sequence[int]) -> Numbers:
    """Count the turns of input and output inside their range: minor loops."""
    counts = {
        r.name: [minor_turning_points(settled(x)) for x in (r.u, r.y)]
        for r in records(evidence, signals(evidence.published, *tables))
    }
    return {
        "most": max(map(sum, counts.values())),
        "fewest": min(map(min, counts.values())),
        "records": len(counts),
        "told": "; ".join(f"{u} and {y} on {name}" for name, (u, y) in counts.items()),
    }


def sizes_over_frequency(evidence: ClaimEvidence, of: str = "twin") -> Numbers:
    """Compare displacements under the sines, our own or those implied by Table 1."""
    hz = sines(evidence.published)
    if of == "published":
        name = "implied RMS displacement"
        pairs = [pair for pair in evidence.published if pair.model == "backlash"]
        found = {pair.signal: pair.rms.middle for pair in pairs if pair.signal in hz}
    else:
        name = "peak-to-peak displacement"
        shown = sine_records(evidence)
        found = {record.name: float(np.ptp(settled(record.y))) for record in shown}
    sizes = {hz[signal]: size for signal, size in found.items()}
    low, high = min(sizes), max(sizes)
    change = max(sizes.values()) / min(sizes.values()) - 1
    return {
        "name": name,
        "change": change,
        "ratio": 1 + change,
        "low": low,
        "high": high,
        "at_low": sizes[low],
        "at_high": sizes[high],
    }


def _chirp_extremes(
    evidence: ClaimEvidence,
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


def chirp_shape(evidence: ClaimEvidence) -> Numbers:
    """Find the dip and the peak of the chirp's displacement, beside the paper's.

    The input's frequencies are read at the two times of the paper. The tolerances are
    half the distances between the paper's dip and peak, so that the two stay apart.
    """
    (time, frequency, size), dip, peak = _chirp_extremes(evidence)
    low, high = evidence.text.chirp_minimum, evidence.text.chirp_resonance
    told = [(m, float(np.interp(m.time_s, time, frequency))) for m in (low, high)]
    inside = dip < peak < len(size) - 1
    return {
        "tolerance_s": (high.time_s - low.time_s) / 2,
        "tolerance_hz": (high.frequency_hz - low.frequency_hz) / 2,
        "dip_off_s": abs(time[dip] - low.time_s),
        "peak_off_s": abs(time[peak] - high.time_s),
        "peak_off_hz": abs(frequency[peak] - high.frequency_hz),
        "off": max(abs(found / m.frequency_hz - 1) for m, found in told),
        "told": "; ".join(f"{found:.1f} Hz at {m.time_s:g} s" for m, found in told),
        "inside": inside,
        "note": "" if inside else ", which is no peak",
        "trend": rank_correlation(list(frequency[: dip + 1]), list(size[: dip + 1])),
        "start_size": size[0],
        "dip_s": time[dip],
        "dip_hz": frequency[dip],
        "dip_size": size[dip],
        "peak_s": time[peak],
        "peak_hz": frequency[peak],
        "peak_size": size[peak],
    }


def turns_after_peak(evidence: ClaimEvidence) -> Numbers:
    """Count the turns of the chirp's displacement after the peak, beyond 1 % of it."""
    (_, _, size), _, peak = _chirp_extremes(evidence)
    after = size[peak:]
    if len(after) < 3:
        raise NotTestable("the chirp ends at its peak")
    return {"turns": len(turning_points(after, 0.01 * float(size[peak])))}

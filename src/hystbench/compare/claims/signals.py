"""Claims on the signals that drive the actuator, read off the records' inputs."""

from __future__ import annotations

import numpy as np

from hystbench.compare.claims.claim import Finding, NotTestable, claim_on
from hystbench.compare.claims.response import (
    chirp_record,
    records,
    sine_records,
)
from hystbench.compare.claims.statistics import cycles
from hystbench.compare.evidence import Evidence
from hystbench.record import Record


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
    basis="built-in",
)
def chirp_times(evidence: Evidence) -> Finding:
    """Read the frequency of the chirp at both times."""
    record = chirp_record(evidence)
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
    "sampling",
    "'The sampling frequency was set to 10 kHz'",
    "Section 4",
    "condition",
    basis="built-in",
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
    "the RMS of the input about its mean, times the root of 2, is within 1 % of it",
    basis="built-in",
)
def amplitude(evidence: Evidence) -> Finding:
    """Read the amplitude of sines and chirp."""
    found = [*sine_records(evidence), chirp_record(evidence)]
    sizes = [float(np.sqrt(2) * record.u.std()) for record in found]
    units = sorted({record.input.unit for record in found})
    wanted = evidence.text.amplitude_a
    return Finding(
        units == ["A"] and all(abs(size / wanted - 1) <= 0.01 for size in sizes),
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
    basis="built-in",
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
    basis="built-in",
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

"""The records that a laboratory would take, as functions of continuous time.

Every command starts at zero and without a jump, and holds nothing near half the
sampling rate: what the plant saw between two samples is the band-limited curve through
them. The nominal rate of machines is 4 kHz: one that is sampled at another rate sees
the same samples.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hystbench.challenge.plant.actuator import cubic
from hystbench.challenge.plant.hysteresis import LARGEST_CURRENT
from hystbench.record import FloatArray, Use

Function = Callable[[FloatArray], FloatArray]

#: Sampling rates of the slower and of the faster records. No line lies above a tenth
#: of the rate, so that a model which knows the samples alone does not miss the turning
#: points.
SLOW_HZ, FAST_HZ = 2000.0, 4000.0
#: Samples of a multisine's period.
PERIOD_SAMPLES = 2000
#: Points of a period's table for each sample of the record.
TABLE_POINTS = 32
#: Length of a switch-on and of the edge of a step: at least so long, in seconds and
#: in samples.
EDGE_S, EDGE_SAMPLES = 0.02, 12
#: Of machines: samples of a record to fit, of one held out, and of a multisine's
#: period, and how many times shorter that is than the others'.
FIT, HELD_OUT, PERIOD = 1500, 1000, 500
FASTER = PERIOD_SAMPLES / PERIOD


@dataclass(frozen=True)
class RecordCommand:
    """One record's command."""

    use: Use
    name: str
    rate_hz: float
    """Sampling rate."""
    samples: int
    function: Function
    """Command in A at any times in s."""
    period_samples: int | None = None
    """Period of what follows the switch-on."""

    @property
    def dt(self) -> float:
        """Sampling interval in seconds."""
        return 1.0 / self.rate_hz

    def __call__(self, time: FloatArray) -> FloatArray:
        """Compute the command; zero before the start, and switched on smoothly."""
        fade = max(EDGE_S, EDGE_SAMPLES * self.dt)
        switch = 0.5 - 0.5 * np.cos(np.pi * np.clip(time / fade, 0.0, 1.0))
        return np.asarray(switch * self.function(np.maximum(time, 0.0)))

    def sampled(self) -> FloatArray:
        """Command at the record's samples."""
        return self(np.asarray(np.arange(self.samples) * self.dt, dtype=np.float64))


def sine(frequency: float, amplitude: float, bias: float = 0.0) -> Function:
    """Sine about a bias."""
    return lambda t: bias + amplitude * np.sin(2.0 * np.pi * frequency * t)


def chirp(low: float, high: float, amplitude: float, seconds: float) -> Function:
    """Sine whose frequency rises evenly in its logarithm."""
    rate = np.log(high / low) / seconds
    return lambda t: amplitude * np.sin(2.0 * np.pi * low * np.expm1(rate * t) / rate)


def multisine(
    random: np.random.Generator,
    low: float,
    high: float,
    peak: float,
    colour: float = 0.0,
    odd: bool = False,
) -> Function:
    """Random-phase multisine of a period of half a second, a line each 2 Hz.

    Parameters
    ----------
    low, high : float
        Band in Hz.
    peak : float
        Largest magnitude in A; of 20 draws of the phases the flattest is taken.
    colour : float
        Amplitudes go with frequency to the power of minus this.
    odd : bool
        Only odd lines: even distortion then falls between them.
    """
    seconds = PERIOD_SAMPLES / FAST_HZ
    lines = np.arange(max(1, np.ceil(low * seconds)), high * seconds + 1e-9, dtype=int)
    if odd:
        lines = lines[lines % 2 == 1]
    flattest, kept = np.inf, np.zeros(1, dtype=complex)
    for _ in range(20):
        spectrum = np.zeros(lines[-1] + 1, dtype=complex)
        phases = random.uniform(0.0, 2.0 * np.pi, len(lines))
        spectrum[lines] = lines ** (-colour) * np.exp(1j * phases)
        values = np.fft.irfft(spectrum, 4 * PERIOD_SAMPLES)
        crest = float(np.abs(values).max() / np.sqrt(np.mean(values**2)))
        if crest < flattest:
            flattest, kept = crest, spectrum
    table = np.fft.irfft(kept, PERIOD_SAMPLES * TABLE_POINTS)
    table *= peak / np.abs(table).max()
    return lambda t: _periodic(table, t, seconds)


def _periodic(table: FloatArray, time: FloatArray, seconds: float) -> FloatArray:
    """Read a period's table between its points by the cubic through four."""
    place = (time / seconds % 1.0) * len(table)
    k = np.floor(place + 1e-7).astype(np.int64)
    wide = np.concatenate([table[-1:], table, table[:3]])
    return cubic(wide, k + 1, place - k)


def staircase(levels: Sequence[float], hold: float, edge: float) -> Function:
    """Levels held in turn, with edges that are half a cosine."""
    values = np.asarray(levels, dtype=np.float64)

    def function(t: FloatArray) -> FloatArray:
        k = np.minimum((t / hold).astype(int), len(values) - 1)
        share = np.clip((t - k * hold) / edge, 0.0, 1.0)
        before = np.where(k > 0, values[np.maximum(k - 1, 0)], 0.0)
        return np.asarray(
            before + (values[k] - before) * (0.5 - 0.5 * np.cos(np.pi * share))
        )

    return function


def triangle(frequency: float, amplitude: float) -> Function:
    """Triangle of its first eight odd harmonics: round at the corners."""
    orders = np.arange(1, 17, 2)
    weights = (-1.0) ** ((orders - 1) // 2) / orders**2
    scale = amplitude / np.sum(1.0 / orders**2)

    def function(t: FloatArray) -> FloatArray:
        total = np.zeros_like(t)
        for order, weight in zip(orders, weights, strict=True):
            total += weight * np.sin(2.0 * np.pi * frequency * order * t)
        return scale * total

    return function


def ringing(frequency: float, amplitude: float, decay: float) -> Function:
    """Sine that dies out: nested loops."""
    return lambda t: (
        amplitude * np.exp(-t / decay) * np.sin(2.0 * np.pi * frequency * t)
    )


def add(*functions: Function) -> Function:
    """Sum of commands."""
    return lambda t: np.asarray(sum(function(t) for function in functions))


def _levels(random: np.random.Generator, count: int, largest: float) -> list[float]:
    """Levels mostly high and low by turns; one of them is the largest."""
    sizes = random.uniform(0.1, 1.0, count)
    sizes *= largest / sizes.max()
    signs = np.where(random.uniform(size=count) < 0.3, 1.0, (-1.0) ** np.arange(count))
    return [float(value) for value in sizes * signs]


fit, held_out = partial(RecordCommand, "fit"), partial(RecordCommand, "hold-out")


def standard(random: np.random.Generator) -> tuple[RecordCommand, ...]:
    """Eight records to fit and four held out, 70,000 samples in all."""
    low = int(random.choice([8, 10, 16, 20]))
    high = int(random.choice([80, 100, 125]))
    ripple = float(random.choice([5.0, 8.0, 10.0]))
    uniform, tones = random.uniform, partial(multisine, random, 2)
    levels = partial(_levels, random)
    slow = add(
        staircase(levels(8, 0.4), 6.0, 0.3),
        sine(uniform(0.3, 1.0), uniform(0.05, 0.2)),
    )
    sine_low = sine(low, uniform(0.45, 0.6))
    sine_high = sine(high, uniform(0.2, 0.35))
    wide = tones(400, uniform(0.2, 0.3))
    strong = tones(200, uniform(0.45, 0.6), colour=0.3)
    minor = add(staircase(levels(6, 0.4), 0.67, 0.1), sine(ripple, uniform(0.06, 0.18)))
    return (
        fit("slow-loop", SLOW_HZ, 6000, sine(1.0, LARGEST_CURRENT), 2000),
        fit("sine-low", SLOW_HZ, 4000, sine_low, int(SLOW_HZ) // low),
        fit("sine-high", FAST_HZ, 4000, sine_high, int(FAST_HZ) // high),
        fit("multisine-wide", FAST_HZ, 8000, wide, 2000),
        fit("multisine-strong", FAST_HZ, 8000, strong, 2000),
        fit("minor-loops", SLOW_HZ, 8000, minor),
        fit("steps", 500.0, 6000, staircase(levels(8, 0.6), 1.5, 0.03)),
        fit("long", 125.0, 6000, slow),
        held_out("chirp", FAST_HZ, 6000, chirp(2.0, 300.0, uniform(0.2, 0.4), 1.5)),
        held_out("multisine-other", FAST_HZ, 6000, tones(320, uniform(0.3, 0.5)), 2000),
        held_out(
            "two-tones",
            SLOW_HZ,
            4000,
            add(sine(2.0, uniform(0.45, 0.5)), sine(43.0, uniform(0.06, 0.1))),
        ),
        held_out("steps-other", 250.0, 4000, staircase(levels(9, 0.6), 1.78, 0.06)),
    )


def other(random: np.random.Generator) -> tuple[RecordCommand, ...]:
    """Seven records to fit and three held out, of another laboratory."""
    uniform, tones = random.uniform, partial(multisine, random, 2)
    levels = partial(_levels, random)
    sweep = chirp(2.0, 380.0, uniform(0.25, 0.35), 2.0)
    strong = chirp(0.8, 90.0, uniform(0.5, 0.6), 3.0)
    pink = tones(400, uniform(0.4, 0.6), colour=0.7, odd=True)
    biased = add(
        staircase(levels(4, 0.35), 0.76, 0.12),
        sine(27.0, uniform(0.06, 0.15)),
        sine(6.0, uniform(0.03, 0.08)),
    )
    walk = add(staircase(levels(12, 0.5), 4.0, 0.2), sine(uniform(0.3, 0.8), 0.08))
    white = tones(300, uniform(0.3, 0.5))
    beats = add(sine(31.0, uniform(0.2, 0.3)), sine(34.0, uniform(0.2, 0.3)))
    return (
        fit("triangle", SLOW_HZ, 12000, triangle(0.5, LARGEST_CURRENT), 4000),
        fit("ringing", SLOW_HZ, 6000, ringing(4.0, 0.58, 0.8)),
        fit("sweep", FAST_HZ, 8000, sweep),
        fit("sweep-strong", SLOW_HZ, 6000, strong),
        fit("pink", FAST_HZ, 8000, pink, 2000),
        fit("biased-tones", SLOW_HZ, 6000, biased),
        fit("walk", 125.0, 6000, walk),
        held_out("white", FAST_HZ, 8000, white, 2000),
        held_out("beats", SLOW_HZ, 6000, beats, 2000),
        held_out("walk-other", 250.0, 4000, staircase(levels(12, 0.55), 1.4, 0.06)),
    )


CAMPAIGNS = {"standard": standard, "other": other}


def _tones(
    random: np.random.Generator, low: float, high: float, peak: float
) -> Function:
    """Multisine whose period is five hundred samples."""
    function = multisine(random, low / FASTER, high / FASTER, peak)
    return lambda t: function(FASTER * t)


def _steps(
    random: np.random.Generator, count: int, seconds: float, edge: float
) -> Function:
    levels = random.uniform(0.3, 1.0, count) * (-1.0) ** np.arange(count)
    levels *= 0.9 / np.abs(levels).max()
    return staircase([float(level) for level in levels], seconds, edge)


def machine_records(
    random: np.random.Generator, middle: float
) -> tuple[RecordCommand, ...]:
    """Four records to fit and two held out, of levels up to about one.

    Parameters
    ----------
    random : numpy.random.Generator
    middle : float
        Frequency in Hz, at 4 kHz, about which the machine is to be moved.
    """
    low, high = middle / 6.0, 2.5 * middle
    edge = 0.2 / middle
    two = add(sine(0.37 * middle, 0.5), sine(1.1 * middle, 0.35))
    return (
        fit("multisine-low", FAST_HZ, FIT, _tones(random, low, high, 0.35), PERIOD),
        fit("multisine-high", FAST_HZ, FIT, _tones(random, low, high, 1.0), PERIOD),
        fit("sweep", FAST_HZ, FIT, chirp(low, 2.0 * middle, 0.7, FIT / FAST_HZ)),
        fit("steps", FAST_HZ, FIT, _steps(random, 10, FIT / FAST_HZ / 10, edge)),
        held_out("multisine-other", FAST_HZ, HELD_OUT, _tones(random, low, high, 0.85)),
        held_out("two-tones", FAST_HZ, HELD_OUT, two),
    )


def filling(random: np.random.Generator, middle: float) -> tuple[RecordCommand, ...]:
    """Inflows of a tank, none of them below zero, in the same order."""

    def raised(function: Function, most: float) -> Function:
        return lambda t: np.asarray(most * (0.55 + 0.45 * function(t)))

    levels = (0.6, 1.0, 0.9, 1.0, 0.95, 0.8)
    records = machine_records(random, middle)
    return tuple(
        replace(item, function=raised(item.function, most))
        for item, most in zip(records, levels, strict=True)
    )

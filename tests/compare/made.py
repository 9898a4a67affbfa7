"""Synthetic evidence: runs, records and identifications made to measure."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from hystbench.compare.runs import Run
from hystbench.published import load_errors, load_text, signals, sine_frequency
from hystbench.record import Channel, Record

TEXT = load_text()
PAIRS = load_errors()
RATE = 48.74  # Hz/s of the chirp


def make_run(signal: str, model: str, mse: float | None, **changes) -> Run:
    """Make a run; an MSE of None is a diverged run."""
    re = None if mse is None else mse**0.5 / 10
    run = Run(
        signal=signal,
        model=model,
        origin="twin",
        error_kind="free-run simulation",
        unit="um^2",
        diverged="diverged at sample 7, mu = 1" if mse is None else None,
        mse=mse,
        re=re,
        mse_after_transient=mse,
        re_after_transient=re,
        convergence_s=0.1 if mse is not None else None,
    )
    if model != "rdgpi":
        two = ("first_order", "second_order")
        names = two if model == "volterra" else ("mu",)
        sizes = dict(zip(names, (0.1, 0.01), strict=False))
        run = replace(
            run,
            error_kind="one-step a priori",
            order=30,
            weight_count=992 if model == "volterra" else 31,
            step_size=sizes,
            bound={name: 2 * size for name, size in sizes.items()},
            largest_eigenvalue=4.0,
            spread=100.0,
        )
    return replace(run, **changes)


def published_runs(changes: Mapping[tuple[str, str], float | None] | None = None):
    """Make the runs whose errors are the printed ones, but for some MSE."""
    runs = {
        (p.signal, p.model): make_run(p.signal, p.model, p.mse.value, re=p.re.value)
        for p in PAIRS
    }
    for (signal, model), mse in (changes or {}).items():
        runs[signal, model] = make_run(signal, model, mse)
    return runs


def make_record(name: str, u, y, dt: float = 1e-4, **changes) -> Record:
    """Make a record of the twin."""
    record = Record(
        name=name,
        dt=dt,
        u=np.array(u, dtype=float),
        y=np.array(y, dtype=float),
        input=Channel("current", "A"),
        output=Channel("displacement", "um"),
        origin="twin",
    )
    return replace(record, **changes)


def sine_record(name: str, size: float, minor: float = 0.0) -> Record:
    """Make a sine; ``minor`` adds a faster sine that turns inside the range."""
    time = np.arange(8000) * 1e-4
    frequency = sine_frequency(name)
    shape = np.sin(2 * np.pi * frequency * time)
    ripple = minor * np.sin(2 * np.pi * 7 * frequency * time)
    return make_record(name, 0.632 * (shape + ripple), size * (shape + ripple))


def sine_records(size: Callable[[float], float], minor: float = 0.0):
    """Make all sines of Table 1."""
    names = [s for s in signals(PAIRS) if sine_frequency(s) is not None]
    return {n: sine_record(n, size(sine_frequency(n)), minor) for n in names}


def chirp_record(size: Callable[[np.ndarray], np.ndarray], amplitude: float = 0.632):
    """Make the chirp with an output of the given size over time."""
    name = "chirp-1-100hz"
    time = np.arange(20300) * 1e-4
    phase = 2 * np.pi * (time + RATE / 2 * time**2)
    return {
        name: make_record(name, amplitude * np.sin(phase), size(time) * np.sin(phase))
    }


def sum_records(scale: float = 1.0, odd: float = 0.0, outside: float = 0.0):
    """Make the three sums; ``odd`` changes a line, ``outside`` leaves the band."""
    time = np.arange(20000) * 1e-4
    found = {}
    for name, lines in TEXT.sums.items():
        u = sum(a * np.sin(2 * np.pi * f * time) for f, a in lines.items())
        found[name] = scale * (u + odd * np.sin(2 * np.pi * 50 * time))
    name = "multisine-random-0-100hz"
    phases = np.random.default_rng(1).uniform(0, 2 * np.pi, 10)
    found[name] = sum(
        np.sin(2 * np.pi * f * time + phase)
        for f, phase in zip(range(10, 101, 10), phases, strict=True)
    ) + outside * np.sin(2 * np.pi * 400 * time)
    return {name: make_record(name, u, 20 * u) for name, u in found.items()}


def make_identification(**changes) -> dict:
    """Make an identification that found the published envelopes."""
    return {
        "envelope": dict(TEXT.envelope),
        "thresholds": list(np.arange(31) / 31 * 0.2),
        "weights": list(np.exp(-np.arange(31) / 5)),
        "J": [9.0, 1.0, 0.5],
        "epsilon": 0.6,
        "reached": True,
        "relative_error": 0.004,
        "published_relative_error": 0.028,
    } | changes

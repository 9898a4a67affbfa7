"""Records and datasets for the tests of the gap, from plain numpy."""

import numpy as np
import yaml

from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.scored_samples import Compared
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record

CURRENT = Channel("current", "A")
DISPLACEMENT = Channel("displacement", "um")


def record(
    u,
    y=None,
    *,
    name="made",
    dt=0.001,
    use="fit",
    period_samples=None,
    simulated=None,
    **more,
):
    u = np.array(u, dtype=float)
    y = np.zeros_like(u) if y is None else np.array(y, dtype=float)
    about = CURRENT, DISPLACEMENT, "twin", use, period_samples, simulated
    return Record(name, dt, u, y, *about, **more)


def evidence_of(name, records, hold, noise, takes, gives):
    """Records by their use, with their noise and the device's quantities told."""
    by_use = {use: [x for x in records if x.use == use] for use in ("fit", "hold-out")}
    return Evidence(
        name,
        *map(tuple, by_use.values()),
        input_hold=hold,
        noise_rms=noise,
        quantities=Quantities(takes, gives),
    )


def sine(frequency_hz, *, amplitude=1.0, count=2000, dt=0.001, phase=0.0):
    time = np.arange(count) * dt
    return amplitude * np.sin(2 * np.pi * frequency_hz * time + phase)


def compared(u, residual, *, simulated=None, **about):
    """A record whose residual is the given one."""
    simulated = 5 * np.asarray(u) if simulated is None else simulated
    made = record(u, simulated + residual, **about)
    return Compared(made, simulated)


def multisine(seed=0, *, highest_hz=200.0, lines=40, count=2000, dt=0.001):
    """Frequencies, amplitudes and phases of sines that fit the record wholly."""
    rng = np.random.default_rng(seed)
    last = int(highest_hz * count * dt)
    first = np.unique(np.geomspace(1, last, lines).astype(int))
    return first / (count * dt), np.ones(len(first)), rng.uniform(0, 6.28, len(first))


def steady(sines, response=lambda s: 1.0 + 0 * s, *, count=2000, dt=0.001):
    """What a linear system makes of sines that always have been: no transient."""
    frequency_hz, amplitudes, phases = sines
    time = np.arange(count) * dt
    gain = response(2j * np.pi * frequency_hz)
    angle = 2 * np.pi * np.outer(time, frequency_hz) + phases
    return (np.exp(1j * angle) * (amplitudes * gain)).imag.sum(axis=1)


def play_sum(u, thresholds, weights, state=0.0):
    """Weighted play operators, sample by sample as they are defined."""
    y = np.zeros(len(u))
    for threshold, weight in zip(thresholds, weights, strict=True):
        value = state
        for k, now in enumerate(u.tolist()):
            value = max(now - threshold, min(now + threshold, value))
            y[k] += weight * value
    return y


def write_folder(folder, records, **about):
    """Write records as a dataset: dataset.yaml and a CSV file each."""
    folder.mkdir(exist_ok=True)
    entries = []
    for item in records:
        columns = {"time_s": item.time, "current_A": item.u, "displacement_um": item.y}
        if item.simulated is not None:
            columns["simulated_um"] = item.simulated
        rows = np.column_stack(list(columns.values()))
        text = [",".join(columns), *(",".join(map(repr, row)) for row in rows.tolist())]
        (folder / f"{item.name}.csv").write_text("\n".join(text) + "\n")
        entry = {"file": f"{item.name}.csv", "use": item.use}
        if item.period_samples is not None:
            entry["period_samples"] = item.period_samples
        entries.append(entry)
    header = {
        "name": "made",
        "time": {"column": "time_s", "unit": "s"},
        "input": {"column": "current_A", "unit": "A"},
        "output": {"column": "displacement_um", "unit": "um"},
        "records": entries,
    }
    if records[0].simulated is not None:
        header["simulated"] = {"column": "simulated_um", "unit": "um"}
    (folder / "dataset.yaml").write_text(yaml.safe_dump(header | about))
    return folder


def play(u, half_width):
    """One play operator, by its definition."""
    now, out = 0.0, np.empty(len(u))
    for k, value in enumerate(u.tolist()):
        now = out[k] = min(max(now, value - half_width), value + half_width)
    return out


def shaken(random, t, low_hz, high_hz, lines=12):
    """Sines of drawn frequencies and phases, which come up in a tenth of a second."""
    drawn = (random.uniform(low_hz, high_hz, lines), random.uniform(0, 6, lines))
    waves = (np.sin(2 * np.pi * f * t + p) for f, p in zip(*drawn, strict=True))
    return sum(waves) * np.clip(t / 0.1, 0, 1)


def bent_first(block, bend, sizes, width, noise, channels, dt=1e-3, count=1500):
    """Noise slowed by a window of some samples, bent and sent through a block."""
    random = np.random.default_rng(3)
    found = []
    for k, size in enumerate(sizes):
        wide = random.standard_normal(count + width - 1)
        slow = np.convolve(wide, np.hanning(width), "valid")
        u = size * slow / np.std(slow)
        given = bend(u)
        y = block.simulate(given, given, dt) + noise * random.standard_normal(count)
        found.append(Record(f"run-{k}", dt, u, y, *channels, "measured", "fit"))
    return tuple(found)

"""A small dataset: a generalized play operator model whose drive does something."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from hystbench.dataset import load_dataset
from hystbench.model import Model
from tests.gap.searched import among

DT = 2e-4
SAMPLES = 1500
LAG_S = 1.5e-3
NOISE = 0.02
LATE = among("drive-lag", "sensor-lag", "input-delay", "eddy-diffusion")
"""What the lag may be taken for: tests of files and words need no other effect."""

BASE = {
    "name": "tiny-base",
    "input": {"name": "current", "unit": "A"},
    "output": {"name": "displacement", "unit": "um"},
    "chain": [
        {
            "gpi": {
                "envelope": {
                    "a0": 1.0, "a1": 0.5, "a2": 0.9, "a3": -0.1,
                    "a4": 0.8, "a5": 0.6, "a6": 0.9, "a7": 0.1,
                },
                "thresholds": [0.0, 0.1, 0.2, 0.3],
                "weights": [4.0, 1.5, 1.0, 0.8],
            }
        }
    ],
}  # fmt: skip


def write_tiny(folder: Path, lag_s: float = LAG_S, more: str = "") -> tuple[Path, Path]:
    """Write dataset and base; a drive lag is in the records and not in the base.

    ``more`` are further lines of dataset.yaml.
    """
    lag = {"drive-lag": {"time_constant_s": lag_s}}
    drive = Model.from_mapping(BASE | {"chain": [lag]}, "drive")
    return write_driven(folder, lambda u: drive.simulate(u, DT), more)


def write_driven(
    folder: Path, drive: Callable[[np.ndarray], np.ndarray], more: str = ""
) -> tuple[Path, Path]:
    """Write dataset and base; what the drive does to the input is not in the base."""
    rng = np.random.default_rng(5)
    base = Model.from_mapping(BASE, "base")
    time = np.arange(SAMPLES) * DT
    inputs = {
        "slow": np.sin(2 * np.pi * 10 * time),
        "fast": 0.8 * np.sin(2 * np.pi * 90 * time),
        "sweep": 0.9 * np.sin(2 * np.pi * (10 * time + 200 * time**2)),
        "unseen": 0.5 * np.sin(2 * np.pi * 25 * time)
        + 0.4 * np.sin(2 * np.pi * 70 * time),
    }
    data = folder / "dataset"
    data.mkdir(parents=True)
    entries = []
    for name, u in inputs.items():
        y = base.simulate(drive(u), DT) + NOISE * rng.standard_normal(SAMPLES)
        rows = [f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in zip(time, u, y, strict=True)]
        text = "\n".join(["time_s,current_A,displacement_um", *rows])
        (data / f"{name}.csv").write_text(text + "\n")
        use = "hold-out" if name == "unseen" else "fit"
        entries.append(f"  - {{file: {name}.csv, use: {use}}}\n")
    (data / "dataset.yaml").write_text(
        "name: tiny\n"
        "time: {column: time_s, unit: s}\n"
        "input: {column: current_A, unit: A}\n"
        "output: {column: displacement_um, unit: um}\n"
        f"noise_rms: {NOISE}\n{more}"
        "records:\n" + "".join(entries)
    )
    load_dataset(data)
    base.save(folder / "base.yaml")
    return data, folder / "base.yaml"

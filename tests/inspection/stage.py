"""A stage with one mode, its records, and model files for it."""

import numpy as np

from hystbench.dataset import load_dataset
from hystbench.inspection.check import check
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record, write_folder
from tests.gap.small import block

DT = 1e-3
T = np.arange(800) * DT
STAGE = {"mass": 4e-4, "damping": 0.01, "stiffness": 1.0}
"""A mode at 8 Hz, hardly damped, which no loop follows that knows no rate."""
NOISE = 0.01


def saved(folder, *blocks, name="base", **about):
    Model(name, CURRENT, DISPLACEMENT, blocks, **about).save(folder / f"{name}.yaml")
    return str(folder / f"{name}.yaml")


def wave(seed):
    rng = np.random.default_rng(seed)
    slow = np.convolve(rng.standard_normal(len(T) + 20), np.hanning(21), "valid")
    return slow[: len(T)] / np.abs(slow).max()


def through(u, *blocks):
    return Model("plant", CURRENT, DISPLACEMENT, blocks).simulate(u, DT)


def write_stage(folder):
    """Write three records of it, with noise."""
    made = []
    for seed, use in enumerate(("fit", "fit", "hold-out")):
        u = wave(seed)
        noise = NOISE * np.random.default_rng(10 + seed).standard_normal(len(u))
        y = through(u, block("mechanism", **STAGE)) + noise
        made.append(record(u, y, name=f"r{seed}", use=use))
    write_folder(folder / "stage", made, noise_rms=NOISE)


def looked(folder, name, model="", effects=True):
    dataset = load_dataset(folder / name / "dataset.yaml")
    return check(dataset, effects, model)

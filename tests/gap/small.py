"""Small records and chains for the tests of the naming engine."""

from dataclasses import replace
from functools import cache

import numpy as np

from hystbench.blocks import registry
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.fitting.variant_search import best_of, best_points
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record, write_folder

ENVELOPE = {
    "a0": 12.0,
    "a1": 1.2,
    "a2": 0.1,
    "a3": 0.2,
    "a4": 11.0,
    "a5": 1.3,
    "a6": -0.1,
    "a7": -0.2,
}
GPI = {"thresholds": [0.0, 1.5, 4.0, 7.0], "weights": [0.9, 0.4, 0.3, 0.2]}
MODE = {"frequency_hz": 90.0, "damping_ratio": 0.03, "participation": 0.2}


def block(name, **values):
    return registry()[name].from_mapping(values)


def hysteresis():
    return block("gpi", envelope=ENVELOPE, **GPI)


def chains():
    """Bases as a user brings them, by what is special about each."""
    gain, mode = block("gain", value=12.0, offset=0.5), block("resonance", **MODE)
    around = block(
        "rate-dependent-hysteresis",
        coefficient=0.02,
        exponent=0.5,
        form="excess-field",
    )
    # Static gain 12, a lag and a mode at 60 Hz: descending powers of s.
    w = 2 * np.pi * 60.0
    down = np.polymul([5e-3, 1.0], [1 / w**2, 2 * 0.05 / w, 1.0]).tolist()
    inside = block("transfer-function", numerator=[12.0], denominator=down)
    return {
        "mode inside": (inside,),
        "gain": (gain,),
        "gain and mode": (gain, mode),
        "hysteresis": (hysteresis(),),
        "hysteresis and mode": (hysteresis(), mode),
        "wrapped": (
            block("drive-lag", time_constant_s=2e-3),
            hysteresis(),
            around,
            mode,
        ),
    }


@cache
def records():
    """Two records of different rates and lengths: a decaying sine and two tones."""
    t = np.arange(1500) / 1000
    ringing = 0.8 * np.exp(-t) * np.sin(2 * np.pi * 4 * t)
    s = np.arange(1200) / 2000
    tones = 0.4 * np.sin(2 * np.pi * 11 * s) + 0.2 * np.sin(2 * np.pi * 73 * s)
    return (
        record(ringing, name="ringing", dt=1 / 1000),
        record(tones * np.minimum(1, s / 0.02), name="tones", dt=1 / 2000),
    )


def measured(chain, noise=0.0, seed=0, given=None):
    """Records whose output is a chain's, with white noise."""
    rng = np.random.default_rng(seed)
    given = records() if given is None else given
    outputs = Simulation(tuple(chain), given, "band-limited").output
    return tuple(
        record(
            one.u,
            y + noise * rng.standard_normal(len(y)),
            name=one.name,
            dt=one.dt,
            use=one.use,
        )
        for one, y in zip(given, outputs, strict=True)
    )


def write_lagging(folder):
    """Write a plain gain whose output lags: a lag of the drive would do as well."""
    chain = (block("gain", value=12.0),)
    made = measured((*chain, block("sensor-lag", time_constant_s=0.004)), 0.02)
    first = made[0]
    held = replace(first, name="held", use="hold-out", u=0.8 * first.u, y=0.8 * first.y)
    write_folder(folder / "rig", [*made, held], noise_rms=0.02)
    Model("rig", CURRENT, DISPLACEMENT, chain).save(folder / "base.yaml")


def state_of(chain, given=None, count=300, **more):
    """Start from a chain, few samples scored."""
    given = records() if given is None else given
    return ModelState(
        tuple(chain), given, ScoredSamples.of(given, count), **more
    ).settled()


def plain_score(state, floor=1e-6):
    """A score without any direction of reshaping."""
    return Score(state.sample, np.zeros((len(state.sample), 0)), floor)


def coarse(attempt):
    """How a variant does at the best points of its grid."""
    return best_of(attempt, [point for _, point in best_points(attempt)])

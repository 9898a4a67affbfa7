"""One kilogram on springs of any law, by small steps, without a block."""

import numpy as np

from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import search

DT = 0.005
NOISE = 1e-4
OFFERED = ["friction", "hysteretic-force", "stiffness-hardening"]


def spring(q):
    return 60.0 * q


def moved(u, held, spring, fine=40):
    """Give the way of 1 kg on a spring and a damper against a held force, by Euler.

    ``held`` is the change of that force, of it and the velocity.
    """
    q, v, force, out = 0.0, 0.0, 0.0, []
    for push in np.repeat(u, fine).tolist():
        out.append(q)
        all_of_it = force.sum() if isinstance(force, np.ndarray) else force
        v += DT / fine * (push - 1.5 * v - spring(q) - all_of_it)
        force += DT / fine * held(force, v)
        q += DT / fine * v
    return np.array(out[::fine])


def records_of(held, spring, noise):
    random = np.random.default_rng(8)
    for size in (10.0, 20.0):
        u = size * np.repeat(random.uniform(-1, 1, 30), 20)
        y = moved(u, held, spring) + noise * random.standard_normal(len(u))
        channels = Channel("in", "N"), Channel("out", "m")
        yield Record(f"{size:g}", DT, u, y, *channels, "measured", "fit")


def best(held, spring=spring, offered=OFFERED, noise=NOISE, turns=""):
    """Name the force in a linear host that was fitted to the records."""
    found = tried(held, spring, offered, noise, turns)
    return min(found, key=lambda item: item.score)


def tried(held, spring, offered, noise=NOISE, turns="", by=search):
    """Put forces into a linear host that was fitted to the records."""
    records = tuple(records_of(held, spring, noise))
    begun = one_coordinate(records, Quantities("force", "position"), "zero-order")
    sample = ScoredSamples.of(records)
    score = Score.plain(sample, noise**2)
    return by(best_host(list(begun), score), score, offered, turns)

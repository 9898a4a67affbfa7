"""A given base of two play operators where the device has many: of a wrong shape."""

import numpy as np

from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.made import play
from tests.gap.searched import search
from tests.gap.small import block

VOLTAGE, STROKE = Channel("voltage", "V"), Channel("stroke", "um")
NOISE = 0.01
THRESHOLDS = np.arange(12) / 10
WEIGHTS = 0.5 * np.exp(-2.0 * THRESHOLDS)


def device(u):
    return sum(w * play(u, r) for w, r in zip(WEIGHTS, THRESHOLDS, strict=True))


def records():
    t = np.arange(1200) / 400
    random = np.random.default_rng(6)
    for k, hz in enumerate((1.0, 2.3, 0.7)):
        u = (0.3 + 0.5 * t) * np.sin(2 * np.pi * hz * t)
        y = device(u) + NOISE * random.standard_normal(len(t))
        yield Record(f"run-{k}", 1 / 400, u, y, VOLTAGE, STROKE, "measured", "fit")


def test_the_shape_of_given_play_operators_may_be_wrong():
    given = tuple(records())
    few = [0.0, 0.5]

    def loop(*weights):
        return block("prandtl-ishlinskii", thresholds=few, weights=list(weights))

    # The base as one identifies it: its two weights fit the records best.
    columns = np.concatenate(
        [
            np.column_stack([x.simulate(one.u, one.u, one.dt) for x in (none, a, b)])
            for none, a, b in [(loop(0.0, 0.0), loop(1.0, 0.0), loop(0.0, 1.0))]
            for one in given
        ]
    )
    columns[:, 1:] -= columns[:, :1]
    measured = np.concatenate([one.y for one in given])
    weights, *_ = np.linalg.lstsq(columns[:, 1:], measured - columns[:, 0], rcond=None)
    base = Model("ceramic", VOLTAGE, STROKE, (loop(*weights.tolist()),))
    content = search("ceramic", given, base, declared=NOISE).content
    assert content["verdict"] == "named"
    assert content["effects"][0]["name"] == "hysteresis-shape"

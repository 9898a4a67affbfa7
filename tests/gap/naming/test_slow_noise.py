"""What is slow and has less power than the noise is noise; what has more is a drift."""

import numpy as np
import pytest

from hystbench.blocks.gain import Gain
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.searched import search

DT, COUNT, NOISE = 1e-2, 4000, 0.01
DRIVE, OUTPUT = Channel("drive", "V"), Channel("output", "um")
BASE = Model("stack", DRIVE, OUTPUT, (Gain(value=2.0),))


@pytest.mark.parametrize(("share", "names"), [(0.8, []), (3.0, ["drift"])])
def test_a_slow_part_is_a_drift_where_it_is_more_than_the_noise(share, names):
    random = np.random.default_rng(7)
    time = DT * np.arange(COUNT)
    records = []
    for k in range(3):
        u = np.sin(2 * np.pi * (1 + k) * time)
        slow = np.sin(2 * np.pi * 0.05 * time + random.uniform(0, 6))
        white = random.standard_normal(COUNT)
        y = 2 * u + NOISE * (white + share * np.sqrt(2) * slow)
        records.append(Record(f"run-{k}", DT, u, y, DRIVE, OUTPUT, "measured", "fit"))
    answer = search("stack", records, BASE, "linear", declared=NOISE)
    assert [item["name"] for item in answer.content["effects"]] == names

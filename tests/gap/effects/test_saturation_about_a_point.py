"""A curve behind linear dynamics that is nearer its limit on one side."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import Evidence
from hystbench.record import Channel, Record
from tests.gap.searched import among, search

DT, COUNT, NOISE = 0.5, 1000, 0.02
FLOW, ACID = Channel("flow", "l/min"), Channel("acid", "1")
MIXER = TransferFunction(
    numerator=(1.0,), denominator=(72.0, 18.0, 1.0), hold="zero-order"
)


def test_a_strong_one_behind_an_identified_base_is_named_and_leaves_noise():
    random = np.random.default_rng(9)
    records = []
    for k in range(2):
        u = np.repeat(random.uniform(-1, 1, COUNT // 40), 40)
        x = MIXER.simulate(u, u, DT)
        y = 7.0 + 2.5 * np.tanh(4.0 * (x - 0.1))
        y = y + NOISE * random.standard_normal(COUNT)
        records.append(Record(f"run-{k}", DT, u, y, FLOW, ACID, "measured", "fit"))
    evidence = Evidence("mixer", tuple(records), (), "zero-order")
    base, _ = load_base("linear", evidence)
    curves = among(
        *("saturation", "asymmetry", "sensor-nonlinearity", "dead-zone"),
        *("drive-saturation", "calibration-error"),
    )
    answer = search("mixer", evidence.fit, base, evidence.input_hold, vocabulary=curves)
    (effect,) = answer.content["effects"]
    assert effect["name"] == "saturation"
    left = [record.y - answer.model.simulate(record.u, record.dt) for record in records]
    assert np.sqrt(np.mean(np.square(left))) < 1.1 * NOISE
    limit = next(x for x in answer.model.chain if x.name == "saturation")
    scale = answer.model.chain[-1].value
    assert limit.level * scale == pytest.approx(2.5, rel=0.03)

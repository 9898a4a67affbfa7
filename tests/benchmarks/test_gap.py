"""The benchmark of the gap workflow: fewer samples are the first part of a record."""

import numpy as np
from benchmarks.gap import cut, one_round

from hystbench.gap.records.evidence import load_evidence
from hystbench.record import Channel, Record
from tests.gap.tiny import write_tiny


def test_the_first_part_of_a_record():
    u = np.arange(8.0)
    channels = Channel("current", "A"), Channel("displacement", "um")
    given = Record("a", 0.5, u, 2 * u, *channels, "twin", period_samples=2)
    half = cut(given, 0.5)
    np.testing.assert_array_equal(half.u, [0, 1, 2, 3])
    np.testing.assert_array_equal(half.y, [0, 2, 4, 6])
    assert (half.name, half.dt, half.period_samples) == ("a", 0.5, None)


def test_a_round_names_the_lag_from_half_of_each_record(tmp_path):
    """Of the first nine effects by name, the lag among them."""
    data, base = write_tiny(tmp_path)
    found = one_round(load_evidence(data), str(base), 9, 0.5)
    assert found == "drive-lag"

"""Numbers before a simulator whose output is a staircase are found without slopes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.blocks.drive_lag import DriveLag
from hystbench.gap.bases.load import load_base
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import refit, scanned
from hystbench.gap.fitting.state import Added, Free
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from tests.gap.made import record
from tests.gap.small import state_of

DT, LAG_S, NOISE = 0.01, 0.3, 1e-3
FLOOR = Floor(NOISE, "declared")
GRAINS = """
import numpy as np

def grains(u, dt):
    "Sixty relays: a step of the sum is a sixtieth of it."
    up = np.linspace(-0.6, 1.0, 60)
    on = np.zeros((len(u), 60), dtype=bool)
    for k, now in enumerate(u.tolist()):
        on[k] = (now > up) | (on[k - 1] & (now > up - 0.4))
    return on.mean(axis=1)
"""


@pytest.mark.parametrize("began", [0.22, 0.4])
def test_a_lag_before_relays_is_found_from_where_its_slopes_lead_nowhere(
    began, tmp_path, monkeypatch
):
    (tmp_path / "wire.py").write_text(GRAINS)
    monkeypatch.syspath_prepend(tmp_path)
    from wire import grains

    time, found = np.arange(1200) * DT, []
    for k in range(2):
        u = np.sin(2 * np.pi * 0.2 * (1 + k) * time)
        pole = np.exp(-DT / LAG_S / 20)  # twenty times as fine, the input straight
        fine = np.interp(np.arange(20 * 1199 + 1) / 20, np.arange(1200), u)
        slow = lfilter([1 - pole], [1, -pole], fine)[::20]
        noise = NOISE * np.random.default_rng(k).standard_normal(1200)
        found.append(record(u, grains(slow, DT) + noise, name=f"r{k}", dt=DT))
    base, _ = load_base("wire:grains", Evidence("wire", tuple(found), ()))
    chain = (DriveLag(time_constant_s=began), *base.chain)
    state = state_of(chain, tuple(found))
    free = Free(0, "time_constant_s", None, None, 0.01, 3.0)
    lag = Added("drive-lag", "drive", "", (0,), {}, 1.0)
    state = replace(state, free=(free,), added=(lag,))
    score = make_score(state, FLOOR, forms=False)
    stuck = refit(state, score)[0].chain[0].time_constant_s
    assert abs(stuck / LAG_S - 1) > 0.02  # else the test would hold nothing
    told = scanned(state, FLOOR).chain[0].time_constant_s
    assert told == pytest.approx(LAG_S, rel=0.01)

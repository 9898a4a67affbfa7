"""A search finds the same on two cores as on one."""

import json

import pytest

from hystbench import cores
from hystbench.cores import on_cores
from hystbench.interface.gap import find_gap
from hystbench.model import load_model
from tests.gap.oscillator import OFFERED, tried
from tests.gap.tiny import write_tiny


@pytest.fixture
def always(monkeypatch):
    """Two cores, whatever the machine has, and every work shared."""
    monkeypatch.setattr(cores, "available", lambda: 2)
    monkeypatch.setattr(cores, "WORTH_S", -1.0)


def test_a_chain_is_told_alike(always, tmp_path):
    data, base = write_tiny(tmp_path)
    one, two = (
        find_gap(data, load_model(base), cache=False, cores=count) for count in (1, 2)
    )
    assert one.effects
    assert json.dumps(one.content) == json.dumps(two.content)


def test_forces_are_told_alike(always):
    def held(force, v):
        return 2000.0 * v * (1.0 - force / 2.0 * (v > 0) + force / 2.0 * (v < 0))

    found = []
    for count in (1, 2):
        with on_cores(count):
            every = tried(held, lambda q: 60.0 * q, OFFERED)
        found.append([(x.effects, x.forms, x.score, x.state.chain) for x in every])
    assert found[0] == found[1]
    assert len(found[0]) > 1

"""A path beside forces that is no more than another zero of each record."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import refit
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.with_own_values import offsets_for_paths
from hystbench.gap.progress import silent
from hystbench.gap.records.floor import Floor
from tests.gap.small import block, measured, state_of

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")


def moved(ways):
    """A base on records of which each is moved by its own way, and a path named."""
    gain = block("gain", value=12.0)
    given = tuple(
        replace(item, y=item.y + way(np.linspace(0, 1, len(item))))
        for item, way in zip(measured((gain,), NOISE), ways, strict=True)
    )
    start = state_of((gain,), given)
    offered = effects()["drift"].variants(start.simulation)
    path = next(item for item in offered if item.form == "path")
    state = with_effect(start, path, {}).settled()
    state, _ = refit(state, make_score(state, FLOOR))
    assert state.paths == {"drift"}
    return start, Named(state)


def test_offsets_of_the_records_are_no_drift():
    start, named = moved([lambda t: 0.5 + 0 * t, lambda t: -0.3 + 0 * t])
    apart, again, own = offsets_for_paths(start, named, FLOOR, silent)
    assert again.state.added == ()
    assert own.kinds == ("offset",)
    assert [one.offset for _, one in own.records] == pytest.approx(
        [0.5, -0.3], abs=3 * NOISE
    )
    assert own.share == pytest.approx(1.0, abs=0.02)
    assert np.sqrt(np.mean(apart.residual**2)) == pytest.approx(NOISE, rel=0.1)


def test_a_way_that_goes_on_stays_a_path():
    start, named = moved([lambda t: t - t**2, lambda t: -0.6 * t])
    apart, again, own = offsets_for_paths(start, named, FLOOR, silent)
    assert (apart, again) == (start, named)
    assert not own.records

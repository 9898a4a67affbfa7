"""A force that is far weaker than what drives the machine is found all the same."""

import numpy as np
import pytest

from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.slider_with_gap import SliderWithGap
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.combine_forces import as_weak
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import each_alone

DT = 0.005
NOISE = 2e-4
CONTACT, SLIP, GAP = 40.0, 0.35, 0.02
"""N/m, N and m; what drives it goes to 20 N."""


def moved(u, fine=40):
    """Move 1 kg on a spring of 60 N/m against a slider behind a clearance, by Euler."""
    q, v, way, out = 0.0, 0.0, 0.0, []
    reach = GAP + SLIP / CONTACT
    for push in np.repeat(u, fine).tolist():
        out.append(q)
        pressed = max(abs(way) - GAP, 0.0)
        force = CONTACT * pressed * (1 if way > 0 else -1)
        v += DT / fine * (push - 1.5 * v - 60.0 * q - force)
        q += DT / fine * v
        way = min(max(way + DT / fine * v, -reach), reach)
    return np.array(out[::fine])


def test_a_slider_behind_a_clearance_is_found_with_its_numbers():
    random = np.random.default_rng(5)
    records = []
    for size in (5.0, 20.0):
        u = size * np.repeat(random.uniform(-1, 1, 60), 20)
        y = moved(u) + NOISE * random.standard_normal(len(u))
        channels = Channel("in", "N"), Channel("out", "m")
        records.append(Record(f"{size:g}", DT, u, y, *channels, "measured", "fit"))
    given = tuple(records)
    score = Score.plain(ScoredSamples.of(given), NOISE**2)
    begun = one_coordinate(given, Quantities("force", "position"), "zero-order")
    offered = ["slider-with-gap", "hysteretic-force", "friction"]
    found = each_alone(best_host(list(begun), score), score, offered)
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("slider-with-gap",)
    (block,) = (x for x in best.state.chain if x.name == "slider-with-gap")
    assert block.contact_stiffness == pytest.approx(CONTACT, rel=0.1)
    assert block.slip_force == pytest.approx(SLIP, rel=0.1)
    assert block.gap == pytest.approx(GAP, rel=0.1)


def test_a_force_begins_weaker_and_its_shape_stays():
    block = SliderWithGap(contact_stiffness=50.0, slip_force=8.0, gap=0.3)
    law = Law("", block, ("contact_stiffness", "slip_force", "gap"))
    weak = as_weak(law, 0.1)
    assert weak.block == SliderWithGap(contact_stiffness=5.0, slip_force=0.8, gap=0.3)
    for share in (-0.1, 0.5, 4.0, float("nan")):
        assert as_weak(law, share) is None
    assert as_weak(Law("", InputDelay(delay_s=0.1), ("delay_s",)), 0.1) is None

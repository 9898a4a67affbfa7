"""A force that is far weaker than what drives the machine is found all the same."""

import numpy as np
import pytest

from hystbench.blocks.input_delay import InputDelay
from hystbench.blocks.slider_with_gap import SliderWithGap
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.combine_forces import as_weak
from hystbench.gap.inside.one_coordinate import best_host, one_coordinate
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import SLIDES
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import each_alone

DT = 0.005
NOISE = 0.05
CONTACT, SLIP, GAP = 20.0, 0.2, 0.05
"""N/m, N and m; what drives it goes beyond 10 N, and it moves by half a metre."""


def accelerations(u, fine=40):
    """Move 1 kg on a spring of 60 N/m against a slider behind a clearance, by Euler."""
    q, v, way, out = 0.0, 0.0, 0.0, []
    reach = GAP + SLIP / CONTACT
    for push in np.repeat(u, fine).tolist():
        pressed = max(abs(way) - GAP, 0.0)
        a = push - 0.5 * v - 60.0 * q - CONTACT * pressed * (1 if way > 0 else -1)
        out.append(a)
        v += DT / fine * a
        q += DT / fine * v
        way = min(max(way + DT / fine * v, -reach), reach)
    return np.array(out[::fine])


def test_a_slider_behind_a_clearance_is_found_with_its_numbers():
    random, time = np.random.default_rng(5), np.arange(1200) * DT
    records = []
    for size in (5.0, 20.0):
        tones = 2 * np.pi * np.arange(0.4, 3.2, 0.2)
        phases = random.uniform(0, 6, len(tones))
        u = size / 4 * np.sin(np.outer(time, tones) + phases).sum(axis=1)
        y = accelerations(u) + NOISE * random.standard_normal(len(u))
        channels = Channel("in", "N"), Channel("out", "m/s^2")
        records.append(Record(f"{size:g}", DT, u, y, *channels, "measured", "fit"))
    given = tuple(records)
    score = Score.plain(ScoredSamples.of(given), NOISE**2)
    begun = one_coordinate(given, Quantities("force", "acceleration"), "zero-order")
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


def test_a_clearance_is_wider_than_the_way_in_which_friction_gives_way():
    """A hundredth of the motion: where a loop's flanks look vertical."""
    moved = Moved(reach=100.0, speed=1.0, force=16.0)
    laws = list(effects()["slider-with-gap"].in_mechanism(moved))
    assert laws
    for law in laws:
        low, _ = law.ranges["gap"]
        assert low == pytest.approx(SLIDES * 100.0)
        assert law.block.gap > low

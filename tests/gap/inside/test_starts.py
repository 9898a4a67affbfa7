"""Laws that are begun far from where they do little, or at another place."""

import numpy as np
import pytest

from hystbench.blocks.attached_mass import AttachedMass
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.saturation import Saturation
from hystbench.blocks.stiffness import Stiffness
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Moved, Passed
from hystbench.gap.fitting.least_squares import fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.insert_law import with_law
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.thresholds import CERTAIN
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.made import shaken
from tests.gap.searched import among
from tests.gap.searched import search as decided

DT, COUNT, NOISE = 0.005, 2048, 0.02
CHANNELS = Channel("force", "N"), Channel("position", "mm")
SPRING = Mechanism(mass=0.002, damping=0.0035, stiffness=6.0, start="repeating")
SECOND = AttachedMass(mass=0.0044, damping=0.003, stiffness=4.4)
CHAIN = (SPRING, Stiffness(quadratic=0.0, cubic=18.0), SECOND)


def test_a_sharp_mode_that_a_cube_moves_by_more_than_its_width_is_found():
    """Little of a cube tells nothing of much: from there the fit goes nowhere."""
    random, records = np.random.default_rng(7), []
    for k, size in enumerate((0.4, 1.0)):
        lines = np.arange(3, 100)
        t = np.arange(COUNT) / COUNT
        phases = random.uniform(0, 2 * np.pi, len(lines))
        u = size * np.sin(2 * np.pi * np.outer(t, lines) + phases).sum(axis=1) / 9
        y = Model("rig", *CHANNELS, CHAIN).simulate(u, DT)
        y = y + NOISE * np.std(y) * random.standard_normal(COUNT)
        about = {"origin": "measured", "period_samples": COUNT}
        records.append(Record(f"r{k}", DT, u, y, *CHANNELS, **about))
    noise = NOISE * min(float(record.y.std()) for record in records)
    free = tuple(Free(0, x) for x in ("mass", "damping", "stiffness"))
    sample = ScoredSamples.of(tuple(records))
    state = ModelState((SPRING, SECOND), tuple(records), sample, free=free)
    score = Score.plain(sample, noise**2)
    host = fitted(state, score)
    reach, force = (
        max(float(np.abs(x).max()) for x in signals)
        for signals in ([r.y for r in records], [r.u for r in records])
    )
    moved = Moved(reach=reach, speed=1.0, force=force, stiffness=SPRING.stiffness)
    offered = effects()["stiffness-hardening"].in_mechanism(moved)
    begun = [law for law in offered if law.form == "cube"]
    found = [
        fitted_to_the_end(with_law(host.state, "stiffness-hardening", law), score)
        for law in begun
    ]
    best = min(found, key=lambda item: item.score)
    (spring,) = (x for x in best.state.chain if isinstance(x, Stiffness))
    assert spring.cubic == pytest.approx(18.0, rel=0.1)
    # It matters: the start that does little ends elsewhere.
    least = min(zip(begun, found, strict=True), key=lambda x: abs(x[0].block.cubic))
    assert least[1].score > best.score + CERTAIN


def test_a_saturation_is_tried_behind_dynamics_by_both_laws():
    laws = list(effects()["saturation"].around(Passed(1.0, 3.0, 0.01, 0.0)))
    assert {law.form for law in laws} == {"", "algebraic"}
    assert {law.place for law in laws} == {"behind"}
    for law in laws:
        assert isinstance(law.block, Saturation)
        assert law.block.level > 3.0  # no measured output is beyond it
        assert ("sharpness" in law.free) == (law.form == "algebraic")


def test_a_soft_limit_before_a_mass_is_the_drives():
    """Before a mass that is given stands no material: it was named `saturation`."""
    mass = Mechanism(mass=0.4e-3, damping=8.8e-3, stiffness=19.3)
    random, records = np.random.default_rng(1), []
    t = 1e-3 * np.arange(2500)
    for k in range(3):
        u = shaken(random, t, 1, 25)
        limited = 4.0 * np.tanh(u / 4.0)
        y = mass.simulate(limited, limited, 1e-3)
        y = y + 0.01 * y.std() * random.standard_normal(len(y))
        records.append(Record(f"r{k}", 1e-3, u, y, *CHANNELS, "measured", "fit"))
    base = Model("rig", *CHANNELS, (mass,))
    moves = Quantities("force", "position")
    curves = among(
        *("drive-saturation", "saturation", "asymmetry", "dead-zone"),
        *("stiffness-hardening", "sensor-nonlinearity"),
    )
    found = decided(
        "rig", tuple(records), base, quantities=moves, vocabulary=curves
    ).content
    (effect,) = found["effects"]
    assert (effect["name"], effect["place"]) == ("drive-saturation", "drive")
    assert effect["parameters"]["level"]["value"] == pytest.approx(4.0, rel=0.01)


def test_a_limit_before_a_mass_is_tried_hard_and_soft():
    laws = list(effects()["drive-saturation"].around(Passed(2.0, 1.0, 0.01, 0.0)))
    alike, sides = {"", "soft", "algebraic"}, {"upper alone", "lower alone"}
    assert {law.form for law in laws} == alike | sides
    assert {law.place for law in laws} == {"before"}
    sizes = [getattr(law.block, law.free[0]) for law in laws]
    assert max(sizes) < 2.0

"""A mechanism with a force that fades, or with numbers that are a little off."""

import numpy as np
import pytest
from scipy.signal import lsim

from hystbench.blocks.mechanism import Mechanism
from hystbench.gap.asked import Asked
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.insert_law import laws_for
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.run import closed_gap
from hystbench.model import Model
from hystbench.record import Channel, Record
from tests.gap.made import evidence_of
from tests.gap.searched import among
from tests.gap.small import block

DT, COUNT = 0.004, 700
MASS, DAMPING, SPRING = 1.0, 2.5, 900.0
FADES, TIME = 220.0, 0.05
FORCE, PLACE = Channel("force", "N"), Channel("place", "mm")


def moved(u, fades, damping, spring):
    """The place, by the transfer function: a spring and a damper beside the spring."""
    beside = np.polymul([MASS, damping, spring], [TIME, 1.0])
    whole = np.polyadd(beside, [fades * TIME, 0.0])
    return lsim(([TIME, 1.0], whole), u, DT * np.arange(COUNT))[1]


def answer(vocabulary, noise, fades=0.0, damping=DAMPING, spring=SPRING):
    """What is named beside a mechanism that has no such force, and other numbers."""
    rng, time, given = np.random.default_rng(4), DT * np.arange(COUNT), []
    for name, size, use in (("a", 20, "fit"), ("b", 8, "fit"), ("c", 15, "hold-out")):
        lines = zip(rng.uniform(0.3, 12, 12), rng.uniform(0, 6, 12), strict=True)
        waves = (np.sin(2 * np.pi * f * time + p) for f, p in lines)
        u = size / 3 * sum(waves) * np.clip(time / 0.5, 0, 1)
        y = moved(u, fades, damping, spring) + noise * rng.standard_normal(COUNT)
        given.append(Record(name, DT, u, y, FORCE, PLACE, "twin", use))
    stage = Mechanism(mass=MASS, damping=DAMPING, stiffness=SPRING, hold="linear")
    base = Model("stage", FORCE, PLACE, (stage,))
    evidence = evidence_of("stage", given, "linear", noise, "force", "position")
    return closed_gap(evidence, base, Asked(vocabulary=among(*vocabulary)))


def test_a_force_that_fades_beside_a_known_spring_is_creep_and_no_hysteresis():
    """A loop of Bouc and Wen's has one number more, and comes near."""
    offered = ("creep", "hysteretic-force")
    content = answer(offered, 5e-4, FADES).outcome.content
    (found,) = content["effects"]
    assert (found["name"], found["place"]) == ("creep", "inside")
    assert found["blocks"] == ["relaxation-force"]
    for name, true in (("stiffness", FADES), ("relaxation_time_s", TIME)):
        told = found["parameters"][name]
        assert told["value"] == pytest.approx(true, rel=0.1)
        assert abs(told["value"] - true) < 4 * told["standard_error"]


@pytest.mark.parametrize(
    ("off", "noise"),
    [
        ({"spring": 1.01 * SPRING}, 1e-3),
        ({"spring": 1.01 * SPRING}, 1e-4),
        ({"damping": 1.1 * DAMPING}, 1e-4),
    ],
)
def test_a_mass_whose_numbers_are_a_little_off_lacks_no_mode_and_no_creep(off, noise):
    """A mode of the mass's frequency does as well, or a force that fades.

    One that fades at once is a damper, and one that hardly fades a spring.
    """
    content = answer(("resonance", "creep"), noise, **off).outcome.content
    assert (content["verdict"], content["effects"]) == ("parameters", [])


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("host", ["mechanism", "impedance", "structure"])
def test_beside_a_spring_that_was_identified_no_force_that_fades_is_offered(
    host, known
):
    """It would be a pole more of what is linear, whatever the forces act in."""
    numbers = {
        "mechanism": {"mass": MASS, "damping": DAMPING, "stiffness": SPRING},
        "impedance": {"mass": MASS, "damping": DAMPING, "stiffness": SPRING},
        "structure": {
            "stiffness": [SPRING],
            "damping": [DAMPING],
            "modal_constant": [1.0],
            "drive": [1.0],
            "joint": [1.0],
        },
    }[host]
    u = np.sin(DT * np.arange(COUNT))
    records = (Record("a", DT, u, u, FORCE, PLACE, "twin", "fit"),)
    free = () if known else (Free(0, "stiffness", 0 if host == "structure" else None),)
    sample = ScoredSamples.of(records)
    state = ModelState((block(host, **numbers),), records, sample, free, hold="linear")
    offered = laws_for(Fitted(state, 0.0))
    assert ("creep" in offered) == known
    assert "friction" in offered

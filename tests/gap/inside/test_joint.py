"""A force between two masses: at a joint that both modes move."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from hystbench.blocks.drag import Drag
from hystbench.blocks.force import against
from hystbench.blocks.gain import Gain
from hystbench.blocks.stiffness import Stiffness
from hystbench.blocks.structure import Structure
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects.law import Law
from hystbench.gap.fitting.edit_chain import without_effect
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Free, ModelState
from hystbench.gap.inside.host_places import own_numbers
from hystbench.gap.inside.insert_law import with_law
from hystbench.gap.inside.joint import joints, structure
from hystbench.gap.inside.possible_hosts import hosts
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.inside_host import search

MASSES = np.diag([1.0, 0.5])
SPRINGS = np.array([[300.0, -100.0], [-100.0, 180.0]])
DAMPERS = 2e-3 * SPRINGS
CUBE, NOISE, DT, COUNT = 4e3, 2e-4, 0.02, 1500
BETWEEN = np.array([1.0, -1.0])
TIME = DT * np.arange(COUNT)


@cache
def moved(level):
    """Position of the first mass, which is driven; the spring between them hardens."""
    tones = np.random.default_rng(5).uniform(1.5, 4.5, 12)
    phases = np.random.default_rng(6).uniform(0, 2 * np.pi, 12)
    u = level * np.sum(np.sin(2 * np.pi * tones * TIME[:, None] + phases), axis=1)

    def moves(t, state):
        x, v = state[:2], state[2:]
        held = SPRINGS @ x + DAMPERS @ v + BETWEEN * CUBE * (BETWEEN @ x) ** 3
        force = np.array([np.interp(t, TIME, u), 0.0])
        return [*v, *((force - held) / np.diag(MASSES))]

    span = (0.0, TIME[-1])
    y = solve_ivp(moves, span, [0.0] * 4, "LSODA", TIME, rtol=1e-7, max_step=DT).y[0]
    y = y + NOISE * np.random.default_rng(int(level)).standard_normal(COUNT)
    channels = Channel("force", "N"), Channel("place", "m")
    return Record(f"level {level}", DT, u, y, *channels, "measured", "fit")


@pytest.fixture(scope="module")
def base():
    """The masses with a linear spring, as a transfer function of fourth order."""
    squares, shapes = eigh(SPRINGS, MASSES)
    up, down = np.zeros(1), np.ones(1)
    for square, size in zip(squares, shapes[0] ** 2, strict=True):
        mode = [1.0, 2e-3 * square, square]
        up, down = np.polyadd(np.polymul(up, mode), size * down), np.polymul(down, mode)
    block = TransferFunction(
        numerator=tuple(up.tolist()), denominator=tuple(down.tolist()), hold="linear"
    )
    records = tuple(moved(level) for level in (1.0, 6.0))
    return ModelState(
        (block, Gain(value=1.0)), records, ScoredSamples.of(records), hold="linear"
    ).settled()


def test_a_base_as_a_structure_does_what_it_did(base):
    whole = structure(base, "position")
    assert whole.chain[0].joint == ()
    np.testing.assert_allclose(
        whole.residual, base.residual, atol=1e-9 * np.ptp(base.measured)
    )
    assert structure(replace(base, chain=(Gain(value=1.0),)), "position") is None


@pytest.mark.parametrize("output", ["position", "velocity", "acceleration"])
def test_so_does_one_with_a_real_pole_and_what_passes_at_once(base, output):
    block = base.chain[0]
    down = np.polymul(block.denominator, [1.0, 9.0])
    up = np.polyadd(0.01 * down, np.polymul(block.numerator, [2.0, 30.0]))
    more = replace(
        block, numerator=tuple(up.tolist()), denominator=tuple(down.tolist())
    )
    start = base.with_blocks({0: more})
    start = replace(start, correction=None).settled()
    whole = structure(start, output, others_too=True)
    assert [x.name for x in whole.chain] == ["structure", "other-modes", "gain"]
    np.testing.assert_allclose(
        whole.residual, start.residual, atol=1e-8 * np.ptp(start.residual)
    )


@pytest.mark.parametrize("identified", [True, False])
def test_the_offset_of_a_base_is_fitted_if_the_base_was_identified(base, identified):
    """A curve behind the modes has a mean, which such a base took for an offset."""
    off = replace(base, chain=(*base.chain, Gain(value=1.0, offset=0.05)))
    whole = structure(off, "position", others_too=identified)
    place = len(whole.chain) - 1
    assert (Free(place, "offset") in whole.free) == identified


def test_the_shapes_go_with_the_force_that_they_came_with(base):
    whole = structure(base, "position")
    begun = next(joints(whole))
    spring = Law("cube", Stiffness(quadratic=0.0, cubic=1.0), ("cubic",))
    damper = Law("drag", Drag(coefficient=1.0), ("coefficient",))
    one = with_law(begun, "stiffness-hardening", spring)
    assert one.freedom == 1 + 2
    bare = without_effect(one, 0)
    assert bare.chain[0] == whole.chain[0]
    assert bare.free == whole.free
    two = with_law(one, "drag", damper)
    assert two.freedom == 1 + 2 + 1
    for number in (0, 1):  # they stay with the other one
        left = without_effect(two, number)
        assert left.freedom == 1 + 2
        assert left.chain[0] == begun.chain[0]


def test_the_joint_is_begun_in_each_mode_and_in_both(base):
    begun = [x.chain[0] for x in joints(structure(base, "position"))]
    shares = np.array([np.array(x.joint) / np.array(x.drive) for x in begun]).round(2)
    assert shares.tolist() == [[1, 0], [0, 1], [1, 1], [1, -1]]
    assert list(joints(begun_with_a_joint(base))) == []


def begun_with_a_joint(base):
    return next(joints(structure(base, "position")))


def test_a_spring_that_hardens_between_two_masses_is_found_with_its_place(base):
    score = Score.plain(base.sample, NOISE**2)
    asked = base, Quantities("force", "position"), True, score
    (host,) = hosts(*asked, kinds=("structure",))
    offered = ["stiffness-hardening", "stop"]
    found = search(host.fitted, score, offered=offered)
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("stiffness-hardening",)
    block = best.state.chain[0]
    assert isinstance(block, Structure)
    _, shapes = eigh(SPRINGS, MASSES)
    drive, joint = np.array(block.drive), np.array(block.joint)
    # A force there is known up to how it is measured: its place is in these ratios.
    wanted = (BETWEEN @ shapes) / shapes[0]
    ratio, expected = joint / drive, wanted
    assert ratio[1] / ratio[0] == pytest.approx(expected[1] / expected[0], rel=0.05)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.2 * NOISE
    # Its shapes are charged with the force: one number of it and two of the joint.
    assert best.state.freedom == len(best.state.added[0].values) + 2


def test_a_given_structure_keeps_the_joint_that_it_states(base):
    whole = structure(base, "position")
    _, shapes = eigh(SPRINGS, MASSES)
    joint = (BETWEEN @ shapes) * np.sign(shapes[0])
    stated = replace(
        whole.chain[0], joint=tuple(joint.tolist()), drive=tuple(np.abs(shapes[0]))
    )
    records = tuple(moved(level) for level in (1.0, 2.0))
    sample = ScoredSamples.of(records)
    chain = (stated, *whole.chain[1:])
    given = ModelState(chain, records, sample, hold="linear").settled()
    score = Score.plain(sample, NOISE**2)
    as_it_is, *_ = hosts(given, Quantities("force", "position"), False, score)
    found = search(as_it_is.fitted, score, offered=["stiffness-hardening"])
    best = min(found, key=lambda item: item.score)
    assert best.effects == ("stiffness-hardening",)
    assert best.state.chain[0] == stated
    # Where the joint is stated, so is how a force is measured.
    law = best.state.chain[best.state.added[0].blocks[0]]
    q = np.array([0.03, 0.06])
    assert against((law,), q, 0 * q, DT) == pytest.approx(CUBE * q**3, rel=0.05)
    assert np.sqrt(np.mean(best.state.residual**2)) < 1.2 * NOISE


def test_a_structure_that_is_given_has_the_numbers_that_it_states():
    """A share of the velocity may be left out, and is then no number of it."""
    modes = {"stiffness": (4.0, 25.0), "damping": (0.1, 0.2), "drive": (1.0, 1.0)}
    given = Structure(**modes, modal_constant=(1.0, -0.5))
    state = SimpleNamespace(chain=(given,), value=lambda free: 1.0)
    names = [free.parameter for free in own_numbers(state, 0)]
    assert names == ["stiffness"] * 2 + ["damping"] * 2 + ["modal_constant"] * 2

"""A force that acts in more modes than one."""

from functools import cache, partial

import numpy as np
import pytest

from hystbench.blocks.attached import attached
from hystbench.blocks.iwan_force import IwanForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_mechanism import OtherMechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.gap.fitting.least_squares import fitted
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import Added, Free, ModelState
from hystbench.gap.inside.combine_forces import may_gain
from hystbench.gap.inside.further_modes import (
    further_words,
    in_further_modes,
    with_another_mode,
    with_modes,
)
from hystbench.gap.inside.insert_law import laws_for
from hystbench.gap.inside.modes import NUMBERS, frequency_of, sum_of
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.record import Channel, Record

DT, NOISE = 0.01, 1e-6
TIME = np.arange(1000) * DT
FORCE, MOTION = Channel("force", "N"), Channel("motion", "m")


def numbers(frequency, damping=0.01):
    """Give a mode of one kilogram."""
    turns = 2 * np.pi * frequency
    return {"mass": 1.0, "damping": 2 * damping * turns, "stiffness": turns**2}


FIRST, SECOND, THIRD = numbers(2.0), numbers(4.5), numbers(8.0)


def slips(mode, share=0.3, distance=0.02):
    """Give a joint that holds a share of the stiffness of a mode."""
    return IwanForce(stiffness=share * mode["stiffness"], slip_distance=distance)


def others(*modes):
    """Give modes as one ratio, from poles by hand."""
    poles, residues = [], []
    for mode in modes:
        pole = np.roots([1.0, mode["damping"], mode["stiffness"]])[0]
        poles += [pole, pole.conj()]
        residues += [1 / (2j * pole.imag), -1 / (2j * pole.imag)]
    like = OtherModes(numerator=(1.0,), denominator=(1.0, 1.0), hold="linear")
    return sum_of(like, np.array(poles), np.array(residues), 0.0)


def state_of(truth, chain, free, added):
    random = np.random.default_rng(3)
    u = random.standard_normal(len(TIME))
    records = []
    for level in (2.0, 10.0, 30.0):
        y = attached(truth)[0].simulate(level * u, level * u, DT)
        y = y + NOISE * random.standard_normal(len(y))
        records.append(
            Record(f"level {level}", DT, level * u, y, FORCE, MOTION, "measured")
        )
    records = tuple(records)
    return ModelState(
        chain, records, ScoredSamples.of(records), tuple(free), added, hold="linear"
    )


@cache
def found_with(second):
    """Give what a search has found that put a joint into the first mode alone."""
    host, joint = Mechanism(**FIRST, hold="linear"), slips(FIRST)
    mode = OtherMechanism(**SECOND, hold="linear")
    truth = (host, joint, mode, *second, others(THIRD))
    # A base has a joint that holds as a spring, or a damping that is wrong.
    wrong = {"stiffness": 1.3} if second else {"damping": 1.5}
    base = {key: value * wrong.get(key, 1.0) for key, value in SECOND.items()}
    chain = (host, joint, others(base, THIRD))
    free = [
        *(Free(0, name) for name in NUMBERS),
        *(Free(1, name) for name in ("stiffness", "slip_distance")),
    ]
    added = (Added("hysteretic-force", "inside", "plays", (1,), {}, 2.0),)
    state = state_of(truth, chain, free, added)
    score = Score.plain(state.sample, NOISE**2)
    return fitted(state, score), score


OFFER = partial(laws_for, turns="", offered=("hysteretic-force",))


def test_a_joint_is_found_in_a_second_mode_as_the_same_effect():
    found, score = found_with((slips(SECOND),))
    wider, modes = in_further_modes(found, OFFER, score)
    assert modes == pytest.approx([4.5 * np.sqrt(1.3)])
    state = wider.state
    (effect,) = state.added
    assert [state.chain[k].name for k in effect.blocks] == ["iwan-force"] * 2
    joint = state.chain[effect.blocks[1]]
    assert joint.stiffness == pytest.approx(0.3 * SECOND["stiffness"], rel=0.1)
    assert joint.slip_distance == pytest.approx(0.02, rel=0.1)
    assert np.sqrt(state.power(0.0)) < 0.01 * np.sqrt(found.state.power(0.0))
    assert wider.effects == ("hysteretic-force",)


def test_no_joint_has_the_credit_of_a_damping_that_is_wrong():
    found, score = found_with(())
    assert may_gain(found, score)
    wider, modes = in_further_modes(found, OFFER, score)
    assert (wider, modes) == (found, ())


def test_a_mode_taken_out_does_what_it_did():
    found, _ = found_with((slips(SECOND),))
    before = found.state.settled()
    split = list(with_another_mode(before))
    frequencies = [
        frequency_of(next(x for x in one.chain if isinstance(x, OtherMechanism)))
        for one in split
    ]
    assert sorted(frequencies) == pytest.approx([4.5 * np.sqrt(1.3), 8.0])
    size = np.ptp(before.measured)
    for frequency, one in zip(frequencies, split, strict=True):
        np.testing.assert_allclose(one.residual, before.residual, atol=1e-9 * size)
        assert [x.parameter for x in one.free[-4:]] == list(NUMBERS)
        both = with_modes(before, (1.1 * frequency, 1.0))
        np.testing.assert_allclose(both.residual, before.residual, atol=1e-9 * size)
        assert further_words(both).count("Hz") == 2

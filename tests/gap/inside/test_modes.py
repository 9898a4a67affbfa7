"""A transfer function as one mode that is a mechanism, and the others beside it."""

import numpy as np
import pytest

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.inside.modes import frequency_of, modes, one_by_one, taken_out
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.model import Model
from hystbench.record import Channel, Record

DT = 0.005
TIME = np.arange(4000) * DT
FORCE, MOTION = Channel("force", "N"), Channel("motion", "m/s^2")

#: Two modes, at 2 and 5 Hz, whose denominators are multiplied by hand.
LOW, HIGH = [1.0, 0.5, (4 * np.pi) ** 2], [1.0, 1.0, (10 * np.pi) ** 2]
BOTH = np.polymul(LOW, HIGH)


def response(block, f):
    s = 2j * np.pi * f
    return np.polyval(block.numerator, s) / np.polyval(block.denominator, s)


def moves(mode, f):
    """Response of a mass on a spring, from its numbers by hand."""
    s = 2j * np.pi * f
    one = mode.gain / (mode.mass * s**2 + mode.damping * s + mode.stiffness)
    power = ("position", "velocity", "acceleration").index(mode.output)
    further = s ** (power + 1) if power < 2 else s
    return one * (s**power + mode.blend * further)


@pytest.mark.parametrize("output", ["position", "velocity", "acceleration"])
@pytest.mark.parametrize("direct", [0.0, 0.3])
def test_both_parts_together_are_the_whole(output, direct):
    up = np.polyadd(direct * BOTH, [2.0, 30.0, 400.0, 9000.0])
    whole = TransferFunction(numerator=tuple(up), denominator=tuple(BOTH))
    split = list(taken_out(whole, output))
    assert [frequency_of(one.mode) for one in split] == pytest.approx([2.0, 5.0])
    f = np.linspace(0.1, 20, 300)
    for one in split:
        both = moves(one.mode, f) + response(one.rest, f)
        np.testing.assert_allclose(both, response(whole, f), rtol=1e-9)


@pytest.mark.parametrize("real", [[], [1.0, 7.0]])
def test_other_modes_one_by_one_are_the_same_sum(real):
    down = np.polymul(BOTH, [1.0, 7.0]) if real else BOTH
    up = np.polyadd(0.3 * down, [2.0, 30.0, 400.0, 9000.0])
    others = OtherModes(numerator=tuple(up), denominator=tuple(down))
    parts = one_by_one(others)
    orders = [len(part.denominator) - 1 for part in parts]
    assert orders == ([2, 2, 1] if real else [2, 2])
    f = np.linspace(0.1, 20, 300)
    whole = sum(response(part, f) for part in parts)
    np.testing.assert_allclose(whole, response(others, f), rtol=1e-9)


def test_one_mode_is_not_split():
    alone = TransferFunction(numerator=(1.0,), denominator=tuple(LOW))
    rest = Record("rest", DT, TIME, 0 * TIME, FORCE, MOTION, "measured")
    start = ModelState((alone,), (rest,), ScoredSamples.of((rest,)), hold="linear")
    assert list(modes(start, "position")) == []


def test_only_the_mode_that_differs_from_level_to_level_is_given():
    u = np.random.default_rng(2).standard_normal(len(TIME))
    whole = TransferFunction(
        numerator=tuple(np.polyadd(HIGH, LOW)), denominator=tuple(BOTH), hold="linear"
    )
    records = []
    for name, damping in (("low", 0.5), ("high", 1.5)):
        y = sum(
            Mechanism(
                mass=1.0, damping=c, stiffness=k, hold="linear", output="position"
            ).simulate(u, u, DT)
            for _, c, k in ((1.0, damping, LOW[2]), HIGH)
        )
        records.append(Record(name, DT, u, y, FORCE, MOTION, "measured"))
    records = tuple(records)
    start = ModelState((whole,), records, ScoredSamples.of(records), hold="linear")
    (first,) = modes(start, "position")
    assert np.sqrt(first.chain[0].stiffness / first.chain[0].mass) < 20
    model = Model("whole", FORCE, MOTION, first.chain)
    y = model.simulate(u, DT)
    np.testing.assert_allclose(y, whole.simulate(u, u, DT), atol=1e-9 * np.ptp(y))
    (free,) = modes(start, "position", others_too=True)
    numbers = [(x.block, x.parameter, x.element) for x in free.free[4:]]
    assert (1, "denominator", 2) in numbers
    assert (1, "denominator", 0) not in numbers  # the leading one is the scale
    np.testing.assert_allclose(free.residual, first.residual, atol=1e-9 * np.ptp(y))

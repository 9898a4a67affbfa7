"""Several modes of a structure, with forces inside some of them."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.blocks.attached import attached
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.other_mechanism import OtherMechanism
from hystbench.blocks.other_modes import OtherModes
from hystbench.errors import InputError
from tests.blocks.examples import EXAMPLES

DT = 1e-3
U = np.random.default_rng(4).standard_normal(2000)
ONE = Mechanism(mass=0.002, damping=0.2, stiffness=100.0, hold="linear")
OTHER = OtherMechanism(mass=0.004, damping=0.1, stiffness=350.0, hold="linear")
MODES = OtherModes(numerator=(3.0,), denominator=(1.0, 2.0, 900.0), hold="linear")


def force(name):
    return registry()[name].from_mapping(EXAMPLES[name])


def output(*chain):
    (step,) = attached(chain)
    return step.simulate(U, U, DT)


def alone(*chain):
    """Simulate a mode as if nothing else were there."""
    first, *forces = chain
    numbers = {key: getattr(first, key) for key in ("mass", "damping", "stiffness")}
    return output(Mechanism(**numbers, hold="linear"), *forces)


def test_modes_with_forces_of_their_own_are_summed():
    friction, spring = force("friction-force"), force("stiffness")
    together = output(ONE, friction, OTHER, spring, MODES)
    apart = alone(ONE, friction) + alone(OTHER, spring)
    apart = apart + output(ONE, MODES) - alone(ONE)
    np.testing.assert_allclose(together, apart, atol=1e-12 * np.ptp(apart))


def test_a_force_acts_in_the_mode_before_it():
    friction = force("friction-force")
    first = output(ONE, friction, OTHER) - alone(OTHER)
    np.testing.assert_allclose(first, alone(ONE, friction), atol=1e-12)
    second = output(ONE, OTHER, friction) - alone(ONE)
    np.testing.assert_allclose(second, alone(OTHER, friction), atol=1e-12)
    assert np.abs(first - second).max() > 1e-6


def test_no_force_acts_in_what_is_linear():
    with pytest.raises(InputError, match=r"block 3 \(friction-force\).*other-modes"):
        attached((ONE, MODES, force("friction-force")))


def test_numbers_near_are_moved_along_in_each_mode():
    chain = (ONE, force("friction-force"), OTHER, force("stiffness"))
    (step,) = attached(chain)
    size = 1e-6
    for place, name in ((0, "mass"), (2, "stiffness"), (3, "cubic")):
        block, moved = chain[place], list(chain)
        moved[place] = replace(block, **{name: getattr(block, name) * (1 + size)})
        (other,) = attached(moved)
        (first,), (near,) = step.near_records((U,), (DT,), [(other, (U,))])
        expected = output(*moved) - output(*chain)
        off = np.linalg.norm(near - first - expected) / np.linalg.norm(expected)
        assert off < 1e-3, name

"""How far rivals lie apart: which pairs there are, and what a refit takes away."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.blocks import registry
from hystbench.errors import InputError
from hystbench.gap.experiment.separation import (
    Rival,
    RivalPair,
    RivalRun,
    separation,
    separations,
)
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, sine

DT = 0.001


class Shape:
    """A model that is a function of its input; it counts its runs."""

    def __init__(self, shape):
        self.shape, self.runs = shape, 0

    def simulate(self, u, dt):
        self.runs += 1
        return self.shape(u)

    def simulate_near(self, others, u, dt):
        return [item.simulate(u, dt) for item in (self, *others)]


def run(output, *tangents):
    return RivalRun(output, np.array(tangents).T.reshape(len(output), -1))


def test_a_gain_and_an_offset_separate_nothing():
    u = sine(3)
    assert separation(run(u), run(1.7 * u + 3), 0.1) < 1e-9
    # a sine beside a cosine: orthogonal to their mean, the difference stays whole
    other = sine(3, phase=np.pi / 2)
    assert separation(run(u), run(other), 0.1) == pytest.approx(1 / 0.1)
    assert separation(run(u), run(other, u - other), 0.1) < 1e-9


@settings(max_examples=30)
@given(
    st.dictionaries(
        st.sampled_from("ABC"),
        st.sets(st.sampled_from("abcd")).map(sorted),
        max_size=3,
    )
)
def test_every_pair_within_a_set_counts_once_and_none_between_sets(names):
    """The same name in two sets is another model there: pairs are not mixed up."""
    powers = {}
    sets = {}
    for of, members in names.items():
        for name in members:
            powers[of, name] = len(powers)
        sets[of] = {
            name: Rival(Shape(lambda u, k=powers[of, name]: u + u ** (k + 2)))
            for name in members
        }
    u = 0.9 * sine(3)
    found = separations(sets, u, DT, 0.1)
    # Written out: of each set every two that differ, whatever their order.
    expected = {
        (of, frozenset((one, other))): separation(
            run(u + u ** (powers[of, one] + 2)),
            run(u + u ** (powers[of, other] + 2)),
            0.1,
        )
        for of, members in names.items()
        for one in members
        for other in members
        if one != other
    }
    assert len(found) == len(expected)
    for pair, size in found.items():
        assert size == pytest.approx(expected[pair.of, frozenset(pair.names)])


def test_a_rival_runs_once_though_it_is_in_many_pairs():
    shapes = [Shape(lambda u, k=k: u + u**k) for k in (2, 3, 4, 5)]
    shared, *others = (Rival(shape, (shape,)) for shape in shapes)
    sets = {"A": {"A": shared, "b": others[0], "c": others[1]}}
    assert len(separations(sets, sine(3), DT, 0.1)) == 3
    assert [shape.runs for shape in shapes] == [2, 2, 2, 0]  # itself, its neighbour


def test_a_pair_is_refitted_along_its_own_tangents_and_no_other():
    """A third rival could be refitted to what tells the first two apart."""
    u = sine(3)

    plain = {"a": Rival(Shape(lambda u: u)), "b": Rival(Shape(lambda u: u + u**3))}
    third = Shape(lambda u: u + u**2)
    cubes = (Shape(lambda u: u + u**2 + u**3),)
    alone = separations({"a": plain}, u, DT, 0.1)[RivalPair("a", ("a", "b"))]
    beside = separations({"a": plain | {"c": Rival(third, cubes)}}, u, DT, 0.1)
    assert alone > 0.5
    assert beside[RivalPair("a", ("a", "b"))] == pytest.approx(alone)
    own = plain | {"b": Rival(plain["b"].model, (Shape(lambda u: u + 2 * u**3),))}
    assert separations({"a": own}, u, DT, 0.1)[RivalPair("a", ("a", "b"))] < 1e-6


@pytest.mark.parametrize("in_tangent", [False, True])
def test_a_model_that_runs_away_has_no_pair_and_the_others_keep_theirs(in_tangent):
    def away(u, *rest):
        return np.full_like(u, np.inf)

    lost = Rival(Shape(away))
    if in_tangent:
        lost = Rival(Shape(np.square), (Shape(away),))
    stays = {"a": Rival(Shape(lambda u: u)), "b": Rival(Shape(lambda u: u + u**2))}
    found = separations({"a": stays | {"lost": lost}}, sine(3), DT, 0.1)
    assert list(found) == [RivalPair("a", ("a", "b"))]


def test_tangents_are_the_slopes_of_the_output():
    """Of a gain: the input, by the step of a thousandth of the gain."""
    block = registry()["gain"](value=2.0)
    model = Model("m", CURRENT, DISPLACEMENT, (block,))
    u = sine(3)
    found = Rival.of(model, ["gain.value", "gain.offset"]).run(u, DT).tangents
    assert found[:, 0] == pytest.approx(2e-3 * u)
    # of nothing an absolute step
    assert found[:, 1] == pytest.approx(1e-3)


def test_a_word_is_no_parameter_to_refit():
    block = registry()["eddy-diffusion"](time_constant_s=0.003, geometry="rod")
    model = Model("d", CURRENT, DISPLACEMENT, (block,))
    with pytest.raises(InputError, match=r"^eddy-diffusion.geometry: 'rod' is no"):
        Rival.of(model, ["eddy-diffusion.geometry"])

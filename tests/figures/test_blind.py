"""Figures of the contest show every family of plants that it has."""

from hystbench.challenge.plant.effects import MACHINES
from hystbench.challenge.spec import ACTUATORS
from hystbench.figures import blind


def test_every_family_of_the_contest_has_a_colour_and_a_marker_of_its_own():
    assert {*blind.MACHINES} == {*MACHINES}
    assert {*blind.FAMILIES} == {*ACTUATORS}
    for families in (blind.MACHINES, blind.FAMILIES):
        looks = [(color, marker) for _, color, marker in families.values()]
        assert len({*looks}) == len(looks)

"""Which identified bases integrate over their records."""

import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.integrator import integrates
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.model import Model
from hystbench.record import Channel

ENDS = Channel("voltage", "V"), Channel("angle", "rad")


def filters(numerator, denominator):
    return (TransferFunction(numerator=numerator, denominator=denominator),)


def identified(chain):
    return IdentifiedModel(
        "linear", *ENDS, chain, free=("transfer-function.numerator",)
    )


@pytest.mark.parametrize(
    ("numerator", "denominator", "over"),
    [
        ((1.0,), (0.01, 1.0, 0.0), True),  # a motor's angle
        ((1.0,), (0.1, 10.01, 1.0), True),  # a time constant of 10 s
        ((1.0,), (0.01, 1.01, 1.0), False),  # of 1 s
        ((0.91, 10.0), (1.0, 10.1, 1.0), True),
        ((9.1, 1.0), (1.0, 10.1, 1.0), False),  # a creep of a tenth, by 10 s
    ],
)
def test_a_base_integrates_if_most_of_its_gain_is_slower_than_the_records(
    numerator, denominator, over
):
    base = identified(filters(numerator, denominator))
    assert integrates(base, 5.0) == over


def test_a_base_that_was_given_is_believed():
    chain = filters((1.0,), (0.01, 1.0, 0.0))
    assert not integrates(Model("motor", *ENDS, chain), 5.0)

"""What comes to rest without overshoot, and what drives a machine."""

from dataclasses import replace

import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.effects import effects
from hystbench.gap.effects.places import drives_a_machine, only_lags
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import Channel
from tests.gap.small import block, records


@pytest.mark.parametrize(
    ("numerator", "denominator", "rests"),
    [
        ((-2.0,), (0.5, 1.0), True),
        # Four equal lags: their poles are hardly told as real.
        ((1.0,), (1.0, 4.0, 6.0, 4.0, 1.0), True),
        ((1.0, 1.5), (1.0, 3.0, 2.0), True),
        # A lead overshoots, a damper's force ends at zero, a mass swings or goes on.
        ((3.0, 1.0), (1.0, 1.0), False),
        ((1.0, 0.0), (1.0, 1.0), False),
        ((1.0,), (1.0, 0.2, 1.0), False),
        ((1.0,), (1.0, 1.0, 0.0), False),
    ],
)
def test_what_overshoots_or_goes_on_is_no_lag(numerator, denominator, rests):
    chain = (TransferFunction(numerator=numerator, denominator=denominator),)
    assert only_lags(Simulation((*chain, block("gain", value=2.0)), records())) == rests


@pytest.mark.parametrize(
    ("given", "shown", "machine"),
    [
        ("N", "mm", True),
        ("N*m", "rad/s", True),
        ("N", "m/s^2", True),
        # A current, or a voltage, may pass a material first; a force may be read.
        ("A", "um", False),
        ("V", "mm", False),
        ("N", "V", False),
    ],
)
def test_a_force_that_moves_meets_no_material(given, shown, machine):
    """So what limits it is the drive's, in a linear base as in a mass."""
    channels = Channel("in", given), Channel("out", shown)
    own = tuple(
        replace(record, input=channels[0], output=channels[1]) for record in records()
    )
    swings = TransferFunction(numerator=(1.0,), denominator=(1.0, 0.2, 1.0))
    simulation = Simulation((swings, block("gain", value=2.0)), own)
    assert drives_a_machine(simulation) == machine
    known = effects()
    soft = [x.start for x in known["drive-saturation"].every_variant(simulation)]
    material = [x.start for x in known["saturation"].every_variant(simulation)]
    assert 0 in soft
    assert (0 in material) != machine


def test_a_gain_is_no_machine():
    channels = {"input": Channel("in", "N"), "output": Channel("out", "mm")}
    own = tuple(replace(record, **channels) for record in records())
    assert not drives_a_machine(Simulation((block("gain", value=2.0),), own))

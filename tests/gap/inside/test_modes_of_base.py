"""Modes of a transfer function, each as a mechanism."""

import numpy as np
import pytest

from hystbench.blocks.other_modes import OtherModes
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.poles import poles_of, residues_of
from hystbench.gap.inside.modes_of_base import mode_of, one_by_one
from hystbench.record import Channel

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
    poles = poles_of(whole)
    residues = residues_of(whole, poles)
    places = [k for k in np.argsort(np.abs(poles)) if poles[k].imag > 0]
    split = [mode_of(whole, poles[k], residues[k], output) for k in places]
    rates = [np.sqrt(mode.stiffness / mode.mass) for mode, _ in split]
    assert rates == pytest.approx([4 * np.pi, 10 * np.pi])
    f = np.linspace(0.1, 20, 300)
    both = sum(moves(mode, f) - through for mode, through in split) + direct
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

"""A base that is a function is told of steps that are too long, and of no others."""

import numpy as np
import pytest
from scipy.signal import lfilter

from hystbench.blocks.external import External
from hystbench.blocks.gain import Gain
from hystbench.gap.fitting.own_steps import too_long_steps
from hystbench.model import Model
from hystbench.record import Channel, Record

DT, LAG_S = 1e-3, 4e-3
CURRENT, STROKE = Channel("current", "A"), Channel("stroke", "um")
T = DT * np.arange(2000)


def euler(u, dt):
    """A lag by Euler's explicit steps, of first order in dt."""
    return lfilter([0.0, dt / LAG_S], [1.0, dt / LAG_S - 1.0], u)


def exact(u, dt):
    """The same lag, exact for an input that moves straight between samples."""
    a = np.exp(-dt / LAG_S)
    mean = (1 - a) * LAG_S / dt
    return lfilter([1 - mean, mean - a], [1.0, -a], u)


def whole_only(u, dt):
    if len(u) != len(T):
        raise ValueError("made for one record")
    return exact(u, dt)


def record(gap, cycles=30.0):
    u = np.sin(2 * np.pi * cycles * T)
    y = exact(u, DT) + gap * np.sin(2 * np.pi * 7.0 * T)
    return Record(f"sine-{cycles:g}", DT, u, y, CURRENT, STROKE, "measured", "fit")


def said(function, *records, hold="linear"):
    base = Model("rig", CURRENT, STROKE, (External(function=f"{__name__}:{function}"),))
    return too_long_steps(base, records, hold, 0.01)


def test_a_change_that_matters_beside_the_gap_is_told_in_the_outputs_unit():
    one = record(gap=0.1)
    (line,) = said("euler", one, record(gap=0.1, cycles=3.0))
    u = np.interp(np.arange(2 * len(T) - 1) / 2, np.arange(len(T)), one.u)
    plain = euler(one.u, DT)
    changed = np.sqrt(np.mean((euler(u, DT / 2)[::2] - plain) ** 2))
    gap = np.sqrt(np.mean((one.y - plain) ** 2))
    assert "sine-30" in line  # the faster of the two
    assert f"changes by {changed:.3g} um rms" in line
    assert f"it leaves {gap:.3g} um there" in line
    assert f"Up to {200 * changed / gap:.0f} % of that" in line


@pytest.mark.parametrize("hold", ["linear", "zero-order", "band-limited"])
def test_nothing_is_said_of_a_gap_that_steps_cannot_make(hold):
    assert said("euler", record(gap=10.0), hold=hold) == []


def test_nothing_is_said_of_a_function_whose_steps_are_exact():
    assert said("exact", record(gap=0.1)) == []


def test_a_function_that_takes_no_other_record_is_told_so():
    (line,) = said("whole_only", record(gap=0.1))
    assert "is not known" in line
    assert "made for one record" in line


def test_other_bases_are_not_asked():
    blocks = Model("gain", CURRENT, STROKE, (Gain(value=1.0),))
    assert too_long_steps(blocks, (record(gap=0.1),), "linear", 0.01) == []


def fixed(u, dt):
    """The same lag by numbers that belong to one interval."""
    return exact(u, DT)


def test_a_function_for_one_interval_is_not_blamed():
    """It changes by more than the gap: that cannot be an error that it makes."""
    assert said("fixed", record(gap=0.01)) == []


def test_a_record_that_rests_tells_nothing_of_steps():
    rests = record(gap=0.1, cycles=0.0)
    assert said("euler", rests) == []
    assert len(said("euler", rests, record(gap=0.1))) == 1

"""Which of several linear models is taken, by its errors on records and on folds."""

import numpy as np
import pytest

from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.linear import linear_of
from hystbench.gap.bases.orders import Judged, Orders, none_lowers_both
from hystbench.gap.records.evidence import Evidence
from hystbench.quantities import Quantities
from tests.gap.examples import plain_play
from tests.gap.made import record


@pytest.mark.parametrize(
    ("fit", "folds", "stays"),
    [
        (0.9, 1.9, True),  # better on the records it was fitted to
        (0.9, 2.1, False),  # but worse than a constant on others
        (1.1, 1.9, False),  # worse on both
    ],
)
def test_what_does_worse_on_folds_than_a_constant_is_no_rival(fit, folds, stays):
    other = Judged(1.0, 1.0, 2.0)
    assert none_lowers_both(Judged(fit, folds, 2.0), [other]) == stays


def test_where_all_do_worse_than_a_constant_the_errors_decide():
    worse = Judged(1.0, 3.0, 2.0)
    assert none_lowers_both(Judged(0.9, 4.0, 2.0), [worse])
    assert not none_lowers_both(Judged(1.1, 4.0, 2.0), [worse])


APART = ((0.0 - 3.0) ** 2, (1.0 - 2.5) ** 2, (5.0 - 0.5) ** 2)


@pytest.mark.parametrize(
    ("gives", "squares"),
    [("level", APART), ("position", (0.0, 0.0, 0.0))],
    ids=["a level", "a sensor whose zero may be another one every time"],
)
def test_a_constant_is_judged_on_folds_as_models_are(gives, squares):
    """Three records, each constant: the mean of two is off by half their distance."""
    levels = (0.0, 1.0, 5.0)
    records = tuple(
        record(np.sin(0.1 * k * np.arange(400)), np.full(400, level), name=f"{k}")
        for k, level in enumerate(levels, start=1)
    )
    about = Quantities("voltage", gives)
    found = Orders(Evidence("made", records, (), "linear", quantities=about))
    assert found.constant == pytest.approx(np.sqrt(np.mean(squares)))


def filtered(u, dt, up, down):
    block = TransferFunction(numerator=up, denominator=down, hold="linear")
    return block.simulate(u, u, dt)


def lagging(disturbed=0.0, tau_s=None):
    """A lag, disturbed by a sine that no input causes, or beside a mode that swings."""
    dt, n = 0.01, 1200
    rng = np.random.default_rng(3)
    u = np.convolve(rng.standard_normal(n), np.ones(20) / 20, "same")
    y = filtered(u, dt, (1.0,), (0.3, 1.0))
    y += disturbed * np.std(y) * np.sin(2 * np.pi * 0.4 * dt * np.arange(n))
    if tau_s:
        mode = (1.0, 2 / tau_s, (2 * np.pi * 2.0) ** 2)
        y += filtered(u, dt, (30.0,), mode)
    y += 0.01 * np.std(y) * rng.standard_normal(n)
    return Evidence("made", (record(u, y, dt=dt),), (), "linear")


def swings(found):
    poles = np.roots(found.model.chain[0].denominator)
    return poles[poles.imag > 0]


def test_a_disturbance_is_no_swing_of_the_base():
    """A pole that hardly fades goes on as the sine does, on folds as well."""
    assert all(-1 / swings(linear_of(lagging(0.3))).real < 12.0)  # the record has 12 s


def test_a_device_that_swings_for_longer_than_its_record_keeps_its_mode():
    (pole,) = swings(linear_of(lagging(tau_s=60.0)))
    assert pole.imag == pytest.approx(2 * np.pi * 2.0, rel=1e-3)
    assert -1 / pole.real > 30.0


def test_harmonics_of_a_loop_are_no_swing_of_the_base():
    """A mode at three times the frequency of a sine needs no input to be there."""
    dt, n = 0.02, 500
    u = np.sin(2 * np.pi * 0.5 * dt * np.arange(n))
    loop = 0.3 * u + plain_play(u, 0.4)
    y = loop + 1e-3 * np.random.default_rng(4).standard_normal(n)
    found = linear_of(Evidence("made", (record(u, y, dt=dt),), (), "linear"))
    assert all(-1 / swings(found).real < 10.0)  # the record has 10 s

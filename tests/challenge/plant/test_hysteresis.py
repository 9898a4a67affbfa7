"""The plant's hystereses against their definitions, written plainly."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hystbench.challenge.plant.hysteresis import (
    LARGEST_CURRENT,
    PUBLISHED,
    Duhem,
    Everett,
    GeneralizedPlays,
    JilesAthertonLoop,
    draw,
    swing,
)

PLANE = Everett(
    interaction=0.3,
    centre=0.05,
    coercive=0.1,
    coercive_spread=0.5,
    irreversible=20.0,
    reversible=0.0,
    knee=1.0,
    points=81,
)
ROD = JilesAthertonLoop(
    bias=0.9, shape=0.5, coupling=0.2, pinning=0.05, reversible=0.3, strain=100.0
)
inputs = st.lists(st.floats(-0.9, 0.9), min_size=1, max_size=30)
inside = st.floats(-0.5, 0.5)


@given(inputs, st.lists(st.floats(1.0, 4.0), min_size=30, max_size=30))
def test_plays_by_their_definition(samples, growth):
    plays = GeneralizedPlays(PUBLISHED, np.array([0.0, 0.02, 0.09]), np.arange(1.0, 4))
    v, growth = np.array(samples), np.array(growth[: len(samples)])
    a = PUBLISHED
    expected = []
    state = [0.0, 0.0, 0.0]
    for value, factor in zip(v, growth, strict=True):
        left = a[0] * np.tanh(a[1] * value + a[2]) + a[3]
        right = a[4] * np.tanh(a[5] * value + a[6]) + a[7]
        for i, r in enumerate(plays.thresholds):
            state[i] = max(right - factor * r, min(left + factor * r, state[i]))
        expected.append(float(np.dot(plays.weights, state)))
    assert plays.respond(v, growth) == pytest.approx(np.array(expected), abs=1e-12)


def relay_sum(plane, v):
    """Every relay of the plane's cells by itself; switching at the cells' corners."""
    table = plane.table
    # a cell's weight is the mixed difference of Everett's function
    mass = table[1:, :-1] - table[:-1, :-1] - table[1:, 1:] + table[:-1, 1:]
    edges = np.linspace(-plane.limit, plane.limit, plane.points)
    up, down = edges[1:, None], edges[None, :-1]
    state = np.zeros_like(mass, dtype=bool)
    out = []
    for value in v:
        state = np.where(value >= up, True, np.where(value <= down, False, state))
        out.append(float((mass * state).sum()))
    return np.array(out)


@settings(max_examples=40)
@given(st.lists(st.integers(-38, 38), min_size=1, max_size=25))
def test_everett_is_a_sum_of_relays(nodes):
    # from negative saturation, where every relay is down
    v = np.linspace(-1.0, 1.0, 81)[np.array([-40, *nodes]) + 40]
    y = PLANE.respond(v)
    assert y - y[0] == pytest.approx(relay_sum(PLANE, v), abs=1e-9)


def test_everett_weighs_what_it_says():
    assert PLANE.table[-1, 0] == pytest.approx(20.0)


@given(st.lists(inside, max_size=20), st.lists(inside, min_size=1, max_size=10))
def test_wiping_out(history, after):
    # An extremum beyond all before it leaves no trace of them.
    extremes = [-0.8, 0.8]
    long = PLANE.respond(np.array([*extremes, *history, *extremes, *after]))
    short = PLANE.respond(np.array([*extremes, *after]))
    assert long[-len(after) :] == pytest.approx(short[-len(after) :], abs=1e-9)


@given(st.lists(inside, max_size=10), st.lists(inside, max_size=10), inside, inside)
def test_congruency(one, other, first, second):
    # Minor loops between two inputs are the same but for a shift.
    low, high = min(first, second), max(first, second)
    path = np.concatenate([[low, high], np.linspace(high, low, 9)])
    loops = []
    for history in (one, other):
        y = PLANE.respond(np.array([*history, low, high, *path]))[-len(path) :]
        loops.append(y - y[0])
    assert loops[0] == pytest.approx(loops[1], abs=1e-9)


@given(inputs, st.integers(2, 5))
def test_everett_does_not_know_the_rate(samples, slower):
    v = np.array(samples)
    fine = np.interp(np.arange(len(v) * slower) / slower, np.arange(len(v)), v)
    assert PLANE.respond(fine)[::slower] == pytest.approx(PLANE.respond(v), abs=1e-9)


def test_a_demagnetized_plane_rises_evenly_to_both_sides():
    even = replace(PLANE, centre=0.0)
    up, down = even.respond(np.array([0.0, 0.6])), even.respond(np.array([0.0, -0.6]))
    assert up[1] == pytest.approx(-down[1], abs=0.02 * abs(up[1]))


def test_jiles_atherton_follows_its_equation():
    # Along a rising field, by another integrator, where walls and field agree.
    field = np.linspace(0.0, 1.5, 400)
    y = ROD.respond(field)
    p = ROD

    def langevin(x):
        return 1 / np.tanh(x) - 1 / x

    def slope(h, m):
        x = (h + p.coupling * m[0]) / p.shape
        gap, rate = langevin(x) - m[0], (1 / x**2 - 1 / np.sinh(x) ** 2) / p.shape
        wall = max(gap, 0.0) / (p.pinning - p.coupling * gap)
        c = p.reversible
        return [((1 - c) * wall + c * rate) / (1 - c * p.coupling * rate)]

    for k in (0, 150):
        start = np.sqrt(y[k] / p.strain + _remanence(p) ** 2)
        found = solve_ivp(
            slope,
            (p.bias + field[k], p.bias + field[-1]),
            [start],
            rtol=1e-9,
            atol=1e-11,
        )
        end = np.sqrt(y[-1] / p.strain + _remanence(p) ** 2)
        assert found.y[0, -1] == pytest.approx(end, rel=1e-4)


def _remanence(rod):
    """Magnetization on the bias: from the strain at a field that undoes the bias."""
    # m^2 - m0^2 is least where m is zero, on the way down through it
    down = rod.respond(np.linspace(0.0, -2.0 * rod.bias, 20001))
    return np.sqrt(-down.min() / rod.strain)


@given(st.floats(0.05, 0.6), st.integers(1, 4))
def test_jiles_atherton_never_has_a_negative_susceptibility(amplitude, turns):
    v = amplitude * np.sin(np.linspace(0, 2 * np.pi * turns, 400 * turns + 1))
    step, rise = np.diff(v), np.diff(ROD.respond(v))
    assert (step * rise >= -1e-12).all()


DUHEM = Duhem(rate=8.0, stiff=0.4, knee=0.7, bias=0.1, height=30.0)


@pytest.mark.parametrize("turn", [0.2, 0.55])
def test_duhem_follows_its_equation(turn):
    def slope(v, y, direction):
        rest = np.tanh(DUHEM.bias / DUHEM.knee)
        f = np.tanh((v + DUHEM.bias) / DUHEM.knee) - rest
        rise = (1.0 - (f + rest) ** 2) / DUHEM.knee
        return direction * DUHEM.rate * (f - y) + DUHEM.stiff * rise

    y = 0.0
    for start, end in ((0.0, turn), (turn, -0.6), (-0.6, 0.1)):
        way = np.sign(end - start)
        found = solve_ivp(slope, (start, end), [y], args=(way,), rtol=1e-9, atol=1e-12)
        y = found.y[0, -1]
    assert DUHEM.respond(np.array([0.0, turn, -0.6, 0.1]))[-1] == pytest.approx(
        DUHEM.height * y, rel=1e-3
    )


def test_a_minor_loop_of_duhem_does_not_close():
    """What an operator of plays and Preisach's would do."""
    path = np.array([0.0, 0.5, 0.1, 0.5])
    y = DUHEM.respond(path)
    assert abs(y[3] - y[1]) > 0.01 * np.ptp(y)
    of_plane = PLANE.respond(path)
    assert of_plane[3] == pytest.approx(of_plane[1], abs=1e-9)


@pytest.mark.parametrize("family", ["gpi", "preisach", "jiles-atherton", "duhem"])
@pytest.mark.parametrize("seed", range(4))
def test_a_drawn_loop_is_a_loop_of_the_stated_swing(family, seed):
    loop = draw(family, np.random.default_rng(seed))
    assert loop.family == family
    assert 30.0 <= swing(loop) <= 55.0
    v = LARGEST_CURRENT * np.sin(np.linspace(0, 4 * np.pi, 4001))
    y = loop.respond(v)
    assert y[0] == pytest.approx(0.0, abs=1e-9)
    # the second time around all but Duhem's have settled
    near = 0.01 * swing(loop) if family == "duhem" else 0.1
    assert y[2000:][np.argmax(v[2000:])] == pytest.approx(y[2000:].max(), abs=near)
    # counterclockwise, as of what lags: falling above rising, by a few percent
    area = -np.sum(0.5 * (y[2001:] + y[2000:-1]) * np.diff(v[2000:]))
    assert 0.01 < area / (2 * LARGEST_CURRENT * swing(loop)) < 0.4

"""The block ``preisach`` against a plain sum over relays; its two properties."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.blocks.preisach import Preisach
from hystbench.errors import InputError

LIMIT, CELLS = 0.8, 12
BLOCK = Preisach(
    limit=LIMIT,
    reversible=3.0,
    weights=[5.0, 2.0],
    centres=[0.1, -0.3],
    centre_spreads=[0.3, 0.2],
    half_widths=[0.0, 0.4],
    half_width_spreads=[0.2, 0.1],
    cells=CELLS,
)
FINE = replace(BLOCK, cells=64)
inputs = st.lists(st.floats(-0.9, 0.9), min_size=1, max_size=40)
inside = st.floats(-0.5, 0.5)
histories = st.lists(inside, max_size=20)


def simulate(block, *parts):
    z = np.concatenate([np.atleast_1d(np.array(part, dtype=float)) for part in parts])
    return block.simulate(z, z, 1e-4)


def relays(block, per_cell):
    """Thresholds and weights of relays spread evenly in each cell."""
    n = int(block.cells)
    found = []
    for weight, centre, spread, half, half_spread in zip(
        block.weights,
        block.centres,
        block.centre_spreads,
        block.half_widths,
        block.half_width_spreads,
        strict=True,
    ):
        cluster = []
        for i in range(n):
            for j in range(i + 1):
                a = block.limit * ((2 * i + 1) / n - 1)
                b = block.limit * ((2 * j + 1) / n - 1)
                density = math.exp(
                    -(((a + b) / 2 - centre) ** 2) / (2 * spread**2)
                    - ((a - b) / 2 - half) ** 2 / (2 * half_spread**2)
                )
                places = [
                    2 * block.limit / n * ((2 * p + 1) / (2 * per_cell) - 0.5)
                    for p in range(per_cell)
                ]
                for p in places:
                    for q in places:
                        up, down = a + p, b + q
                        if up == down:  # half of what lies around is below b = a
                            cluster.append((up, down, density / 2))
                        elif up > down:
                            cluster.append((up, down, density))
        total = sum(mass for _, _, mass in cluster)
        found += [(up, down, weight * mass / total) for up, down, mass in cluster]
    up, down, weights = np.array(found).T
    return up, down, weights


def relay_sum(block, z, per_cell=1):
    """Output of the model, relay by relay, from the demagnetized state."""
    up, down, weights = relays(block, per_cell)
    state = np.zeros(len(up))

    def move(value):
        state[up < value] = 1
        state[down > value] = 0

    n = int(block.cells)
    for k in range(n, 0, -1):  # every half of a cell
        for sign in (1, -1):
            move(sign * block.limit * k / n)
    move(0.0)
    start = weights @ state
    out = []
    for value in z:
        move(value)
        out.append(block.reversible * value + weights @ state - start)
    return np.array(out)


@given(st.lists(st.integers(0, CELLS), min_size=1, max_size=40))
def test_at_the_nodes_of_the_grid_it_is_a_relay_a_cell(nodes):
    # a node lies between relays, so that one relay stands for all of its cell
    z = LIMIT * (2 * np.array([0, *nodes]) / CELLS - 1)
    block, plain = simulate(BLOCK, z), relay_sum(BLOCK, z)
    # counted from saturation: demagnetizing turns within the cells
    np.testing.assert_allclose(block - block[0], plain - plain[0], rtol=0, atol=1e-12)


def test_between_the_nodes_it_is_many_relays_a_cell():
    z = np.random.default_rng(5).uniform(-0.9, 0.9, 60)
    errors = [
        np.abs(simulate(BLOCK, z) - relay_sum(BLOCK, z, per_cell)).max()
        for per_cell in (4, 16)
    ]
    # 192 relays along an axis: each step of the sum is about 7 / 192
    assert errors[1] < 0.04
    assert errors[1] < errors[0] / 3


@given(histories, inputs)
def test_wiping_out(history, after):
    # the excursion to 0.6 wipes out all that stayed within 0.5
    np.testing.assert_allclose(
        simulate(FINE, history, 0.6, after)[len(history) :],
        simulate(FINE, 0.6, after),
        rtol=0,
        atol=1e-12,
    )


@given(histories, histories, inside, inside, st.lists(st.floats(0, 1), max_size=10))
def test_congruency(one, other, first, second, places):
    # minor loops between the same two inputs have one shape, whatever was before
    low, high = sorted((first, second))
    branch = low + (high - low) * np.sort(places)
    loop = np.concatenate([[low], branch, [high], branch[::-1], [low]])
    shapes = [
        simulate(FINE, history, high, loop)[len(history) + 1 :]
        for history in (one, other)
    ]
    np.testing.assert_allclose(
        shapes[0] - shapes[0][0], shapes[1] - shapes[1][0], rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(shapes[0][-1], shapes[0][0], rtol=0, atol=1e-12)


@given(inputs, st.integers(2, 7))
def test_rate_independent(samples, slower):
    # the same path in more samples: the same output where the path is the same
    places = np.arange((len(samples) - 1) * slower + 1) / slower
    path = np.interp(places, np.arange(len(samples)), samples)
    np.testing.assert_allclose(
        simulate(FINE, path)[::slower], simulate(FINE, samples), rtol=0, atol=1e-12
    )


@given(inputs)
def test_the_output_rises_with_the_input(samples):
    y = simulate(FINE, samples)
    assert (np.diff(y) * np.diff(samples) >= -1e-12).all()


def test_it_saturates_and_swings_by_its_weights():
    block = replace(FINE, reversible=0.0)
    y = simulate(block, [5.0, LIMIT, -LIMIT, -5.0, LIMIT])
    np.testing.assert_allclose(y[[1, 3, 4]], y[[0, 2, 0]], rtol=0, atol=1e-12)
    assert y[0] - y[2] == pytest.approx(7.0, abs=1e-12)


def test_a_narrow_cluster_keeps_its_weight():
    narrow = replace(FINE, centre_spreads=[1e-6, 1e-6], half_width_spreads=[1e-6, 1e-6])
    assert narrow.cell_weights.sum() == pytest.approx(7.0)


def test_a_missing_sample_shows():
    assert np.isnan(simulate(replace(FINE, reversible=0.0), [0.1, np.nan])[1])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cells": 12.5}, "cells: expected a whole number, got 12.5"),
        ({"centres": [0.0]}, "centres: expected 2 numbers, as many as weights, got 1"),
        ({"weights": [-1.0, 0.0]}, r"weights\[0\]: -1 is out of bounds"),
    ],
)
def test_what_makes_no_density_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(BLOCK, **change)

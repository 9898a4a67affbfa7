"""Printed equations against hand-worked paths."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.published import load_text
from hystbench.published.equations import (
    gamma_left,
    gamma_right,
    generalized_play,
    generalized_play_eq12,
    play,
    thresholds,
)
from tests.test_operators import sides

ENVELOPE = load_text().envelope


def test_play_by_hand():
    v = np.array([0.0, 2.0, 1.5, -1.0, 0.0])
    out = play(v, np.array([0.5]))[:, 0]
    np.testing.assert_allclose(out, [0.0, 1.5, 1.5, -0.5, -0.5])


def test_generalized_play_stays_between_its_envelopes():
    v = 0.632 * np.sin(np.linspace(0, 12, 500))
    r = np.array([0.1])
    out = generalized_play(v, r, ENVELOPE)[:, 0]
    assert (out >= gamma_right(v, ENVELOPE) - r - 1e-12).all()
    assert (out <= gamma_left(v, ENVELOPE) + r + 1e-12).all()


def test_eq12_rises_along_the_right_envelope_and_holds():
    v = np.array([0.3, 0.6, 0.59])
    out = generalized_play_eq12(v, np.array([0.05]), ENVELOPE)[:, 0]
    rising = gamma_right(v, ENVELOPE) - 0.05
    # at 0.59 the falling bound gamma_l + r lies above: the output holds
    assert gamma_left(v, ENVELOPE)[2] + 0.05 > rising[1]
    np.testing.assert_allclose(out, [rising[0], rising[1], rising[1]])


def test_envelopes_at_zero_by_hand():
    # tanh(0.6025) = (e^1.205 - 1)/(e^1.205 + 1) = 0.538825; tanh(0.1104) = 0.109954
    zero = np.zeros(1)
    assert gamma_left(zero, ENVELOPE)[0] == pytest.approx(0.02680, abs=1e-5)
    assert gamma_right(zero, ENVELOPE)[0] == pytest.approx(0.01064, abs=1e-5)


def test_thresholds_are_equally_spaced_from_zero():
    r = thresholds(3, 0.632, ENVELOPE)
    top = max(f(np.array([0.632]), ENVELOPE)[0] for f in (gamma_left, gamma_right))
    np.testing.assert_allclose(r, [0, top / 4, top / 2, 3 * top / 4])


def test_published_envelope_is_the_one_the_filters_run_with():
    from hystbench.envelope import PUBLISHED_ENVELOPE

    assert PUBLISHED_ENVELOPE.to_dict() == ENVELOPE


@given(
    st.lists(st.floats(-0.632, 0.632), min_size=1, max_size=60),
    st.lists(st.floats(0, 0.5), min_size=1, max_size=4),
)
def test_plain_equations_and_compiled_operators_agree(values, radii):
    from hystbench import operators

    v, r = np.array(values), np.array(radii)
    left, right = gamma_left(v, ENVELOPE), gamma_right(v, ENVELOPE)
    compiled = operators.play(v, r)
    np.testing.assert_allclose(play(v, r), compiled, atol=1e-14)
    compiled = operators.generalized_play(left, right, r)
    np.testing.assert_allclose(generalized_play(v, r, ENVELOPE), compiled, atol=1e-14)
    compiled = operators.generalized_play(*sides("eq12", v, 0.0, left, right), r)
    plain = generalized_play_eq12(v, r, ENVELOPE)
    np.testing.assert_allclose(plain, compiled, atol=1e-14)

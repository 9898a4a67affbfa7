"""The RDGPI model against a loop written out, and its fit."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.errors import InputError
from hystbench.operators import generalized_prandtl_ishlinskii
from hystbench.rdgpi import (
    PUBLISHED_RDGPI,
    RateDependentGPI,
    identify_rdgpi,
)
from hystbench.record import Channel, Record

DT = 1e-3
MODEL = RateDependentGPI(
    alpha1=0.2,
    beta1=1.1,
    lambda1=0.01,
    alpha2=0.1,
    beta2=1.2,
    lambda2=0.02,
    c=1.5,
    rho=30.0,
    tau=2.0,
    envelope_gain=1.3,
    envelope_offset=0.05,
    order=6,
)


def plain(model, u, dt):
    """The equations of the model, one number at a time."""
    state = [0.0] * (model.order + 1)
    y = []
    for k in range(len(u)):
        first, last = max(k - 1, 0), min(k + 1, len(u) - 1)
        rate = abs(u[last] - u[first]) / ((last - first) * dt)
        gamma = model.envelope_gain * u[k] + model.envelope_offset
        total = 0.0
        for i in range(model.order + 1):
            r = i * model.c * model.alpha1
            r *= math.log(model.beta1 + model.lambda1 * rate)
            state[i] = max(gamma - r, min(gamma + r, state[i]))
            loss = model.alpha2 * math.log(model.beta2 + model.lambda2 * rate)
            weight = model.rho * math.exp(-model.tau * r) * (1 - loss)
            total += weight / (model.order + 1) * state[i]
        y.append(total)
    return np.array(y)


def sine(frequency, samples=400):
    return 0.6 * np.sin(2 * np.pi * frequency * DT * np.arange(samples))


def record(name, u, y, dt=DT):
    unit = Channel("input", "A"), Channel("output", "um")
    return Record(name, dt, u, y, *unit, "twin")


@given(
    st.lists(st.floats(-1, 1), min_size=2, max_size=60),
    st.floats(0.0, 1.0),
    st.floats(1.0, 2.0),
    st.floats(-1.0, 3.0),
)
def test_the_compiled_model_is_the_written_one(u, alpha1, beta1, tau):
    model = replace(MODEL, alpha1=alpha1, beta1=beta1, tau=tau)
    u = np.array(u)
    assert model.simulate(u, DT) == pytest.approx(plain(model, u, DT), rel=1e-9)


def test_at_rate_zero_it_is_the_generalized_prandtl_ishlinskii_model():
    still = replace(MODEL, lambda1=0.0, lambda2=0.0)
    u = sine(10)
    r = np.arange(7) * float(MODEL.spacing(0.0))
    weights = float(MODEL.gain(0.0)) * np.exp(-MODEL.tau * r)
    envelope = MODEL.envelope_gain * u + MODEL.envelope_offset
    expected = generalized_prandtl_ishlinskii(envelope, envelope, r, weights)
    assert still.simulate(u, DT) == pytest.approx(expected, rel=1e-12)
    # and so does the full model where the input is slow enough
    assert MODEL.simulate(u, 1e6) == pytest.approx(expected, rel=1e-4)


def test_a_faster_input_widens_the_thresholds_and_lowers_the_output():
    slow, fast = (np.abs(MODEL.simulate(sine(f), DT)[200:]).max() for f in (5, 40))
    assert fast < slow


def test_a_settled_start_is_the_second_of_two_passes():
    u = np.roll(sine(10), 35)
    settled = replace(MODEL, start="settled")
    twice = MODEL.simulate(np.concatenate([u, u]), DT)[len(u) :]
    # where the passes meet, central differences look across
    assert settled.simulate(u, DT)[2:] == pytest.approx(twice[2:], rel=1e-3, abs=1e-3)


def test_the_published_values_run_and_stay_finite():
    for frequency in (1, 10, 100):
        output = PUBLISHED_RDGPI.simulate(0.632 * sine(frequency) / 0.6, DT)
        assert np.isfinite(output).all()
        assert np.ptp(output) > 0


def test_every_symbol_of_the_paper_has_a_name():
    differ = {"envelope_gain": "xi", "envelope_offset": "mu"}
    names = [differ.get(name, name) for name in PUBLISHED_RDGPI.to_dict()]
    printed = [
        "alpha1",
        "alpha2",
        "beta1",
        "beta2",
        "lambda1",
        "lambda2",
        "c",
        "rho",
        "xi",
        "tau",
        "mu",
    ]
    assert sorted(set(names) - {"order", "start"}) == sorted(printed)


def test_what_it_was_fitted_to_is_recovered_at_rates_it_never_saw():
    fitted = [
        record(f"{f} Hz", sine(f), plain(MODEL, sine(f), DT)) for f in (5, 20, 50)
    ]
    fit = identify_rdgpi(fitted, order=6)
    assert set(fit.relative_error) == {"5 Hz", "20 Hz", "50 Hz"}
    assert max(fit.relative_error.values()) < 0.01
    for frequency in (10, 35):
        y = plain(MODEL, sine(frequency), DT)
        error = fit.model.simulate(sine(frequency), DT) - y
        assert np.sqrt(np.mean(error**2) / np.mean(y**2)) < 0.01


def test_the_errors_told_are_those_of_the_whole_free_run():
    u = sine(20, 3000)
    y = plain(MODEL, u, DT) + 0.1 * np.random.default_rng(0).standard_normal(len(u))
    fit = identify_rdgpi([record("noisy", u, y)], order=6, starts=1)
    error = plain(fit.model, u, DT) - y
    assert fit.model.start == "rest"
    assert fit.relative_error["noisy"] == pytest.approx(
        np.sqrt(np.sum(error**2) / np.sum(y**2)), rel=1e-9
    )


@pytest.mark.parametrize(("unit_u", "unit_y", "unit_t"), [(1e3, 1, 1), (1, 1e-6, 1e3)])
def test_units_change_no_error(unit_u, unit_y, unit_t):
    def fit(unit_u, unit_y, unit_t):
        made = [
            record(str(f), unit_u * sine(f), unit_y * plain(MODEL, sine(f), DT), unit_t)
            for f in (5, 50)
        ]
        return identify_rdgpi(made, order=6, starts=1).relative_error

    one, other = fit(1, 1, DT), fit(unit_u, unit_y, unit_t * DT)
    assert list(other.values()) == pytest.approx(list(one.values()), rel=0.05, abs=1e-4)


def test_the_same_seed_gives_the_same_model():
    made = [record("sine", sine(20), plain(MODEL, sine(20), DT))]
    assert identify_rdgpi(made, 6, seed=3) == identify_rdgpi(made, 6, seed=3)


def test_parameters_survive_a_dictionary():
    model = replace(MODEL, start="settled")
    assert RateDependentGPI(**model.to_dict()) == model


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"tau": float("nan")}, "rdgpi.tau: nan is not a finite number"),
        ({"beta1": 0.9}, "beta1 of 1 or more"),
        ({"c": -1.0}, "alpha1 c of 0 or more"),
        ({"beta2": 0.0}, "rdgpi.beta2: expected above 0"),
        ({"lambda2": -1.0}, "rdgpi.lambda2: expected 0 or more"),
        ({"order": -1}, "rdgpi.order"),
        ({"start": "setled"}, "did you mean 'settled'"),
    ],
)
def test_parameters_that_define_no_model_are_refused(parameters, message):
    with pytest.raises(InputError, match=message):
        replace(MODEL, **parameters)


@pytest.mark.parametrize(
    ("u", "dt", "message"),
    [
        (np.zeros(1), DT, "two samples"),
        (np.array([0.0, np.inf]), DT, "not finite"),
        (np.zeros(5), 0.0, "sampling interval"),
    ],
)
def test_an_input_that_has_no_rate_is_refused(u, dt, message):
    with pytest.raises(InputError, match=message):
        MODEL.simulate(u, dt)


def test_a_fit_refuses_no_records_and_a_constant_input():
    with pytest.raises(InputError, match="one record or more"):
        identify_rdgpi([])
    with pytest.raises(InputError, match="record still: the input is constant"):
        identify_rdgpi([record("still", np.ones(50), sine(5, 50))])

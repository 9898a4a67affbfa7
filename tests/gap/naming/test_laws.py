"""Laws of one name: each is found under it, before what can imitate any."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import sawtooth

from hystbench.gap.effects import effects
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import finished
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.floor import Floor
from hystbench.gap.simulation.simulation import Simulation
from hystbench.gap.thresholds import PAYS, SHAPE
from tests.gap.made import record
from tests.gap.small import block, hysteresis, measured, records, state_of

NOISE = 0.01
FLOOR = Floor(NOISE, "declared")
GAIN = block("gain", value=12.0, offset=0.5)
LOOP = hysteresis()
PLAYS = block(
    "prandtl-ishlinskii", thresholds=[0.05, 0.2, 0.4], weights=[0.06, -0.03, 0.05]
)
# What is hidden beside a hysteresis or a gain: the whole chain that makes the data, in
# laws that are the physics of one name.
HIDDEN = {
    "square of the field": (
        "asymmetry",
        (LOOP,),
        (block("asymmetry", coefficient=0.08), LOOP),
    ),
    "butterfly": (
        "asymmetry",
        (LOOP,),
        (LOOP, block("butterfly", coefficient=2.0, threshold=0.1)),
    ),
    "field": (
        "saturation",
        (LOOP,),
        (block("saturation", level=1.6), LOOP),
    ),
    "field, algebraic": (
        "saturation",
        (LOOP,),
        (block("saturation", level=1.0, sharpness=4.0), LOOP),
    ),
    "rounded": (
        "drive-saturation",
        (LOOP,),
        (block("saturation", level=0.8, sharpness=8.0), LOOP),
    ),
    "algebraic": (  # Froelich's law
        "saturation",
        (LOOP,),
        (LOOP, block("saturation", level=100.0, sharpness=1.0)),
    ),
    "half-space": (
        "eddy-diffusion",
        (LOOP,),
        (block("eddy-diffusion", time_constant_s=1e-4, geometry="half-space"), LOOP),
    ),
    "logarithmic": (
        "creep",
        (LOOP,),
        (
            LOOP,
            block(
                "logarithmic-creep",
                magnitude=0.3,
                first_time_s=2e-3,
                last_time_s=10.0,
            ),
        ),
    ),
    "fractional": (
        "creep",
        (LOOP,),
        (
            LOOP,
            block(
                "logarithmic-creep",
                magnitude=0.4,
                first_time_s=2e-3,
                last_time_s=10.0,
                power=0.4,
            ),
        ),
    ),
    "plays": ("hysteresis", (GAIN,), (PLAYS, GAIN)),
    "Bouc-Wen": (
        "hysteresis",
        (GAIN,),
        (block("bouc-wen", weight=0.2, yield_distance=0.3, sharing=0.4), GAIN),
    ),
    "acting-field, 0.5": (
        "rate-dependent-hysteresis",
        (LOOP,),
        (
            LOOP,
            block(
                "rate-dependent-hysteresis",
                coefficient=4e-3,
                exponent=0.5,
                form="acting-field",
            ),
        ),
    ),
}


@pytest.mark.parametrize("form", HIDDEN)
def test_a_law_is_found_under_its_name(form):
    name, base, chain = HIDDEN[form]
    state = state_of(base, measured(chain, NOISE, given=records()))
    score = make_score(state, FLOOR)
    known = [effects()[item] for item in (name, SHAPE, "backlash", "sensor-lag")]
    ranking = rank(state, score, known, folds=False)
    first = ranking[0]
    told = [f"{item.effect} {item.form} {item.gain:.0f}" for item in ranking]
    # Generalized plays may bend to plain ones of other thresholds than those offered.
    holds = {"plays": {"plays", "generalized plays"}}.get(form, {form})
    assert first.effect == name, told
    assert first.form in holds, told
    assert first.gain > PAYS, told
    gap = state.power(NOISE**2)
    assert first.state.share(state, NOISE**2, gap) > 0.95, told


def test_friction_that_bends_late_is_found_with_its_scale():
    """As of a seal: at three fifths of the fastest velocity of the records."""
    gain = block("gain", value=12.0)
    fastest = state_of((gain,), records()).simulation.fastest()
    late = block("friction", coulomb=3.0, velocity_scale=0.6 * fastest)
    state = state_of((gain,), measured((gain, late), NOISE, given=records()))
    known = [effects()[item] for item in ("friction", "drive-lag")]
    first = rank(state, make_score(state, FLOOR), known, folds=False)[0]
    assert (first.effect, first.declined) == ("friction", "")
    (found,) = [x for x in first.state.chain if x.name == "friction"]
    assert found.velocity_scale == pytest.approx(0.6 * fastest, rel=0.1)
    assert found.coulomb == pytest.approx(3.0, rel=0.1)


def test_thresholds_that_grow_with_a_logarithm_are_found_along_straight_lines():
    """Eyring's law: of triangles at rates of one to a hundred, with its numbers."""
    t = np.arange(1200) / 1000
    given = tuple(
        record(0.8 * sawtooth(2 * np.pi * pace * t + np.pi / 2, 0.5), name=f"{pace}")
        for pace in (0.9, 6.3, 80.0)
    )
    law = block(
        "rate-dependent-hysteresis",
        coefficient=0.1,
        exponent=1.0,
        knee=3.0,
        hold="linear",
    )
    noise = np.random.default_rng(3).standard_normal((3, 1200)) * NOISE
    outputs = Simulation((LOOP, law), given, "linear").output
    told = tuple(
        replace(one, y=y + rest)
        for one, y, rest in zip(given, outputs, noise, strict=True)
    )
    state = state_of((LOOP,), told, hold="linear")
    score = make_score(state, FLOOR)
    known = [effects()[item] for item in ("rate-dependent-hysteresis", "sensor-lag")]
    first = rank(state, score, known, folds=False)[0]
    assert first.effect == "rate-dependent-hysteresis"
    found = finished(first.state, score)[0]
    assert found.chain[1].knee == pytest.approx(3.0, rel=0.2)
    assert found.chain[1].coefficient == pytest.approx(0.1, rel=0.2)
    gap = state.power(NOISE**2)
    assert found.share(state, NOISE**2, gap) > 0.99

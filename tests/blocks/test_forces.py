"""Forces inside a mechanism: their laws, their memory, and that they only dissipate."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hystbench import kernels
from hystbench.blocks import registry
from hystbench.blocks.force import LAWS as LAW_NAMES
from hystbench.blocks.friction_force import FrictionForce
from hystbench.blocks.mechanism import Mechanism
from hystbench.errors import InputError
from hystbench.model import Model
from hystbench.record import Channel

from .bare import BARE, against, along

DT = 1e-3


def force(name, **values):
    return registry()[name].from_mapping(values)


def motion(count=4001, seed=1):
    """Give a closed motion of three sines, fast at some places and slow at others."""
    random = np.random.default_rng(seed)
    turn = 2 * np.pi * np.arange(count) / (count - 1)
    sizes, phases = random.uniform(0.2, 1.0, 3), random.uniform(0, 6, 3)
    each = sizes[:, None] * np.sin(np.outer([1, 2, 5], turn) + phases[:, None])
    return each.sum(axis=0)


LAWS = {
    "stiffness": (
        {"quadratic": 3.0, "cubic": -2.0},
        lambda q, v: 3 * q**2 - 2 * q**3,
    ),
    "exponential-stiffness": (
        {"coefficient": 4.0, "reach": 0.5},
        lambda q, v: 4 * (0.5 * np.sinh(q / 0.5) - q),
    ),
    "saturating-stiffness": (
        {"stiffness": 4.0, "reach": 0.5},
        lambda q, v: 4 * q / np.sqrt(1 + (q / 0.5) ** 2),
    ),
    "transverse-springs": (
        {"stiffness": 4.0, "reach": 0.5},
        lambda q, v: 4 * q * (1 - 0.5 / np.hypot(0.5, q)),
    ),
    "stop": (
        {"contact_stiffness": 7.0, "gap": 0.4, "centre": 0.1},
        lambda q, v: np.select(
            [q > 0.5, q < -0.3], [7 * (q - 0.5), 7 * (q + 0.3)], 0.0
        ),
    ),
    "stop above": (
        {"contact_stiffness": 7.0, "gap": 0.4, "sides": "upper"},
        lambda q, v: np.where(q > 0.4, 7 * (q - 0.4), 0.0),
    ),
    "stop below": (
        {"contact_stiffness": 7.0, "gap": 0.0, "centre": 0.2, "sides": "lower"},
        lambda q, v: np.where(q < 0.2, 7 * (q - 0.2), 0.0),
    ),
    "stop with loss": (
        {"contact_stiffness": 7.0, "gap": 0.4, "loss": 0.2},
        lambda q, v: (
            7
            * np.sign(q)
            * np.maximum(np.abs(q) - 0.4, 0)
            * np.maximum(1 + 0.2 * np.sign(q) * v, 0)
        ),
    ),
    "stop of round bodies": (
        {"contact_stiffness": 7.0, "gap": 0.4, "exponent": 1.5},
        lambda q, v: 7 * np.sign(q) * np.maximum(np.abs(q) - 0.4, 0) ** 1.5,
    ),
    "drag": ({"coefficient": 0.3}, lambda q, v: 0.3 * v * np.abs(v)),
    "velocity-limit": (
        {"rate": 0.4, "damping": 3.0},
        lambda q, v: 3 * np.sign(v) * np.maximum(np.abs(v) - 0.4, 0),
    ),
    "smooth-friction": (
        {
            "coulomb": 2.0,
            "velocity_scale": 0.5,
            "static_excess": 1.5,
            "stribeck_velocity": 1.2,
        },
        lambda q, v: (2 + 1.5 * np.exp(-((v / 1.2) ** 2))) * np.tanh(v / 0.5),
    ),
    "gravity": (
        {"amplitude": 2.0, "angle": 0.4},
        lambda q, v: 2 * (np.sin(q + 0.4) - np.sin(0.4)),
    ),
    "gravity over degrees": (
        {"amplitude": 2.0, "angle": 0.4, "unit": "deg"},
        lambda q, v: 2 * (np.sin(np.radians(q) + 0.4) - np.sin(0.4)),
    ),
    "gravity that was linearized before": (
        {"amplitude": 2.0, "angle": 0.4, "straight": 1.0},
        lambda q, v: 2 * (np.sin(q + 0.4) - np.sin(0.4) - q * np.cos(0.4)),
    ),
    "gravity linearized over degrees": (
        {"amplitude": 2.0, "straight": 1.0, "unit": "deg"},
        lambda q, v: 2 * (np.sin(np.radians(q)) - np.radians(q)),
    ),
    "gravity from a slack spring": (
        {"amplitude": 2.0, "angle": 0.4, "carried": 0.0},
        lambda q, v: 2 * np.sin(q + 0.4),
    ),
}


@pytest.mark.parametrize("name", LAWS)
def test_a_force_without_memory_is_its_formula(name):
    values, law = LAWS[name]
    q = motion()
    found = against(force(name.split()[0], **values), q)
    # The motion is closed: the derivative of its Fourier series is its velocity.
    waves = 2j * np.pi * np.fft.rfftfreq(len(q) - 1, DT)
    v = np.fft.irfft(waves * np.fft.rfft(q[:-1]))
    wanted = law(q, np.append(v, v[0]))
    off = np.abs(found - wanted)[2:-2].max()  # samples lack at the ends, for a rate
    assert off < 1e-8 * np.ptp(wanted)


def test_friction_gives_way_and_slides():
    block = force("friction-force", coulomb=2.0, presliding_distance=0.5)
    q = [0.0, 0.25, 0.5, 3.0, 2.75, 2.5, 2.0, -4.0, -3.9]
    assert against(block, q) == pytest.approx([0, 1, 2, 2, 1, 0, -2, -2, -1.6])


def test_sliding_friction_falls_with_the_velocity():
    block = force(
        "friction-force",
        coulomb=2.0,
        presliding_distance=1e-6,
        static_excess=1.0,
        stribeck_velocity=0.3,
    )
    for velocity in (0.01, 0.3, -2.0):
        q = velocity * DT * np.arange(9)
        wanted = np.sign(velocity) * (2 + np.exp(-((velocity / 0.3) ** 2)))
        assert against(block, q)[1:] == pytest.approx(np.full(8, wanted))


def test_without_a_stribeck_velocity_there_is_no_excess():
    block = force(
        "friction-force", coulomb=2.0, presliding_distance=0.5, static_excess=1.0
    )
    assert against(block, [0.0, 0.25, 3.0]) == pytest.approx([0, 1, 2])
    own = {"coulomb": 2.0, "velocity_scale": 0.1}
    plain, same = (
        against(force("smooth-friction", **own, static_excess=excess), motion())
        for excess in (0.0, 1.0)
    )
    np.testing.assert_array_equal(same, plain)


BRISTLES = {"coulomb": 2.0, "presliding_distance": 0.3}


def test_bristles_that_slide_alike_at_every_velocity_are_dahls():
    dahl = force("hysteretic-force", largest=2.0, yield_distance=0.3, sharing=0.0)
    found = against(force("lugre-force", **BRISTLES), motion())
    np.testing.assert_allclose(found, against(dahl, motion()), atol=1e-12)


def test_bristles_bend_as_lugres_equation_says():
    """Also from above, where the force of sliding falls faster than they give way."""
    excess = {"static_excess": 1.5, "stribeck_velocity": 2.0}
    t = np.linspace(0, 1, 4001)

    def place(t):
        return np.sin(9 * t) + 0.3 * np.sin(31 * t)

    def bends(t, z):
        v = 9 * np.cos(9 * t) + 9.3 * np.cos(31 * t)
        slides = 2 + 1.5 * np.exp(-((v / 2) ** 2))
        return v - abs(v) * z * (3.5 / 0.3) / slides

    z = solve_ivp(bends, (0, 1), [0.0], t_eval=t, rtol=1e-9, max_step=1e-3).y[0]
    found = against(force("lugre-force", **BRISTLES, **excess), place(t), t[1])
    wanted = z * 3.5 / 0.3
    assert np.abs(found - wanted).max() < 1e-3 * np.ptp(wanted)


def test_a_slider_behind_a_gap_lets_go_is_free_climbs_and_slides():
    block = force("slider-with-gap", contact_stiffness=10.0, slip_force=2.0, gap=0.3)
    up, down = np.linspace(0, 2, 401), np.linspace(2, -1, 601)
    found = against(block, np.concatenate([up, down]))
    # From rest: the gap, 0.2 of climbing to the slip force, sliding.
    np.testing.assert_allclose(
        found[:401], np.interp(up, [0, 0.3, 0.5, 2], [0, 0, 2, 2]), atol=1e-12
    )
    # Back: 0.2 until it lets go, both halves of the gap, 0.2 of climbing, sliding.
    way = 2 - down
    places, forces = [0, 0.2, 0.8, 1.0, 3.0], [2, 0, 0, -2, -2]
    np.testing.assert_allclose(found[401:], np.interp(way, places, forces), atol=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
@pytest.mark.parametrize("sharing", [0.0, 0.3, 0.5, 0.8, 1.0])
def test_bouc_and_wen_are_the_solution_of_their_equation(sharing, exponent):
    largest, reach = 3.0, 0.2
    turns = [0.0, 0.5, 0.3, 0.45, -0.6, -0.5, -0.55, 0.02]

    def slope(q, z, direction):
        share = sharing + (1 - sharing) * np.sign(z * direction)
        return (1 - np.abs(z) ** exponent * share) / reach

    way, wanted = along(slope, turns)
    block = force(
        "hysteretic-force",
        largest=largest,
        yield_distance=reach,
        sharing=sharing,
        exponent=exponent,
    )
    found = against(block, way)
    np.testing.assert_allclose(found, largest * wanted, atol=1e-6)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
@pytest.mark.parametrize("sharing", [0.2, 0.5, 0.7])
def test_the_step_of_bouc_and_wen_does_not_matter(sharing, exponent):
    # Exact over a monotone piece: in one step or in many.
    block = force(
        "hysteretic-force",
        largest=1.0,
        yield_distance=0.1,
        sharing=sharing,
        exponent=exponent,
    )
    fine = np.concatenate([np.linspace(0, 0.3, 301), np.linspace(0.3, -0.2, 501)[1:]])
    many, few = against(block, fine), against(block, fine[[0, 300, 800]])
    np.testing.assert_allclose(few, many[[0, 300, 800]], atol=1e-12)


PASSIVE = {
    **{name: (name.split()[0], values) for name, (values, _) in LAWS.items()},
    "friction": ("friction-force", {"coulomb": 1.0, "presliding_distance": 0.3}),
    "friction that rises at rest": (
        "friction-force",
        {
            "coulomb": 0.2,
            "presliding_distance": 3.0,
            "static_excess": 1.0,
            "stribeck_velocity": 0.5,
        },
    ),
    "bristles that slide easier when fast": (
        "lugre-force",
        {
            "coulomb": 0.2,
            "presliding_distance": 0.3,
            "static_excess": 1.0,
            "stribeck_velocity": 0.5,
        },
    ),
    "slider": (
        "slider-with-gap",
        {"contact_stiffness": 3.0, "slip_force": 0.5, "gap": 0.2},
    ),
    **{
        f"Bouc-Wen {sharing} {exponent}": (
            "hysteretic-force",
            {
                "largest": 1.0,
                "yield_distance": 0.4,
                "sharing": sharing,
                "exponent": exponent,
            },
        )
        for sharing in (0.0, 0.3, 0.5, 0.8, 1.0)
        for exponent in (1.0, 2.0)
    },
}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", PASSIVE)
def test_a_closed_motion_never_gets_work_out_of_a_force(name, seed):
    kind, values = PASSIVE[name]
    lap = motion(seed=seed)
    q = np.concatenate([lap, lap[1:]])
    f = against(force(kind, **values), q)
    # The second lap begins and ends in the same state.
    second = slice(len(lap) - 1, None)
    work = np.trapezoid(f[second], q[second])
    assert work >= -1e-4 * np.ptp(f) * np.ptp(q)


def chained(*blocks):
    return Model(
        "any",
        Channel("force", "N"),
        Channel("position", "m"),
        tuple(registry()[name].from_mapping(values) for name, values in blocks),
    )


@pytest.mark.parametrize(
    ("chain", "place", "before"),
    [
        ([("drag", {"coefficient": 1.0})], 1, "none"),
        ([("gain", {"value": 1.0}), ("drag", {"coefficient": 1.0})], 2, "gain"),
    ],
)
def test_a_force_without_a_mechanism_is_refused_in_one_line(chain, place, before):
    with pytest.raises(InputError) as told:
        chained(*chain)
    assert str(told.value) == (
        f"chain: block {place} (drag): expected mechanism, impedance or structure just "
        f"before it, or another force inside one, got {before}"
    )


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("drag", {"coefficient": -1.0}, "coefficient: -1 is out of bounds"),
        (
            "friction-force",
            {"coulomb": 1.0, "presliding_distance": 0.0},
            "presliding_distance: 0 is out of bounds",
        ),
        (
            "hysteretic-force",
            {"largest": 1.0, "yield_distance": 1.0, "sharing": 1.1},
            "sharing: 1.1 is out of bounds",
        ),
        (
            "stop",
            {"contact_stiffness": 1.0, "gap": 1.0, "sides": "uper"},
            "sides: 'uper' is unknown.*upper",
        ),
    ],
)
def test_a_parameter_out_of_bounds_is_refused_in_one_line(name, values, told):
    with pytest.raises(InputError, match=told) as caught:
        force(name, **values)
    assert "\n" not in str(caught.value)


def test_dry_friction_turns_with_the_motion_within_a_step():
    # Between turns a mass on a spring moves on a cosine about F / k or -F / k; each
    # half swing ends 2 F / k nearer. Twenty-five samples a period.
    friction, period, step, count = 0.2, 1.0, 0.043, 75
    stiffness = (2 * np.pi / period) ** 2
    t = np.arange(count) * step
    swing = np.floor(2 * t / period)
    about = np.where(swing % 2 == 0, 1.0, -1.0) * friction / stiffness
    reach = 1.0 - 2 * friction / stiffness * swing - friction / stiffness
    exact = about + reach * np.cos(2 * np.pi * t / period)
    host = Mechanism(
        mass=1.0, damping=0.0, stiffness=stiffness, start_position=1.0, hold="linear"
    )
    force = FrictionForce(coulomb=friction, presliding_distance=1e-9)
    moved = host.driven(np.zeros(count), step, (force,))
    assert np.abs(moved - exact).max() < 3e-4


def test_the_friction_of_a_band_limited_motion_is_sampled_without_aliasing():
    """Its jumps lie between samples: what is recorded is below half the rate."""
    fine, n = 64, 400
    t = np.arange((n - 1) * fine + 1) / fine
    q = np.sin(2 * np.pi * t / 33.3)
    jumps = np.sign(np.cos(2 * np.pi * t / 33.3))
    # An ideal low-pass filter leaves the harmonics of the square wave below its edge.
    harmonics = np.arange(1, 17, 2)
    shares = 4 / np.pi * (-1.0) ** ((harmonics - 1) // 2) / harmonics
    wanted = shares @ np.cos(2 * np.pi * np.outer(harmonics, t[::fine] / 33.3))
    friction = force("friction-force", coulomb=1.0, presliding_distance=1e-6)
    off = {
        hold: friction.attach(replace(BARE, hold=hold)).simulate(q[::fine], None, 1.0)
        for hold in ("linear", "band-limited")
    }
    part = slice(40, -40)  # at its ends a record is continued as if turned about them
    aliased, right = (np.std((off[hold] - wanted)[part]) for hold in off)
    assert np.std((jumps[::fine] - wanted)[part]) > 0.15
    assert aliased > 0.15
    assert right < 0.05


def test_the_kernel_has_the_same_numbers_of_laws():
    source = Path(kernels.__file__).with_name("forces.c").read_text(encoding="utf-8")
    listed = re.search(r"^enum \{ /\*[^*]*\*/([^}]*)\};", source, re.M)[1]
    names = [name.strip() for name in listed.split(",")]
    assert names == [f"HB_{law.upper()}" for law in LAW_NAMES]

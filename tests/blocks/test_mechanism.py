"""A mechanism against integrators that control their error, and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hystbench.blocks import registry
from hystbench.blocks.force import Driven
from hystbench.blocks.impedance import Impedance
from hystbench.blocks.mechanism import OUTPUTS, Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError

#: Turns at 10 rad/s: an interval of 0.02 s is the longest that is one step.
MACHINE = Mechanism(mass=2.0, damping=1.5, stiffness=200.0)
FREE = replace(MACHINE, damping=0.0)


def force(name, **values):
    return registry()[name].from_mapping(values)


def drive(t):
    return 120 * np.sin(9 * t) + 60 * np.sin(23 * t)


def run(block, forces, z, dt):
    """Run the block with forces inside, as a model does."""
    step = block
    for item in forces:
        step = item.attach(step)
    return step.simulate(np.asarray(z, dtype=float), None, dt)


def solved(law, t, given=drive, machine=MACHINE, start=(0.0, 0.0)):
    """Integrate the motion by an integrator that controls its error."""

    def moves(at, state):
        q, v = state
        spring = machine.damping * v + machine.stiffness * q + law(q, v)
        return [v, (given(at) - spring) / machine.mass]

    ends = (t[0], t[-1])
    found = solve_ivp(
        moves, ends, start, t_eval=t, method="DOP853", rtol=1e-11, atol=1e-13
    )
    return found.y


SMOOTH = {
    "linear": ([], lambda q, v: 0.0),
    "cubic": ([force("stiffness", quadratic=50.0, cubic=300.0)],
              lambda q, v: 50 * q**2 + 300 * q**3),
    "steep": ([force("exponential-stiffness", coefficient=80.0, reach=0.3)],
              lambda q, v: 80 * (0.3 * np.sinh(q / 0.3) - q)),
    "level": ([force("saturating-stiffness", stiffness=80.0, reach=0.3)],
              lambda q, v: 80 * q / np.sqrt(1 + (q / 0.3) ** 2)),
    "across": ([force("transverse-springs", stiffness=80.0, reach=0.3)],
               lambda q, v: 80 * q * (1 - 0.3 / np.hypot(0.3, q))),
    "drag": ([force("drag", coefficient=0.8)], lambda q, v: 0.8 * v * abs(v)),
    "pendulum": ([force("gravity", amplitude=150.0, angle=0.5)],
                 lambda q, v: 150 * (np.sin(q + 0.5) - np.sin(0.5))),
    "two": ([force("stiffness", quadratic=0.0, cubic=300.0),
             force("drag", coefficient=0.8)],
            lambda q, v: 300 * q**3 + 0.8 * v * abs(v)),
}  # fmt: skip


@pytest.mark.parametrize("output", ["position", "velocity"])
@pytest.mark.parametrize("name", SMOOTH)
def test_half_the_step_makes_a_quarter_of_the_error(name, output):
    forces, law = SMOOTH[name]
    errors = []
    for count in (800, 1600, 3200):
        t = np.linspace(0, 2, count + 1)
        wanted = solved(law, t)[OUTPUTS.index(output)]
        found = run(replace(MACHINE, output=output), forces, drive(t), t[1])
        errors.append(np.abs(found - wanted).max() / np.ptp(wanted))
    assert errors[-1] < 2e-3
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (ratios > 3.3).all()
    assert (ratios < 4.7).all()


@pytest.mark.parametrize("output", OUTPUTS)
def test_a_weight_that_swings_little_is_as_exact_as_a_spring(output):
    t = np.linspace(0, 2, 101)
    little = 1e-6 * drive(t)
    weight = force("gravity", amplitude=150.0)
    found = run(replace(MACHINE, stiffness=50.0, output=output), [weight], little, t[1])
    spring = run(replace(MACHINE, output=output), [], little, t[1])
    assert found == pytest.approx(spring, abs=1e-9 * np.ptp(spring))


def contact(q, v):
    return 500 * np.sign(q) * np.maximum(np.abs(q) - 0.1, 0)


def lossy_contact(q, v):
    return contact(q, v) * np.maximum(1 + 0.2 * np.sign(q) * v, 0)


def gives_way(t):
    """Friction of 20 over a way of .05, as a third state that slides at its ends."""

    def moves(at, state):
        q, v, held = state
        slides = abs(held) >= 20 and held * v > 0
        spring = MACHINE.damping * v + MACHINE.stiffness * q + np.clip(held, -20, 20)
        return [v, (drive(at) - spring) / MACHINE.mass, 0.0 if slides else 400 * v]

    exact = {"rtol": 1e-9, "atol": 1e-11, "max_step": 2e-3}
    return solve_ivp(
        moves, (t[0], t[-1]), (0, 0, 0), t_eval=t, method="DOP853", **exact
    ).y[0]


CORNERED = {
    "stop": (force("stop", contact_stiffness=500.0, gap=0.1),
             lambda t: solved(contact, t)[0]),
    "lossy stop": (force("stop", contact_stiffness=500.0, gap=0.1, loss=0.2),
                   lambda t: solved(lossy_contact, t)[0]),
    "friction": (force("friction-force", coulomb=20.0, presliding_distance=0.05),
                 gives_way),
}  # fmt: skip


@pytest.mark.parametrize("name", CORNERED)
def test_corners_of_a_force_leave_the_order_as_it_is(name):
    law, exactly = CORNERED[name]
    errors = []
    for count in (800, 1600, 3200):
        t = np.linspace(0, 2, count + 1)
        wanted = exactly(t)
        found = run(MACHINE, [law], drive(t), t[1])
        errors.append(np.abs(found - wanted).max() / np.ptp(wanted))
    assert errors[-1] < 1e-3
    ratios = np.array(errors[:-1]) / errors[1:]
    assert ratios == pytest.approx([4, 4], abs=0.5)


def test_a_damper_beyond_a_velocity_follows_a_fine_solution():
    # Where in a step the corner lies changes with the step: the order holds on average.
    def beyond(q, v):
        return 20 * np.sign(v) * np.maximum(np.abs(v) - 0.5, 0)

    limit, errors = force("velocity-limit", rate=0.5, damping=20.0), []
    for count in (800, 1600, 3200):
        t = np.linspace(0, 2, count + 1)
        wanted = solved(beyond, t)[0]
        found = run(MACHINE, [limit], drive(t), t[1])
        errors.append(np.abs(found - wanted).max() / np.ptp(wanted))
    assert errors[-1] < 1e-3
    assert errors[0] / errors[-1] > 12  # about 16: of second order


@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
def test_without_a_force_it_is_the_transfer_function(hold):
    # Both are exact for staircases and straight lines. A smooth input is taken as lines
    # twice as fine: at 1/30 of the sampling rate they have 0.1 % of its amplitude.
    t = np.arange(500) * 0.01
    linear = TransferFunction(numerator=[1.0], denominator=[2.0, 1.5, 200.0], hold=hold)
    wanted = linear.simulate(drive(t), t, 0.01)
    found = run(replace(MACHINE, hold=hold), [], drive(t), 0.01)
    share = 1e-3 if hold == "band-limited" else 1e-11
    np.testing.assert_allclose(found, wanted, rtol=0, atol=share * np.ptp(wanted))


def test_a_band_limited_input_is_smooth_between_its_samples():
    """Whole periods: the curve through the record's samples is the sines."""
    forces = [force("stiffness", quadratic=0.0, cubic=10.0)]
    fine, every = np.linspace(0, 2 * np.pi, 4801), 32
    wanted = solved(lambda q, v: 10 * q**3, fine)[0][::every]
    t = fine[::every]
    off = {
        hold: np.abs(run(replace(MACHINE, hold=hold), forces, drive(t), t[1]) - wanted)
        for hold in ("linear", "band-limited")
    }
    assert off["band-limited"].max() < 5e-3 * np.ptp(wanted)
    assert off["linear"].max() > 5 * off["band-limited"].max()


def test_dry_friction_stops_a_free_motion_as_coulomb_says():
    # Each half turn takes 2 c / k off the amplitude: 1, -0.8, 0.6, ..., until the
    # spring holds less than the friction does. It gives way a million times stiffer
    # than the spring.
    friction = force("friction-force", coulomb=20.0, presliding_distance=1e-7)
    half = np.pi / np.sqrt(200.0 / 2.0)
    for steps in (40, 400):
        machine = replace(FREE, start_position=0.95)
        q = run(machine, [friction], np.zeros(7 * steps + 1), half / steps)
        turns = q[::steps][:6]
        wanted = [0.95, -0.75, 0.55, -0.35, 0.15, 0.05]
        np.testing.assert_allclose(turns, wanted, atol=2.0 / steps**2 + 1e-6)
        # There it holds, as 200 * 0.05 is less than the friction.
        np.testing.assert_allclose(q[5 * steps :], 0.05, atol=2.0 / steps**2 + 1e-6)


POTENTIALS = {
    "springs": ("stiffness", {"quadratic": 40.0, "cubic": 300.0},
                lambda q: 40 * q**3 / 3 + 75 * q**4),
    "steep spring": ("exponential-stiffness", {"coefficient": 80.0, "reach": 0.1},
                     lambda q: 80 * (0.01 * (np.cosh(q / 0.1) - 1) - q**2 / 2)),
    "spring that levels off": (
        "saturating-stiffness", {"stiffness": 80.0, "reach": 0.1},
        lambda q: 80 * 0.01 * (np.sqrt(1 + (q / 0.1) ** 2) - 1)),
    "springs across": (
        "transverse-springs", {"stiffness": 80.0, "reach": 0.1},
        lambda q: 80 * (q**2 / 2 - 0.1 * (np.hypot(0.1, q) - 0.1))),
    "weight": ("gravity", {"amplitude": 150.0, "angle": 0.5},
               lambda q: 150 * (np.cos(0.5) - np.cos(q + 0.5) - np.sin(0.5) * q)),
    "weight beyond its line": (
        "gravity", {"amplitude": 150.0, "angle": 0.5, "straight": 1.0},
        lambda q: 150 * (np.cos(0.5) - np.cos(q + 0.5) - np.sin(0.5) * q
                         - np.cos(0.5) * q**2 / 2)),
    "contact": ("stop", {"contact_stiffness": 2e3, "gap": 0.3, "centre": 0.1},
                lambda q: 1e3 * np.maximum(np.abs(q - 0.1) - 0.3, 0) ** 2),
    "hard contact": ("stop", {"contact_stiffness": 2e8, "gap": 0.3},
                     lambda q: 1e8 * np.maximum(np.abs(q) - 0.3, 0) ** 2),
    "hard contact above":
        ("stop", {"contact_stiffness": 2e8, "gap": 0.3, "sides": "upper"},
         lambda q: 1e8 * np.maximum(q - 0.3, 0) ** 2),
}  # fmt: skip


@pytest.mark.parametrize("damping", [0.0, 0.7])
@pytest.mark.parametrize("name", POTENTIALS)
def test_an_elastic_force_neither_gives_nor_takes_energy(name, damping):
    """Ten steps a turn, and contact times of less than a thousandth of one."""
    kind, values, potential = POTENTIALS[name]
    machine = replace(MACHINE, damping=damping, start_position=0.29, start_velocity=3.0)
    moved = machine.motion(np.zeros(4001), 0.06, (force(kind, **values),))
    q, v = moved.position, moved.velocity
    energy = v**2 + 100 * q**2 + potential(q)
    if damping:
        assert (np.diff(energy) <= 1e-9 * energy[0]).all()
        assert energy[-1] < 1e-9 * energy[0]
    else:
        np.testing.assert_allclose(energy, energy[0], rtol=1e-8)


@pytest.mark.parametrize("stiffness", [2e3, 2e8])
@pytest.mark.parametrize("loss", [0.1, 3.0])
def test_a_lossy_contact_only_loses_energy(stiffness, loss):
    machine = replace(MACHINE, damping=0.0, start_position=0.29, start_velocity=3.0)
    stop = force("stop", contact_stiffness=stiffness, gap=0.3, loss=loss)
    moved = machine.motion(np.zeros(4001), 0.06, (stop,))
    q, v = moved.position, moved.velocity
    energy = v**2 + 100 * q**2 + stiffness / 2 * np.maximum(np.abs(q) - 0.3, 0) ** 2
    assert (np.diff(energy) <= 1e-9 * energy[0]).all()
    assert energy[-1] < 1.02 * 100 * 0.3**2  # it swings inside the clearance


#: What each force can store at most.
DISSIPATIVE = {
    "drag": ("drag", {"coefficient": 2.0}, 0.0),
    "hard limit": ("velocity-limit", {"rate": 0.2, "damping": 2e4}, 0.0),
    "friction": (
        "friction-force", {"coulomb": 4.0, "presliding_distance": 0.02}, 0.04
    ),
    "stiff friction": (
        "friction-force", {"coulomb": 4.0, "presliding_distance": 2e-8}, 4e-8
    ),
    "friction that rises at rest": (
        "friction-force",
        {"coulomb": 2.0, "presliding_distance": 0.02, "static_excess": 2.0,
         "stribeck_velocity": 0.3},
        0.04,
    ),
    "bristles": (
        "lugre-force",
        {"coulomb": 2.0, "presliding_distance": 0.02, "static_excess": 2.0,
         "stribeck_velocity": 0.3},
        0.04,
    ),
    "slider": (
        "slider-with-gap",
        {"contact_stiffness": 2e8, "slip_force": 4.0, "gap": 0.05},
        4e-8,
    ),
    # Loaded to one, and unloaded without loss: 1 / 2 of largest times the distance
    # with a sharing of a half; more with more, less with less.
    "Bouc-Wen": (
        "hysteretic-force",
        {"largest": 4.0, "yield_distance": 0.02, "sharing": 0.5},
        0.04,
    ),
    "Bouc-Wen of exponent two": (
        "hysteretic-force",
        {"largest": 4.0, "yield_distance": 0.02, "sharing": 0.5, "exponent": 2.0},
        0.04,
    ),
    "Dahl": (
        "hysteretic-force",
        {"largest": 4.0, "yield_distance": 0.02, "sharing": 0.0},
        0.04,
    ),
}  # fmt: skip


@pytest.mark.parametrize("dt", [0.02, 0.005])
@pytest.mark.parametrize("name", DISSIPATIVE)
def test_a_free_motion_only_loses_energy(name, dt):
    kind, values, stored = DISSIPATIVE[name]
    machine = replace(FREE, start_position=1.0)
    moved = machine.motion(np.zeros(int(40 / dt)), dt, (force(kind, **values),))
    energy = moved.velocity**2 + 100 * moved.position**2
    least = np.minimum.accumulate(energy)
    assert (energy - least).max() <= stored * (1 + 1e-6) + 1e-9 * energy[0]
    # Drag fades with the motion; dry friction ends it.
    assert energy[-1] < (0.05 if kind == "drag" else 0.02) * energy[0]


def test_stribeck_friction_makes_a_slow_drive_stick_and_slip():
    """A spring that is drawn slowly: the static force, a slip, and again."""
    friction = force(
        "friction-force",
        coulomb=10.0,
        presliding_distance=1e-5,
        static_excess=10.0,
        stribeck_velocity=0.05,
    )
    t = np.arange(6000) * 1e-3
    v = run(replace(MACHINE, output="velocity"), [friction], 200 * 0.1 * t, 1e-3)
    # The spring reaches the static force of 20 at one second.
    assert np.abs(v[:990]).max() < 1e-3
    assert v[1000:1300].max() > 0.15  # faster than the draw of 0.1
    slips = np.flatnonzero(np.diff((v > 0.05).astype(int)) == 1)
    assert len(slips) >= 2


#: A static force of 0.4 N that fades to 0.1 N with the velocity.
STRIBECK = {"coulomb": 0.1, "static_excess": 0.3, "stribeck_velocity": 3e-3}
SLIDER = Mechanism(mass=0.1, damping=1.0, stiffness=0.0)


def held_then_loose(given, t):
    """Integrate a mass that sticks on a spring of 400 N/m, then slides.

    It breaks loose where the spring reaches the force of sliding at its velocity; from
    there on it must not turn back. Gives the way, and when it broke loose, if it did.
    """

    def sliding(v):
        return 0.1 + 0.3 * np.exp(-((v / 3e-3) ** 2))

    def stuck(at, state):
        q, v = state
        return [v, (given(at) - v - 400 * q) / 0.1]

    def slides(at, state):
        v = state[1]
        return [v, (given(at) - v - sliding(v)) / 0.1]

    def holds(at, state):
        return sliding(state[1]) - 400 * abs(state[0])

    holds.terminal = True
    settings = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-13, "max_step": 0.01}
    ends = t[0], t[-1]
    held = solve_ivp(
        stuck, ends, (0.0, 0.0), events=holds, dense_output=True, **settings
    )
    if held.status == 0:
        return held.sol(t)[0], None
    begin = held.t[-1]
    later = t[t > begin]
    loose = solve_ivp(slides, (begin, t[-1]), held.y[:, -1], t_eval=later, **settings)
    assert loose.y[1].min() > 0
    return np.append(held.sol(t[t <= begin])[0], loose.y[0]), begin


@pytest.mark.parametrize(
    ("most", "ramp_s", "dt", "off"),
    [
        # Below the static force it stays: a step in which it slides off would fulfil
        # the equations of a step as well, as the force falls with the velocity.
        (0.3, 2.0, 1e-2, 0.01),
        # Beyond it slides; in long steps it breaks loose a little early.
        (0.6, 1.0, 1e-2, 0.15),
        (0.6, 1.0, 1e-3, 0.001),
    ],
)
def test_friction_that_falls_with_the_velocity_holds_up_to_the_static_force(
    most, ramp_s, dt, off
):
    def ramp(t):
        return most * np.minimum(t / ramp_s, 1.0)

    friction = force("friction-force", presliding_distance=1e-3, **STRIBECK)
    t = np.arange(round(1.5 * ramp_s / dt) + 1) * dt
    wanted, loose = held_then_loose(ramp, t)
    assert (loose is None) == (most < 0.4)
    found = run(SLIDER, [friction], ramp(t), dt)
    assert np.abs(found - wanted).max() < off * np.ptp(wanted)
    if loose is None:
        assert found[-1] == pytest.approx(0.3 / 400, rel=off)
    else:
        assert found[-1] > 100 * 1e-3


def test_outputs_agree_with_each_other():
    forces, _ = SMOOTH["two"]
    t = np.arange(4000) * 5e-4
    y = {
        output: run(replace(MACHINE, output=output), forces, drive(t), 5e-4)
        for output in OUTPUTS
    }
    for slow, fast in (("position", "velocity"), ("velocity", "acceleration")):
        central = (y[slow][2:] - y[slow][:-2]) / 1e-3
        off = np.abs(central - y[fast][1:-1]).max()
        assert off < 1e-3 * np.ptp(y[fast])
    newton = 2.0 * y["acceleration"] + y["force"]
    np.testing.assert_allclose(newton, drive(t), atol=1e-9)


@pytest.mark.parametrize(
    ("output", "other"),
    [
        ("position", "velocity"),
        ("velocity", "acceleration"),
        ("acceleration", "velocity"),
        ("force", "velocity"),
    ],
)
def test_a_blend_is_a_share_of_another_output(output, other):
    forces, _ = SMOOTH["cubic"]
    z = drive(np.arange(300) * 0.01)

    def of(output, blend=0.0):
        return run(replace(MACHINE, output=output, blend=blend), forces, z, 0.01)

    np.testing.assert_allclose(
        of(output, 0.3), of(output) + 0.3 * of(other), rtol=1e-12, atol=1e-12
    )


def test_an_impedance_takes_the_motion_that_a_mechanism_makes():
    """The force on the mount and the mass's, found again from the motion alone."""
    forces, _ = SMOOTH["two"]
    t = np.arange(4001) * 5e-4
    back = Impedance(mass=2.0, damping=1.5, stiffness=200.0)
    for given in ("position", "velocity"):
        moved = run(replace(MACHINE, output=given), forces, drive(t), 5e-4)
        found = run(replace(back, input=given), forces, moved, 5e-4)
        off = np.abs(found - drive(t))[1:-1].max()
        assert off < 2e-3 * np.ptp(drive(t))


@pytest.mark.parametrize("given", ["position", "velocity"])
def test_the_force_of_a_mass_is_of_eighth_order_in_the_interval(given):
    """At the ends of a record it is of the third or fourth: samples lack there."""
    ends, inner = [], []
    for count in (50, 100):
        t = np.linspace(0, 1, count + 1)
        q, v, a = (
            np.sin(40 * t + 1),
            40 * np.cos(40 * t + 1),
            -1600 * np.sin(40 * t + 1),
        )
        block = Impedance(mass=1.0, damping=0.0, stiffness=0.0, input=given)
        off = np.abs(block.simulate(q if given == "position" else v, t, t[1]) - a)
        inner.append(off[4:-4].max())
        ends.append(off.max())
    # sin(w t): (w h)^8 / 630 of a rate, (w h)^8 / 3150 of a second derivative.
    part = 630 if given == "velocity" else 3150
    assert inner[1] == pytest.approx(1600 * (40 / 100) ** 8 / part, rel=0.1)
    assert 200 < inner[0] / inner[1] < 256
    assert ends[0] / ends[1] > 4


def test_gain_bias_and_start_are_those_of_the_equation():
    forces, law = SMOOTH["cubic"]
    t = np.linspace(0, 2, 801)
    machine = replace(
        MACHINE, gain=-0.5, bias=30.0, start_position=0.2, start_velocity=-1.0
    )
    wanted = solved(law, t, lambda at: 30 - 0.5 * drive(at), start=(0.2, -1.0))[0]
    found = run(machine, forces, drive(t), t[1])
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-3 * np.ptp(wanted))


def test_a_settled_start_stays_where_the_springs_balance():
    # 200 q + 300 q^3 = 500 at q = 1.
    cubic = force("stiffness", quadratic=0.0, cubic=300.0)
    friction = force("friction-force", coulomb=5.0, presliding_distance=1e-3)
    machine = replace(MACHINE, start="settled", bias=100.0)
    found = run(machine, [cubic, friction], np.full(300, 400.0), 0.01)
    np.testing.assert_allclose(found, 1.0, rtol=1e-12)


def test_a_softened_spring_is_settled_beyond_the_linear_one():
    # 200 q - 50 q^3 = 150 at q = 1; the linear spring alone has 0.75.
    softer = force("stiffness", quadratic=0.0, cubic=-50.0)
    machine = replace(MACHINE, start="settled")
    found = run(machine, [softer], np.full(300, 150.0), 0.01)
    np.testing.assert_allclose(found, 1.0, rtol=1e-9)


def test_no_balance_is_no_output():
    softer = force("stiffness", quadratic=0.0, cubic=-50.0)
    machine = replace(MACHINE, start="settled", gain=-1.0)
    stays = run(machine, [softer], np.full(30, 0.0), 0.01)
    np.testing.assert_array_equal(stays, 0.0)


def test_a_moving_start_goes_on_with_the_motion():
    """A record cut out of a long one: the start at rest rings, this one hardly."""
    t = np.arange(4000) * 2e-3
    forces, _ = SMOOTH["cubic"]
    long = run(MACHINE, forces, drive(t), 2e-3)
    begin = 2600
    off = {}
    for start in ("rest", "settled", "moving"):
        y = run(replace(MACHINE, start=start), forces, drive(t[begin:]), 2e-3)
        off[start] = np.sqrt(np.mean((y - long[begin:])[:200] ** 2))
    assert off["moving"] < 0.5 * off["rest"]
    assert off["moving"] < 0.5 * off["settled"]


def test_a_repeating_start_is_the_second_of_two_passages():
    t = np.arange(2000) * 2e-3
    forces, _ = SMOOTH["cubic"]
    u = 100 * np.sin(2 * np.pi * 2 * t / t[-1]) * np.cos(9 * t)
    twice = run(MACHINE, forces, np.concatenate([u, u]), 2e-3)
    once = run(replace(MACHINE, start="repeating"), forces, u, 2e-3)
    # At its end a record is turned: the last samples know no others to come.
    np.testing.assert_allclose(once, twice[2000:], atol=1e-9 * np.ptp(twice))
    at_rest = run(MACHINE, forces, u, 2e-3)
    assert np.abs(at_rest - once).max() > 0.01 * np.ptp(once)


def test_a_motion_that_runs_away_is_no_number_from_there_on():
    # 200 q - 50 q^3 is never 400.
    softer = force("stiffness", quadratic=0.0, cubic=-50.0)
    y = run(MACHINE, [softer], np.full(2000, 400.0), 0.01)
    first = int(np.argmax(np.isnan(y)))
    assert 0 < first < 500
    assert np.isfinite(y[:first]).all()
    assert np.isnan(y[first:]).all()


def test_a_free_mass_has_no_place_of_balance():
    with pytest.raises(InputError, match="start: settled; expected rest") as told:
        replace(MACHINE, stiffness=0.0, start="settled")
    assert "\n" not in str(told.value)
    with pytest.raises(InputError, match="start: repeating; expected rest, as"):
        replace(MACHINE, stiffness=0.0, start="repeating")


@pytest.mark.parametrize("output", ["velocity", "acceleration"])
def test_a_free_mass_whose_place_is_not_shown_may_have_moved_before(output):
    t = np.arange(2000) * 2e-3
    u = 100 * np.sin(2 * np.pi * 2 * t / t[-1]) * np.cos(9 * t)
    free = replace(MACHINE, stiffness=0.0, output=output)
    dry = [force("friction-force", coulomb=5.0, presliding_distance=0.01)]
    twice = run(free, dry, np.concatenate([u, u]), 2e-3)
    once = run(replace(free, start="repeating"), dry, u, 2e-3)
    np.testing.assert_allclose(once, twice[2000:], atol=1e-9 * np.ptp(twice))
    assert np.abs(run(free, dry, u, 2e-3) - once).max() > 0.01 * np.ptp(once)


@pytest.mark.parametrize("count", [0, 1, 2, 3])
@pytest.mark.parametrize("hold", ["linear", "band-limited"])
def test_a_record_may_be_short(hold, count):
    forces, _ = SMOOTH["two"]
    z = np.ones(count)
    assert run(replace(MACHINE, hold=hold), forces, z, 0.01).shape == (count,)
    back = Impedance(mass=1.0, damping=1.0, stiffness=1.0)
    assert run(back, forces, z, 0.01).shape == (count,)


@pytest.mark.parametrize("start", ["rest", "settled", "moving", "repeating"])
@pytest.mark.parametrize("hold", ["zero-order", "linear", "band-limited"])
def test_many_records_at_once_are_as_one_by_one(hold, start):
    """Records of two rates, of which some are shorter than a curve needs."""
    machine = replace(MACHINE, hold=hold, start=start)
    step = force("friction-force", coulomb=20.0, presliding_distance=0.02).attach(
        machine
    )
    signals = [drive(0.02 * np.arange(n) + 0.3 * n) for n in (300, 0, 1, 2, 50, 120)]
    rates = [0.02, 0.02, 0.02, 0.01, 0.01, 0.02]
    near = [(replace(step, host=replace(machine, mass=2.1)), signals)]
    together = step.simulate_records(signals, rates)
    both = step.near_records(signals, rates, near)
    assert all(map(np.array_equal, together, both[0]))
    for k, (z, dt) in enumerate(zip(signals, rates, strict=True)):
        np.testing.assert_array_equal(together[k], step.simulate(z, z, dt))
        alone = step.near_records((z,), (dt,), [(near[0][0], (z,))])
        np.testing.assert_array_equal(both[1][k], alone[1][0])


@pytest.mark.parametrize(
    "machine",
    [
        Mechanism(mass=1e-9, damping=3e-4, stiffness=5.0),  # creeps back in 60 us
        Mechanism(mass=1e-9, damping=1e-6, stiffness=5.0),  # swings at 11 kHz
    ],
)
def test_what_samples_do_not_show_takes_no_shorter_steps(machine):
    """Nor does it miss more than a thousandth of the motion for that."""
    dt = 5e-4
    t = dt * np.arange(2000)
    u = 2 * np.sin(40 * t) + 1.5 * np.sin(130 * t)
    spring = registry()["stiffness"].from_mapping({"quadratic": 0.0, "cubic": 20.0})
    assert machine.parts(dt, (spring,), 0.25) <= 5
    fine, quick = (
        Driven(machine, (spring,), pieces).simulate(u, u, dt) for pieces in (16, 0.25)
    )
    assert np.linalg.norm(quick - fine) < 1e-3 * np.linalg.norm(fine)

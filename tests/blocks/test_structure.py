"""Modes with forces at one joint, beside a mechanism and masses that an ODE moves."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

from hystbench.blocks import registry
from hystbench.blocks.attached import attached, through_near
from hystbench.blocks.force import Force
from hystbench.blocks.mechanism import OUTPUTS, Mechanism
from hystbench.blocks.structure import Structure
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from tests.blocks.examples import EXAMPLES

#: Two masses between walls, driven and seen at the first; a law acts between the two.
MASSES = np.diag([1.0, 0.5])
SPRINGS = np.array([[300.0, -100.0], [-100.0, 180.0]])
RATIO = 2e-3
DRIVE, JOINT, SENSOR = np.array([1.0, 0.0]), np.array([1.0, -1.0]), np.array([1.0, 0.0])
SQUARES, SHAPES = eigh(SPRINGS, MASSES)


def listed(values):
    return tuple(float(x) for x in values)


def two_masses(**about):
    """Write them by their modes, each damped by RATIO times its stiffness."""
    return Structure(
        stiffness=listed(SQUARES),
        damping=listed(RATIO * SQUARES),
        modal_constant=listed((DRIVE @ SHAPES) * (SENSOR @ SHAPES)),
        # The sign of a mode is that with which the drive moves it.
        drive=listed(np.abs(DRIVE @ SHAPES)),
        joint=listed(JOINT @ SHAPES * np.sign(DRIVE @ SHAPES)),
        blend=(0.0, 0.0),
        **about,
    )


def force(name, **values):
    return registry()[name].from_mapping(values or EXAMPLES[name])


def output(chain, u, dt):
    (step,) = attached(chain)
    return step.simulate(np.asarray(u, dtype=float), None, dt)


def given(t):
    return 40 * np.sin(11 * t) + 25 * np.sin(23 * t)


def solved(t, law):
    """Move the masses by an integrator that controls its error."""

    def moves(at, state):
        x, v = state[:2], state[2:]
        held = SPRINGS @ x + RATIO * SPRINGS @ v + JOINT * law(JOINT @ x, JOINT @ v)
        return [*v, *((DRIVE * given(at) - held) / np.diag(MASSES))]

    exact = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}
    x, _, v, _ = solve_ivp(moves, (t[0], t[-1]), [0.0] * 4, t_eval=t, **exact).y
    return np.array([x, v])


LAWS = {
    "stiffness": ({"cubic": 900.0}, lambda q, v: 900.0 * q**3),
    "drag": ({"coefficient": 2.0}, lambda q, v: 2.0 * v * abs(v)),
}


@pytest.mark.parametrize("name", LAWS)
def test_half_the_step_makes_a_quarter_of_the_error(name):
    values, law = LAWS[name]
    values = {"quadratic": 0.0, **values} if name == "stiffness" else values
    errors = []
    for count in (1000, 2000, 4000):  # one step each
        t = np.linspace(0, 2, count + 1)
        found = [
            output([two_masses(output=kind), force(name, **values)], given(t), t[1])
            for kind in OUTPUTS[:2]
        ]
        wanted = solved(t, law)
        off = np.abs(np.array(found) - wanted).max(axis=1)
        errors.append(off / np.ptp(wanted, axis=1))
    assert np.max(errors[-1]) < 2e-3
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert (ratios > 3.3).all()
    assert (ratios < 4.7).all()


@pytest.mark.parametrize("start", ["rest", "settled", "moving", "repeating"])
@pytest.mark.parametrize("kind", OUTPUTS[:3])
def test_one_mode_is_a_mechanism(kind, start):
    about = {"output": kind, "start": start, "hold": "band-limited"}
    machine = Mechanism(mass=2.0, damping=3.0, stiffness=200.0, blend=0.01, **about)
    shape = 2.0**-0.5
    mode = Structure(
        stiffness=(100.0,),
        damping=(1.5,),
        modal_constant=(0.5,),
        drive=(shape,),
        joint=(shape,),
        blend=(0.01,),
        **about,
    )
    t = 0.01 * np.arange(500)
    for name in ("friction-force", "hysteretic-force"):
        law = force(name)
        wanted = output([machine, law], 1 + given(t) / 40, 0.01)
        found = output([mode, law], 1 + given(t) / 40, 0.01)
        np.testing.assert_allclose(found, wanted, atol=1e-11 * np.ptp(wanted))


@pytest.mark.parametrize(
    "host", [two_masses(), Mechanism(mass=1.0, damping=0.6, stiffness=300.0)]
)
def test_without_a_force_all_move_as_beside_a_force_that_does_nothing(host):
    """The kernel takes another way there; the linear part of a step is exact."""
    u, dt = given(0.004 * np.arange(300)), 0.004
    records = (u, 0.5 * u[::-1].copy())
    softer = 1.001 * np.array(host.stiffness)
    near = replace(host, stiffness=softer.tolist())
    beside = []
    for more in ([], [force("drag", coefficient=0.0)]):
        chains = [attached([each, *more]) for each in (host, near)]
        beside.append(through_near(chains, records, (dt, dt)))
    for alone, wanted in zip(*beside, strict=True):
        for one, other in zip(alone, wanted, strict=True):
            np.testing.assert_allclose(one, other, atol=1e-9 * np.ptp(other))


def test_without_a_force_what_runs_away_has_no_number_from_there():
    host = Mechanism(mass=1.0, damping=0.6, stiffness=300.0, output="acceleration")
    u = np.ones(50)
    u[20] = 1e105
    near = attached([replace(host, damping=0.7)])
    (one,), (other,) = through_near([attached([host]), near], (u,), (0.01,))
    for found in (one, other):
        assert np.isfinite(found[:20]).all()
        assert np.isnan(found[21:]).all()


@pytest.mark.parametrize("kind", OUTPUTS[:3])
def test_without_a_force_it_is_the_sum_of_its_modes(kind):
    block = replace(Structure.from_mapping(EXAMPLES["structure"]), output=kind)
    u = np.random.default_rng(3).standard_normal(400)
    found = block.simulate(u, u, 1e-4)
    power = [1.0] + [0.0] * OUTPUTS.index(kind)
    other = [1.0, 0.0, 0.0] if kind == "velocity" else [1.0, 0.0]
    wanted = block.direct * u
    every = zip(
        block.stiffness, block.damping, block.modal_constant, block.blend, strict=True
    )
    for k, c, size, blend in every:
        up = np.polyadd(power, blend * np.array(other))
        mode = TransferFunction(numerator=listed(size * up), denominator=(1.0, c, k))
        wanted = wanted + replace(mode, hold="linear").simulate(u, u, 1e-4)
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.ptp(wanted))


def test_a_joint_that_is_held_joins_the_masses():
    """Friction that nothing moves leaves one mode: of both masses on both walls."""
    mass, spring = MASSES.sum(), SPRINGS.sum()
    t = np.linspace(0, 3, 3001)
    held = force("friction-force", coulomb=1e6, presliding_distance=1e-3)
    found = output([two_masses(), held], given(t), t[1])
    joined = Mechanism(mass=mass, damping=RATIO * spring, stiffness=spring)
    wanted = output([joined], given(t), t[1])
    np.testing.assert_allclose(found, wanted, atol=1e-5 * np.ptp(wanted))


def test_a_passive_force_takes_energy():
    """Undamped masses, let go from where a force held them, swing less and less."""
    u = np.zeros(20_000)
    u[0] = 60.0
    block = two_masses(start="settled", hold="zero-order")
    quiet = replace(block, damping=(0.0, 0.0))
    friction = force("friction-force", coulomb=1.0, presliding_distance=1e-4)
    free, held = output([quiet], u, 1e-3), output([quiet, friction], u, 1e-3)
    spans = [np.ptp(x[-4000:]) / np.ptp(x[:4000]) for x in (free, held)]
    assert spans[0] > 0.9
    assert spans[1] < 0.75 * spans[0]


SIZE = 1e-5
"""Share by which a number moves for a derivative."""


def near_ones(chain):
    """Give chains of other numbers: of the modes, and of the force."""
    block, law = chain
    for name in ("stiffness", "damping", "modal_constant", "drive", "joint", "blend"):
        for k in (0, 1):

            def changed(by, name=name, k=k):
                numbers = list(getattr(block, name))
                numbers[k] += by * (numbers[k] or 1e-2)
                return [replace(block, **{name: tuple(numbers)}), law]

            yield f"{name} {k}", changed
    for name in law.parameters():
        value = getattr(law, name)
        if isinstance(value, float) and value not in (0.0, 1.0):

            def changed(by, name=name, value=value):
                return [block, replace(law, **{name: value * (1 + by)})]

            yield name, changed


FORCES = sorted(name for name, kind in registry().items() if issubclass(kind, Force))


RUB = ("friction", "smooth", "lugre", "hysteretic", "iwan", "slider")
"""Forces that are at their most where little moves them."""


@pytest.mark.parametrize("hold", ["zero-order", "band-limited"])
@pytest.mark.parametrize("name", FORCES)
def test_numbers_near_give_derivatives(name, hold):
    """An input is as large as makes the force do a good part of the motion."""
    share = 0.02 if name.startswith(RUB) else 1.0
    u, dt = share * given(0.004 * np.arange(500)), 0.004
    chain = [two_masses(hold=hold), force(name)]
    labels, every = zip(*near_ones(chain), strict=True)
    others = [attached(changed(SIZE)) for changed in every]
    found = through_near([attached(chain), *others], (u,), (dt,))
    for label, changed, (other,) in zip(labels, every, found[1:], strict=True):
        up, down = (output(changed(by), u, dt) for by in (SIZE, -SIZE))
        wanted = (up - down) / 2
        off = np.linalg.norm(other - found[0][0] - wanted)
        # Differences of whole motions stick, slide and turn at other times.
        assert off < 0.01 * np.linalg.norm(wanted) + 1e-11 * np.linalg.norm(up), label


def test_a_joint_that_nothing_moves_is_refused():
    block = two_masses()
    with pytest.raises(InputError, match="joint: all zero; expected one mode or more"):
        replace(block, joint=(0.0, 0.0))


def test_no_force_acts_where_no_joint_is_given():
    block = replace(two_masses(), joint=())
    t = 0.002 * np.arange(500)
    np.testing.assert_array_equal(
        output([block], given(t), t[1]), output([two_masses()], given(t), t[1])
    )
    with pytest.raises(InputError, match="structure: joint: expected a number of each"):
        attached([block, force("friction-force")])


def test_a_mode_that_samples_do_not_show_does_not_coarsen_the_others():
    """Steps are as short as for the modes that they do show."""
    dt, spring = 1e-3, force("stiffness", quadratic=0.0, cubic=900.0)
    rates = np.array([300.0, 2830.0, 3770.0])
    each = (1.0, 1.0, 1.0)
    three = Structure(
        stiffness=listed(rates**2),
        damping=each,
        modal_constant=each,
        drive=each,
        joint=each,
    )
    two = Structure(
        stiffness=listed(rates[:2] ** 2),
        damping=each[:2],
        modal_constant=each[:2],
        drive=each[:2],
        joint=each[:2],
    )
    assert three.parts(dt, (spring,)) == two.parts(dt, (spring,)) == 40


def test_a_mode_that_is_driven_backwards_is_to_be_turned():
    given = {"stiffness": [160.0, 820.0], "damping": [0.3, 0.6]}
    given |= {"modal_constant": [1.0, 0.5], "drive": [1.0, -14.25]}
    with pytest.raises(InputError, match=r"drive\[1\]: -14\.25; expected more than 0"):
        Structure.from_mapping(given)


def test_shapes_for_unit_mass_make_a_model_in_millimetres():
    drive, joint, sensor = np.array([[0.45, 0.8], [0.3, -1.1], [1.25, -1.1]])
    about = {"stiffness": (6800.0, 259000.0), "damping": (5.8, 20.3)}
    in_m = Structure(
        **about,
        modal_constant=listed(drive * sensor),
        drive=listed(drive),
        joint=listed(joint),
    )
    in_mm = Structure(
        **about,
        modal_constant=listed(1000 * drive * sensor),
        drive=listed(np.sqrt(1000) * drive),
        joint=listed(np.sqrt(1000) * joint),
    )
    z = 200 * np.sin(80 * np.arange(500) * 1e-3)
    spring = registry()["stiffness"]  # in N/m^3 and in N/mm^3
    moved = in_m.driven(z, 1e-3, (spring(cubic=1e7),))
    np.testing.assert_allclose(
        in_mm.driven(z, 1e-3, (spring(cubic=1e7 * 1e-9),)), 1000 * moved, atol=1e-6
    )
    # The spring is felt.
    assert np.abs(in_m.driven(z, 1e-3, ()) - moved).max() > 0.1 * np.abs(moved).max()

"""Run every kernel and print digests of what it wrote: every_kernel.py PROCESSORS.

Also the bounds of Eq. 19, which are BLAS's work.

PROCESSORS is how many of those allowed are used, at most. It is set before NumPy is
imported, as for a process that is confined from the start.
"""

import hashlib
import json
import os
import sys
from dataclasses import replace

allowed = sorted(os.sched_getaffinity(0))
os.sched_setaffinity(0, allowed[: int(sys.argv[1])])

import numpy as np  # noqa: E402

from hystbench import (  # noqa: E402
    kernels,
    operators,
    published,
)
from hystbench.blocks.attached_mass import AttachedMass  # noqa: E402
from hystbench.blocks.creep import Creep  # noqa: E402
from hystbench.blocks.friction_force import FrictionForce  # noqa: E402
from hystbench.blocks.gravity import Gravity  # noqa: E402
from hystbench.blocks.hysteretic_force import HystereticForce  # noqa: E402
from hystbench.blocks.impedance import Impedance  # noqa: E402
from hystbench.blocks.iwan_force import IwanForce  # noqa: E402
from hystbench.blocks.jiles_atherton import JilesAtherton  # noqa: E402
from hystbench.blocks.lugre_force import LuGreForce  # noqa: E402
from hystbench.blocks.mechanism import Mechanism  # noqa: E402
from hystbench.blocks.preisach import Preisach  # noqa: E402
from hystbench.blocks.rate_dependent_hysteresis import (  # noqa: E402
    RateDependentHysteresis,
)
from hystbench.blocks.relaxation_force import RelaxationForce  # noqa: E402
from hystbench.blocks.resonance import Resonance  # noqa: E402
from hystbench.blocks.slew_limit import SlewLimit  # noqa: E402
from hystbench.blocks.stiffness import Stiffness  # noqa: E402
from hystbench.blocks.stiffness_hardening import StiffnessHardening  # noqa: E402
from hystbench.blocks.store import Store  # noqa: E402
from hystbench.blocks.structure import Structure  # noqa: E402
from hystbench.envelope import Envelope  # noqa: E402
from hystbench.filters import FILTERS, run_many  # noqa: E402
from hystbench.inverse.feedforward import Plays  # noqa: E402

DT = 1e-4
SAMPLES = 33_000  # more than the filters take at a time
MORE = {
    "delayed": {},
    "backlash": {"amplitude": 1.0},
    "gpo": {"amplitude": 1.0},
    "volterra": {"second_order_step": 1e-4},
}


def signals():
    """Input, and the output of a plant with memory and a bend."""
    k = np.arange(SAMPLES)
    x = 0.5 * np.sin(0.031 * k) + 0.2 * np.sin(0.17 * k + 1)
    x += 0.02 * np.random.default_rng(5).standard_normal(SAMPLES)
    memory = np.convolve(x, 0.7 ** np.arange(40))[:SAMPLES]
    return x, memory + 0.5 * memory**2


def filters(x, d):
    """Outputs, errors and final weights of every filter."""
    assert set(MORE) == set(published.FILTERS)
    jobs = [
        (FILTERS[name](order=order, step_size=1e-3, **options), x, d)
        for name, options in MORE.items()
        for order in (3, 30, 70)
    ]
    for (adaptive, _, _), result in zip(jobs, run_many(jobs), strict=True):
        assert result.diverged_at is None
        arrays = (result.output, result.error, result.weights)
        yield f"{adaptive.name} {adaptive.order}", arrays
    # one call for several step sizes
    together = [
        (FILTERS[name](order=30, step_size=1.1e-4 * k, **MORE[name]), x, d)
        for name in ("gpo", "backlash")
        for k in range(1, 18)
    ]
    for (adaptive, _, _), result in zip(together, run_many(together), strict=True):
        arrays = (result.output, result.error, result.weights)
        yield f"{adaptive.name}, step size {adaptive.step_size}", arrays
    for name in ("gpo", "backlash"):
        adaptive = FILTERS[name](order=30, step_size=1e-3, **MORE[name])
        line = np.concatenate((np.zeros(adaptive.history), x[:3000]))
        yield (
            f"regressor of {name}",
            adaptive.regressor(line, np.zeros(adaptive.taps)),
        )


def bounds(x):
    """Bounds of Eq. 19 of the filters."""
    for name, options in MORE.items():
        bound = FILTERS[name](order=30, step_size=1e-3, **options).bound(x)
        yield name, [float(value).hex() for value in vars(bound).values()]


def models(x):
    """Outputs and last states of the operators, and of the linear systems."""
    left, right = x + 0.1, x - 0.1
    r, w = np.linspace(0, 0.9, 31), np.linspace(1, 0.1, 31)
    few, some = r[:11], w[:11]
    growth = 1 + 0.1 * x
    a = 0.1 * np.random.default_rng(6).standard_normal((11, 11))
    o = operators
    bent = Envelope(1.0, 2.0, 0.1, 0.2, 0.9, 1.5, -0.1, -0.2)
    yield "envelope functions", (bent.left(x), bent.right(x))
    sides = left.copy(), right.copy()
    o.follow_direction(x, *sides)
    yield "gpo, Eq. 12", (o.generalized_play(*sides, r),)
    yield "gpi", (o.generalized_prandtl_ishlinskii(left, right, r, w),)
    plays = (tuple(x.tolist()) for x in (r, w))
    numbers = tuple(vars(bent).values())
    yield "gpi of an input", (o.enveloped_plays(x, numbers, *plays),)
    rates = (0.03 * growth, 0.9 * growth)
    yield "rdgpi", o.rate_dependent_prandtl_ishlinskii(left, right, *rates, 31)
    yield "growing play", (o.growing_play(x, r, growth),)
    growing = o.generalized_prandtl_ishlinskii(left, right, r, w, growth)
    yield "growing Prandtl-Ishlinskii", (growing,)
    yield "state space", (o.state_space(a, few, some, 0.1, x),)
    modes, state = [kernels.pad(values) for values in (few, some, some)], np.zeros(16)
    kernels.call("hb_modes", len(x), 2, *modes, 0.1, x, state, y := np.empty(len(x)))
    yield "modes", (y, state)
    columns = np.zeros((2 * kernels.WIDTH, 2 * kernels.WIDTH))
    columns[:11, :11], states = a.T, np.outer(x, kernels.pad(few))
    kernels.call("hb_states", len(x), 2, columns, states)
    yield "states", (states,)
    plays = Plays(1.0, (), few, np.vstack([some, 0.1 * some, 0.1 * some]), False)
    yield "inverse of plays", (plays.invert(x)[0],)


def blocks(x):
    """Outputs of the blocks that have a kernel of their own."""
    lag = Resonance(
        frequency_hz=300.0, damping_ratio=0.05, participation=0.4, hold="linear"
    )
    yield "records", lag.simulate_records([x, 0.5 * x[::-1]], [DT, 2 * DT])
    each = (
        SlewLimit(rate=50.0),
        SlewLimit(rate=50.0, time_constant_s=2 * DT),
        SlewLimit(rate=50.0, time_constant_s=2 * DT, form="sharp"),
        StiffnessHardening(
            coefficient=0.5, frequency_hz=300.0, damping_ratio=0.05, participation=0.4
        ),
        JilesAtherton(
            saturation=1.0, shape=0.2, coupling=0.1, pinning=0.2, reversibility=0.2
        ),
        Preisach(
            limit=1.5, reversible=0.1, cells=40, weights=(1.0,), centres=(0.0,),
            centre_spreads=(0.5,), half_widths=(0.3,), half_width_spreads=(0.2,),
        ),
    )  # fmt: skip
    for block in each:
        yield block.name, (block.simulate(x, x, DT),)
    wrapped = RateDependentHysteresis(
        coefficient=0.01, exponent=0.5, form="acting-field"
    ).wrap(each[-1], x, x, DT, None)
    yield "acting field", (wrapped,)
    forces = (
        AttachedMass(mass=1e-4, damping=2e-3, stiffness=8.0),
        FrictionForce(coulomb=0.2, presliding_distance=1e-3),
        Gravity(amplitude=3.0),
        HystereticForce(largest=0.3, yield_distance=1e-2),
        IwanForce(stiffness=5.0, slip_distance=2e-2),
        LuGreForce(coulomb=0.1, presliding_distance=1e-3, static_excess=0.1),
        RelaxationForce(stiffness=3.0, relaxation_time_s=2e-3),
        Stiffness(quadratic=5.0, cubic=40.0),
    )
    machine = Mechanism(mass=1e-4, damping=5e-3, stiffness=10.0)
    yield "mechanism", (machine.driven(x, DT, forces),)
    held = Mechanism(mass=1e-4, damping=5e-3, stiffness=10.0, start="settled")
    yield "settled mechanism", (held.driven(x + 1.0, DT, forces),)
    modes = Structure.from_mapping(
        {
            "stiffness": [1e5, 4e5],
            "damping": [50.0, 30.0],
            "modal_constant": [1e4, 2e4],
            "drive": [100.0, 120.0],
            "joint": [90.0, -70.0],
            "blend": [0.0, 1e-4],
            "start": "settled",
        }
    )
    yield "structure", (modes.driven(x + 1.0, DT, forces),)
    back = Impedance(mass=1e-4, damping=5e-3, stiffness=10.0, hold="band-limited")
    yield "impedance", (back.driven(x, DT, forces),)
    smooth = {"hold": "band-limited"}
    mode = Resonance(
        frequency_hz=300.0, damping_ratio=0.05, participation=0.4, **smooth
    )
    yield "resonance along a curve", (mode.simulate(x, x, DT),)
    creep = Creep(magnitudes=[0.1, 0.2], time_constants_s=[0.01, 0.1], **smooth)
    yield "creep along a curve", (creep.simulate(x, x, DT),)
    tank = Store(gain=4.0, rate=2.0, bias=1.0, height=1.0)
    yield tank.name, (tank.simulate(x, x, DT),)
    yield "stores near", tuple(tank.near(x, x, DT, [(replace(tank, rate=2.01), x)]))


def main():
    """Print the digests of what each wrote, and the names of the kernels called."""
    called, plain = set(), kernels.call

    def noted(name, *arguments):
        called.add(name)
        return plain(name, *arguments)

    kernels.call = noted
    x, d = signals()
    digests = {}
    for name, arrays in (*filters(x, d), *models(x), *blocks(x)):
        assert all(np.isfinite(values).all() and values.any() for values in arrays)
        bytes_of_all = b"".join(values.tobytes() for values in arrays)
        digests[name] = hashlib.sha256(bytes_of_all).hexdigest()
    processors = len(os.sched_getaffinity(0))
    told = {"called": sorted(called), "digests": digests, "processors": processors}
    print(json.dumps(told | {"bounds": dict(bounds(x))}))


if __name__ == "__main__":
    main()

"""A force alone, against a motion that is given."""

from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from hystbench.blocks.impedance import Impedance

#: A device that is nothing but the forces inside.
BARE = Impedance(mass=0.0, damping=0.0, stiffness=0.0)


def against(block, q, dt=1e-3):
    """Give the force against a motion."""
    return block.attach(BARE).simulate(np.asarray(q, dtype=float), None, dt)


def along(slope, turns):
    """Solve dz/dq = slope(q, z, direction) from zero, finely, along a way that turns.

    Gives the places and the solution there.
    """
    z, wanted, way = [0.0], [np.zeros(1)], [np.zeros(1)]
    for a, b in pairwise(turns):
        places = np.linspace(a, b, 41)[1:]
        found = solve_ivp(
            slope, (a, b), z, t_eval=places, args=(np.sign(b - a),),
            rtol=1e-11, atol=1e-13, max_step=1e-3,
        )  # fmt: skip
        z = found.y[:, -1]
        wanted.append(found.y[0])
        way.append(places)
    return np.concatenate(way), np.concatenate(wanted)


def errors_of(host, forces, drive, wanted, end, counts):
    """Give the error of a driven host in steps, so many over the time, per range.

    ``wanted`` is the motion at the finest of them.
    """
    errors = []
    for count in counts:
        t = np.linspace(0, end, count + 1)
        found = host.driven(drive(t), t[1], forces)
        off = np.sqrt(np.mean((found - wanted[:: counts[-1] // count]) ** 2))
        errors.append(off / np.ptp(wanted))
    return np.array(errors)

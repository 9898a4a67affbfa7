"""Motions by a general solver, which knows nothing of hystbench's blocks."""

import numpy as np
from scipy.integrate import odeint


def motion(slope, start, time, longest_step, *args, rtol=1e-7, atol=1e-9):
    """Give the first number of a state at each time; the others are its rates.

    ``slope`` takes the time, the state and what else is given. The driving force bends
    at its samples: no step is so long that one of them would be passed over.
    """
    found = odeint(
        *(slope, start, time, args),
        tfirst=True,
        hmax=longest_step,
        rtol=rtol,
        atol=atol,
    )
    return np.array(found[:, 0])

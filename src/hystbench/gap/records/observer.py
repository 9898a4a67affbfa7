"""Records whose simulated motion is drawn to the measured one, as an observer does.

A controller may keep a machine where friction or a stop would throw it about. Simulated
from its recorded force alone, without the controller, it goes another way after a small
error. An observer [1]_ adds ``d (v - w)`` to the force, v the measured velocity and w
the simulated one. Here it is done in two parts: ``d v`` goes into the records
(:attr:`Record.injected`), and ``d w`` is a damper in the model. Simulating the
controller [2]_ does the same where it is known.

References
----------
.. [1] D. G. Luenberger, "An introduction to observers", IEEE Transactions on Automatic
   Control 16 (1971) 596-602.
.. [2] M. Gautier, A. Janot, P.-O. Vandanjon, "A new closed-loop output error method for
   parameter identification of robot dynamics", IEEE Transactions on Control Systems
   Technology 21 (2013) 428-444.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.free_mass import decay_of_free_mass
from hystbench.record import FloatArray, Record

NEIGHBOURS, DEGREE = 3, 4
"""Samples on either side, and degree, of the polynomial that gives the velocity: nearer
to a fast motion than the parabola by which a free mass is known, and more noisy."""


def observer_for(evidence: Evidence) -> float | None:
    """Give the damper of an observer that is as strong as what moves the device.

    Its force on a model that stands still is as large as the recorded one, rms about
    the mean. So it can hold the model where the recorded force would move it away, and
    hides no more of it than that.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    float or None
        In the input's unit per unit of velocity. None where the input is no force, or
        the output neither a position nor a velocity.
    """
    about = evidence.quantities
    if about.causality != "force to motion":
        return None
    if about.output not in ("position", "velocity"):
        return None
    force = np.mean([np.var(x.u) for x in evidence.fit])
    motion = np.mean([np.var(_velocity(x, about.output)) for x in evidence.fit])
    return float(np.sqrt(force / motion)) if force and motion else None


def with_observer_signal(evidence: Evidence, damper: float) -> Evidence:
    """Give records that an observer of such a damper has added its force to.

    Parameters
    ----------
    evidence : Evidence
        Its output is a position or a velocity.
    damper : float
        In the input's unit per unit of velocity; zero gives the records as they are.
    """
    if damper == 0.0:
        return evidence
    output, count = evidence.quantities.output, len(evidence.fit)
    every = (*evidence.fit, *evidence.hold_out)
    motion = [_velocity(x, output) for x in every]
    # A force gives power to what it moves: else the two are counted against each other.
    pairs = zip(evidence.fit, motion[:count], strict=True)
    sign = -1.0 if sum(float(np.vdot(x.u, v)) for x, v in pairs) < 0.0 else 1.0
    force = [sign * damper * v for v in motion]
    if evidence.input_hold == "zero-order":  # the mean over the interval it is held for
        force = [np.append((x[:-1] + x[1:]) / 2, x[-1]) for x in force]
    found = [replace(x, injected=own) for x, own in zip(every, force, strict=True)]
    if evidence.in_windows:  # an unknown velocity dies out sooner
        driven = [replace(x, u=x.driven) for x in found]
        decay = decay_of_free_mass(driven, evidence.quantities)
        if decay is not None:
            found = [replace(x, decay_s=decay) for x in found]
    fit, hold_out = tuple(found[:count]), tuple(found[count:])
    return replace(evidence, fit=fit, hold_out=hold_out)


def _velocity(record: Record, output: str) -> FloatArray:
    """Give the measured velocity, by polynomials where the position was measured."""
    if output == "velocity":
        return record.y
    from scipy.signal import savgol_filter  # late: few searches need it

    window = 2 * NEIGHBOURS + 1
    slope = savgol_filter(record.y, window, DEGREE, deriv=1, delta=record.dt)
    return np.asarray(slope)

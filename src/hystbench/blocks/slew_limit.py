"""Block ``slew-limit``: the drive changes no faster than its rate."""

import numpy as np

from hystbench import kernels
from hystbench.blocks.base import Block
from hystbench.blocks.parameter import TINY, choice, number
from hystbench.blocks.step import Sampling, Step
from hystbench.record import FloatArray

FORMS = ("rounded", "sharp")
QUICK = 64.0
"""Sampling intervals over the time constant from which the lag is neglected: far more
than records show."""


class SlewLimit(Block, name="slew-limit", place="drive"):
    """Output that follows its input with ``|dv/dt| <= rate``.

    With ``falling`` it goes down at another rate than up, ``dv/dt >= -falling``, as a
    cylinder does whose rod takes a part of one side, or an arm that has weight. It
    starts at the input's first sample. Exact for an input that moves straight between
    samples: where the output catches up within an interval, it follows from there on.

    With a time constant small signals lag by ``tau``, and large ones are limited:
    ``dv/dt = rate f((z - v) / (rate tau))``. The form ``rounded`` is an amplifier whose
    first stage gives no more than a current, by the law of a pair of transistors [2]_:
    ``f = tanh``. The form ``sharp`` is a servo whose valve or motor goes no faster:
    ``f(x) = max(-1, min(1, x))``. Where it falls, ``rate`` is the other one. Of second
    order in the smaller of a sampling interval and an eighth of ``tau``.

    References
    ----------
    .. [1] K. J. Astrom, R. M. Murray, Feedback Systems, 2nd ed., Princeton University
       Press, 2021: saturation, rate limits and dead zones of actuators.
    .. [2] J. E. Solomon, The monolithic op amp: a tutorial study, IEEE Journal of
       Solid-State Circuits 9 (1974) 314-332.
    """

    rate: float = number("U/s", "largest rate of the output", TINY)
    time_constant_s: float = number(
        "s", "lag tau of small signals; 0 for none", 0.0, 1e3, default=0.0
    )
    form: str = choice("how one with a lag nears its rate", FORMS, FORMS[0])
    falling: float = number(
        "U/s", "largest rate downwards; 0 where it is the same", 0.0, default=0.0
    )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Follow the input at a limited rate."""
        v = np.empty(len(z))
        rate, falling = self.rate * dt, self._falling * dt
        z = np.ascontiguousarray(z, np.float64)
        if self._lags(dt):
            lag = rate, falling / rate, dt / self.time_constant_s
            kernels.call("hb_slew_with_lag", len(z), self._sharp, *lag, z, v)
        else:
            kernels.call("hb_slew_limit", len(z), rate, falling, z, v)
        return v

    def step(self, sampling: Sampling) -> Step:
        """Follow the input, which goes straight from its last sample."""
        rate, down = self.rate * sampling.dt, self._falling / self.rate
        if self._lags(sampling.dt):
            share = sampling.dt / self.time_constant_s
            about = {"sharp": self._sharp, "rate": rate, "down": down, "share": share}
            return Step("slew_with_lag", about, {"started": 1, "before": 1, "x": 1})
        rates = {"rising": rate, "falling": down * rate}
        return Step("slew_limit", rates, {"started": 1, "before": 1, "now": 1})

    @property
    def _falling(self) -> float:
        return self.falling or self.rate

    @property
    def _sharp(self) -> int:
        return FORMS.index(self.form)

    def _lags(self, dt: float) -> bool:
        return QUICK * self.time_constant_s > dt

"""Block ``jiles-atherton``: hysteresis of domain walls held by pinning sites."""

import math

import numpy as np

from hystbench import kernels
from hystbench.blocks.parameter import TINY, number
from hystbench.blocks.step import Sampling, Step
from hystbench.blocks.wrapping import HystereticBlock
from hystbench.errors import InputError
from hystbench.record import FloatArray

STEPS = 8
"""Steps of the integration over the shorter of ``shape`` and ``pinning``."""
LARGEST_COUPLING = 2.9
"""Largest coupling, in units of ``shape``: at 3 the slope is infinite."""


class JilesAtherton(HystereticBlock, name="jiles-atherton", place="material"):
    """Jiles-Atherton hysteresis of a biased transducer [1]_.

    With the field ``h = bias + z`` and the effective field ``e = h + coupling m``,
    the magnetization m, as a share of saturation, follows from ::

        man(e) = coth(e / shape) - shape / e
        dm/de  = max(d (man - m), 0) / pinning + reversibility dman/de

    where d is the direction of the field. The maximum takes away the negative
    susceptibility after a turn of the field, which no material has [2]_ [3]_. The
    output is ``saturation (m - m_0)`` with the anhysteretic ``m_0`` at the bias, where
    the block starts. Rate-independent; minor loops close only after some rounds.

    The gap between man and m never exceeds ``(1 - reversibility) pinning max(dman/de)``
    so that ``dm/de <= 1 / (3 shape)``: the slope dm/dh is finite for every
    ``coupling < 3 shape``.

    References
    ----------
    .. [1] D. C. Jiles, D. L. Atherton, "Theory of ferromagnetic hysteresis", Journal of
       Magnetism and Magnetic Materials 61 (1986) 48-60.
    .. [2] D. C. Jiles, J. B. Thoelke, M. K. Devine, "Numerical determination of
       hysteresis parameters for the modeling of magnetic properties using the theory
       of ferromagnetic hysteresis", IEEE Transactions on Magnetics 28 (1992) 27-35.
    .. [3] A. J. Bergqvist, "A simple vector generalization of the Jiles-Atherton model
       of hysteresis", IEEE Transactions on Magnetics 32 (1996) 4213-4215.
    """

    saturation: float = number("Y", "output that m = 1 stands for, Ms")
    shape: float = number("U", "a, width of the anhysteretic curve", TINY)
    coupling: float = number("U", "alpha Ms, field of the domains' own", 0.0)
    pinning: float = number("U", "k, field that frees a domain wall", TINY)
    reversibility: float = number("-", "c, share of reversible motion", 0.0, 1.0)
    bias: float = number("U", "constant field", default=0.0)

    def check(self) -> None:
        """Refuse a coupling at which the anhysteretic curve turns vertical."""
        if self.coupling > LARGEST_COUPLING * self.shape:
            raise InputError(
                f"coupling: {self.coupling:g} is too large, expected at most "
                f"{LARGEST_COUPLING:g} times shape, {LARGEST_COUPLING * self.shape:g}"
            )

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Integrate over the field, which moves straight between samples.

        The field goes in steps of 1/8 of the shorter of ``shape`` and ``pinning``,
        and finer as the coupling steepens the curve: the error, and with it how far the
        output depends on the sampling, is mostly 1e-6 of the saturation, at most 1e-4.
        """
        start = self.anhysteretic(self.bias)
        state, out = np.array([start]), np.empty(len(z))
        finer = 1 - self.coupling / (3 * self.shape)
        kernels.call(
            "hb_jiles_atherton",
            len(z),
            self.shape,
            self.coupling,
            self.pinning,
            self.reversibility,
            min(self.shape, self.pinning) / STEPS * finer,
            self.bias,
            self.bias + np.ascontiguousarray(z),
            state,
            out,
        )
        return self.saturation * (out - start)

    def anhysteretic(self, field: float) -> float:
        """Solve ``m = man(field + coupling m)`` by bisection to the last bit."""
        low, high = -1.0, 1.0
        while low < (middle := 0.5 * (low + high)) < high:
            x = (field + self.coupling * middle) / self.shape
            if langevin(x) > middle:
                low = middle
            else:
                high = middle
        return middle

    def step(self, sampling: Sampling) -> Step:
        """Integrate over the field; the states count from the bias."""
        finer = 1 - self.coupling / (3 * self.shape)
        names = ("saturation", "shape", "coupling", "pinning", "reversibility")
        constants = self.constants(*names) | {
            "longest": min(self.shape, self.pinning) / STEPS * finer,
            "bias": self.bias,
            "start": self.anhysteretic(self.bias),
        }
        return Step("jiles_atherton", constants, {"field": 1, "magnetization": 1})


def langevin(x: float) -> float:
    """Langevin's function ``coth x - 1 / x``."""
    if abs(x) < 1e-4:
        return x / 3
    return 1 / math.tanh(x) - 1 / x

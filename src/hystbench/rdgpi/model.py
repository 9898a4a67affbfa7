"""Rate-dependent generalized Prandtl-Ishlinskii model (RDGPI), the paper's baseline.

The paper gives eleven parameters and points to another paper for the equations. What
is here is a reading of those parameters, made from descriptions of the same family
of models; docs/rdgpi.md says what supports it and what does not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from hystbench.envelope import NamedNumbers
from hystbench.errors import InputError, refuse_unknown
from hystbench.operators import rate_dependent_prandtl_ishlinskii
from hystbench.record import FloatArray

Start = Literal["rest", "settled"]
STARTS: tuple[Start, ...] = ("rest", "settled")


class Path(NamedTuple):
    """An input and the magnitude of its rate, both of shape (n,)."""

    u: FloatArray
    rate: FloatArray


@dataclass(frozen=True)
class RateDependentGPI(NamedNumbers):
    """Prandtl-Ishlinskii model whose thresholds and weights follow the input's rate.

    With the rate ``|dv/dt|`` in units of the input per second,

    - envelope: ``gamma(v) = envelope_gain v + envelope_offset``, both sides alike;
    - thresholds: ``r_i = i c alpha1 ln(beta1 + lambda1 |dv/dt|)``, i from 0 to N;
    - weights: ``w_i = rho exp(-tau r_i) (1 - alpha2 ln(beta2 + lambda2 |dv/dt|)) /
      (N + 1)``;
    - output: ``y = sum of w_i F_i``, F_i the generalized play operator of Eq. 4.

    At rate zero it is the generalized Prandtl-Ishlinskii model of Eq. 9 with evenly
    spaced thresholds and exponential weights.

    Parameters
    ----------
    alpha1, beta1, lambda1, c : float
        Spacing of the thresholds; ``lambda1`` in seconds per unit of the input.
    alpha2, beta2, lambda2 : float
        Loss of weight with the rate; ``lambda2`` in seconds per unit of the input.
    rho, tau : float
        Weight of the first operator times N + 1, and its decay over the thresholds.
    envelope_gain, envelope_offset : float
        The paper's xi and mu, which is no convergence factor.
    order : int
        Order N.
    start : {"rest", "settled"}
        Operators before the first sample: at zero, or as the same input leaves them.

    Raises
    ------
    InputError
        If a parameter is not finite, a spacing could be negative or a logarithm
        undefined.
    """

    place: ClassVar[str] = "rdgpi"

    alpha1: float
    beta1: float
    lambda1: float
    alpha2: float
    beta2: float
    lambda2: float
    c: float
    rho: float
    tau: float
    envelope_gain: float
    envelope_offset: float
    order: int = 30
    start: Start = "rest"

    def __post_init__(self) -> None:
        """Refuse parameters that define no model."""
        self.check_finite()
        refuse_unknown(self.start, STARTS, f"rdgpi.start: {self.start!r} unknown")
        if self.order < 0:
            raise InputError(f"rdgpi.order: {self.order} given, expected 0 or more")
        for name in ("lambda1", "lambda2"):
            if getattr(self, name) < 0:
                raise InputError(f"rdgpi.{name}: expected 0 or more")
        if self.beta1 < 1 or self.alpha1 * self.c < 0:
            raise InputError(
                "rdgpi: beta1 of 1 or more and alpha1 c of 0 or more expected, "
                "or thresholds are negative"
            )
        if self.beta2 <= 0:
            raise InputError("rdgpi.beta2: expected above 0, a logarithm is taken")

    def spacing(self, rate: ArrayLike) -> FloatArray:
        """Distance of neighbouring thresholds at each rate of the input."""
        growth = np.log(self.beta1 + self.lambda1 * np.abs(rate))
        return self.c * self.alpha1 * growth

    def gain(self, rate: ArrayLike) -> FloatArray:
        """Weight of the operator of threshold zero at each rate of the input."""
        loss = self.alpha2 * np.log(self.beta2 + self.lambda2 * np.abs(rate))
        return self.rho * (1 - loss) / (self.order + 1)

    def simulate(self, u: ArrayLike, dt: float) -> FloatArray:
        """Compute the output for an input.

        Parameters
        ----------
        u : array_like, shape (n,)
            Input.
        dt : float
            Sampling interval in seconds.

        Returns
        -------
        ndarray, shape (n,)
            Output, in free run: no measured output goes in.

        Raises
        ------
        InputError
            If the input has fewer than two samples or is not finite.
        """
        u = np.ascontiguousarray(u, dtype=np.float64)
        path = Path(u, input_rate(u, dt))
        return self.respond(path, path)

    def respond(
        self, path: Path, lead: Path, parts: Sequence[slice] = (slice(None),)
    ) -> FloatArray:
        """Compute the output along a path; a settled start follows the lead.

        Parameters
        ----------
        path, lead : Path
        parts : sequence of slice
            Parts of both, of which each starts anew; by default the whole.
        """
        before = self._drive(lead) if self.start == "settled" else None
        along = self._drive(path)
        total = np.empty(len(path.u))
        for part in parts:
            state = None if before is None else self._follow(before, part)[1]
            total[part] = self._follow(along, part, state)[0]
        return self.gain(path.rate) * total

    def _drive(self, path: Path) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Envelope, spacing of the thresholds and ratio of the weights on a path."""
        envelope = self.envelope_gain * path.u + self.envelope_offset
        spacing = self.spacing(path.rate)
        return envelope, spacing, np.exp(-self.tau * spacing)

    def _follow(
        self,
        drive: tuple[FloatArray, FloatArray, FloatArray],
        part: slice,
        state: FloatArray | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Output of the operators over a part of a path, and their last state."""
        envelope, spacing, ratio = (values[part] for values in drive)
        return rate_dependent_prandtl_ishlinskii(
            envelope, envelope, spacing, ratio, self.order + 1, state=state
        )


PUBLISHED_RDGPI = RateDependentGPI(
    alpha1=8.3721,
    beta1=1.002,
    lambda1=0.2494e-5,
    alpha2=0.0785,
    beta2=1.2443,
    lambda2=0.94e-2,
    c=1.1867,
    rho=3.3478,
    tau=0.1910,
    envelope_gain=7.0270,
    envelope_offset=-0.1284,
)
"""The eleven values that the paper prints, under the reading of this module."""


def input_rate(u: FloatArray, dt: float) -> FloatArray:
    """Magnitude of the input's rate: central differences, one-sided at the ends.

    Raises
    ------
    InputError
        If there are fewer than two samples or one is not finite.
    """
    if u.ndim != 1 or len(u) < 2:
        raise InputError(f"rdgpi: input of shape {u.shape}, two samples expected")
    if not np.isfinite(u).all():
        raise InputError("rdgpi: the input is not finite")
    if not dt > 0:
        raise InputError(f"rdgpi: sampling interval {dt}, expected above 0")
    return np.abs(np.gradient(u, dt))

"""What an identification found."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hystbench.envelope import Envelope
from hystbench.identification.weights import Samples, Start, lead_in
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Identification:
    """Generalized Prandtl-Ishlinskii model of a slow record, by Algorithm 1."""

    envelope: Envelope
    """Envelope functions, Eqs. 5 and 6."""
    thresholds: FloatArray
    """Thresholds by Eq. 10, shape (N + 1,)."""
    weights: FloatArray
    """Weights of Eq. 9, output per unit of envelope, shape (N + 1,)."""
    offset: float
    """Constant beside Eq. 9, in the unit of the output; zero unless it was fitted."""
    amplitude: float
    """Largest magnitude of the input."""
    start: Start
    """States before the first sample: zero (Eq. 3), or as the input leaves them."""
    cost: float
    """J of Eq. 11 over the whole record."""
    cost_history: tuple[float, ...]
    """The least J over the whole record after each iteration."""
    epsilon: float
    """Tolerable J."""
    relative_error: float
    """RE over the whole record."""
    starts: int
    """Starting points that were used."""
    published_relative_error: float | None = None
    """RE with the published envelopes and the weights that fit best with them."""

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for array in (self.thresholds, self.weights):
            array.setflags(write=False)

    @property
    def reached(self) -> bool:
        """Whether J is below epsilon."""
        return self.cost < self.epsilon

    @property
    def message(self) -> str:
        """Say in one sentence how it ended."""
        figures = (
            f"J = {self.cost:.6g} after {len(self.cost_history)} iterations from "
            f"{self.starts} start{'s' * (self.starts != 1)}, "
            f"epsilon = {self.epsilon:.6g}, relative error {self.relative_error:.4g}"
        )
        if self.reached:
            return f"epsilon reached: {figures}"
        return f"epsilon not reached: {figures}; the best is kept"

    def simulate(self, u: ArrayLike) -> FloatArray:
        """Compute the model's output, Eq. 9, for an input.

        Parameters
        ----------
        u : array_like, shape (n,)
            Input in the unit of the record.

        Returns
        -------
        ndarray, shape (n,)
            Output in the unit of the record.
        """
        u = np.ascontiguousarray(u, dtype=np.float64)
        samples = Samples(u, u, lead_in(u, self.start))
        return samples.model(self.envelope, self.thresholds, self.weights) + self.offset

    def to_dict(self) -> dict[str, Any]:
        """Give everything as plain numbers, lists and strings, for JSON."""
        return {
            "envelope": self.envelope.to_dict(),
            "thresholds": self.thresholds.tolist(),
            "weights": self.weights.tolist(),
            "offset": self.offset,
            "amplitude": self.amplitude,
            "start": self.start,
            "J": list(self.cost_history),
            "J_final": self.cost,
            "epsilon": self.epsilon,
            "reached": self.reached,
            "relative_error": self.relative_error,
            "published_relative_error": self.published_relative_error,
            "starts": self.starts,
            "message": self.message,
        }

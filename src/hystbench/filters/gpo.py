"""GPO adaptive filter: generalized play operators along the delay line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope, thresholds
from hystbench.filters.plays import PlayFilter
from hystbench.record import FloatArray


@dataclass(frozen=True, kw_only=True)
class GPOFilter(PlayFilter):
    """Adaptive filter of generalized play operators, Eqs. 10, 12, 13 and 18.

    ``H_i[x(k - i)]`` is the operator of threshold ``r_i`` on tap i. Other parameters
    are those of :class:`hystbench.filters.plays.PlayFilter`.

    Parameters
    ----------
    envelope : Envelope
        Envelope functions; by default the paper's.

    References
    ----------
    Zhang and Ma, Modeling of Rate-Dependent Hysteresis Using a GPO-Based Adaptive
    Filter, Sensors 16 (2), 205, 2016.
    """

    name: ClassVar[str] = "gpo"

    envelope: Envelope = PUBLISHED_ENVELOPE

    @property
    def thresholds(self) -> FloatArray:
        """Thresholds by Eq. 10."""
        return thresholds(self.envelope, self.amplitude, self.order)

    def envelopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Envelope functions of the input, Eqs. 5 and 6."""
        return self.envelope.left(x), self.envelope.right(x)

"""GPO adaptive filter: generalized play operators along the delay line."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope, thresholds
from hystbench.errors import InputError
from hystbench.filters.keys import choice
from hystbench.filters.plays import PlayFilter
from hystbench.operators import FORMS, Form
from hystbench.record import FloatArray, Record


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
    label: ClassVar[str] = "GPO filter"
    takes_envelopes: ClassVar[bool] = True

    form: Form = choice(
        "equation by which the operators move",
        FORMS,
        default="eq12",
        key="operator_form",
    )
    envelope: Envelope = PUBLISHED_ENVELOPE

    @classmethod
    def options(
        cls,
        settings: Mapping[str, Any],
        record: Record,
        identified: Mapping[str, Any] | None,
    ) -> dict[str, Any]:
        """Give its own keys, the amplitude, and the envelopes that are asked for.

        Raises
        ------
        InputError
            If identified envelopes are asked for but not given.
        """
        own = super().options(settings, record, identified)
        if settings["envelopes"] != "identified":
            return own
        if identified is None:
            raise InputError(
                "envelopes: identified; expected the option --identified FILE"
            )
        return own | {
            "envelope": Envelope(**identified["envelope"]),
            "amplitude": identified["amplitude"],
        }

    @property
    def thresholds(self) -> FloatArray:
        """Thresholds by Eq. 10."""
        return thresholds(self.envelope, self.amplitude, self.order)

    def envelopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Envelope functions of the input, Eqs. 5 and 6."""
        return self.envelope.left(x), self.envelope.right(x)

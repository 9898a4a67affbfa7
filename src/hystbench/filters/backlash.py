"""Backlash adaptive filter: play operators in place of delays."""

from dataclasses import dataclass
from typing import ClassVar, Literal, get_args

from hystbench.envelope import equal_intervals
from hystbench.filters.keys import choice
from hystbench.filters.plays import PlayFilter
from hystbench.record import FloatArray

Structure = Literal["delay-line", "current-input"]


@dataclass(frozen=True, kw_only=True)
class BacklashFilter(PlayFilter):
    """Adaptive filter of play operators (backlash), Eqs. 1, 2, 13 and 18.

    Other parameters are those of :class:`hystbench.filters.plays.PlayFilter`.

    Parameters
    ----------
    structure : {"delay-line", "current-input"}
        Whether operator i acts on x(k - i), as the generalized ones do, or all act
        on x(k), a Prandtl-Ishlinskii model with adaptive weights. The paper leaves
        it open.

    References
    ----------
    Zhang and Ma (2016), reference 25 there.
    """

    name: ClassVar[str] = "backlash"
    label: ClassVar[str] = "backlash filter"

    structure: Structure = choice(
        "input on which the operators act",
        get_args(Structure),
        default="delay-line",
        key="backlash_structure",
    )

    @property
    def along_line(self) -> bool:
        """Whether operator i reads tap i."""
        return self.structure == "delay-line"

    @property
    def thresholds(self) -> FloatArray:
        """Equal intervals of the amplitude."""
        return equal_intervals(self.amplitude, self.order)

    def envelopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Give the input itself twice: the envelopes of a play are straight."""
        return x.copy(), x.copy()

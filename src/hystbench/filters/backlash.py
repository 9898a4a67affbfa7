"""Backlash adaptive filter: play operators in place of delays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from hystbench.envelope import play_thresholds
from hystbench.errors import InputError, nearest
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

    structure: Structure = "delay-line"

    def __post_init__(self) -> None:
        """Refuse parameters out of range."""
        super().__post_init__()
        known = ("delay-line", "current-input")
        if self.structure not in known:
            raise InputError(
                f"structure: {self.structure!r} unknown; "
                f"{nearest(self.structure, known)}"
            )

    @property
    def along_line(self) -> bool:
        """Whether operator i reads tap i."""
        return self.structure == "delay-line"

    @property
    def thresholds(self) -> FloatArray:
        """Equal intervals of the amplitude."""
        return play_thresholds(self.amplitude, self.order)

    def envelopes(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Give the input itself twice: the envelopes of a play are straight."""
        return x.copy(), x.copy()

"""A view: one way in which an engineer reads where the gap is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hystbench.gap.locate.forms import FittedForm
from hystbench.gap.locate.picture import ViewPicture
from hystbench.gap.view_kinds import ViewKind
from hystbench.sentences import percent

SIGNIFICANT = 0.01
"""Of a p-value, for a part of a view to be told as there."""
LEAST_SHARE = 0.01
"""Of the gap's power, for a part of a view to be told at all."""


@dataclass(frozen=True)
class View:
    """Where the gap lies, in one kind of view."""

    view: ViewKind
    axis: str
    """What ``start`` and ``end`` are values of."""
    start: float | str
    end: float | str
    """The narrowest range that holds four fifths of what this view explains, in
    ``unit``; of branches and records, the names of the first and the last."""
    unit: str
    share_of_gap_power: float
    """Power that this view explains over the power of the gap above the noise, from 0
    to 1. The shares of several views may add to more than 1."""
    p_value: float
    """How often a residual without this structure, but of the same colour, would look
    as much like it."""
    sentence: str
    """The same in words."""
    saved: float
    """Description length that it saves: see :func:`hystbench.gap.locate.locate`."""
    named: bool = False
    """Whether it shows what a named effect adds."""
    pictures: tuple[ViewPicture, ...] = ()
    kinds: tuple[str, ...] = ()
    """Of the view by level: how modes move with it."""

    def to_mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``where``."""
        return {
            "view": self.view,
            "axis": self.axis,
            "from": self.start,
            "to": self.end,
            "unit": self.unit,
            "share_of_gap_power": self.share_of_gap_power,
            "p_value": self.p_value,
            "sentence": self.sentence,
        }


def view_of(
    view: ViewKind,
    form: FittedForm,
    axis: str,
    ends: tuple[float | str, float | str],
    unit: str,
    told: str,
    pictures: Sequence[ViewPicture] = (),
    share: float | None = None,
) -> View:
    """Give the view that a form tells.

    Parameters
    ----------
    view, axis, unit, pictures
        As for :class:`View`.
    form : FittedForm
    ends : tuple of (float or str, float or str)
        Of the range.
    told : str
        What the sentence says behind "so much of the gap".
    share : float, optional
        That of the form by default.
    """
    share = form.share if share is None else share
    return View(
        view=view,
        axis=axis,
        start=ends[0],
        end=ends[1],
        unit=unit,
        share_of_gap_power=share,
        p_value=form.p_value,
        sentence=f"{percent(share)} of the gap {told}",
        saved=form.saved,
        named=form.named,
        pictures=tuple(pictures),
    )


def chance(p_value: float) -> str:
    """Write a p-value as it stands in a sentence."""
    return "p < 0.001" if p_value < 0.001 else f"p = {p_value:.2g}"

"""Where the gap is: views, from samples to what an engineer reads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from hystbench.gap.locate.along_axes import (
    amplitude,
    branch,
    delay,
    rate,
    record,
    slow_time,
)
from hystbench.gap.locate.forms import View
from hystbench.gap.locate.frequency import frequency
from hystbench.gap.locate.level import level
from hystbench.gap.locate.samples import Contribution, take_samples
from hystbench.gap.locate.unexplained import unexplained
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.scored_samples import Compared
from hystbench.gap.thresholds import BY_CHANCE

__all__ = ["Contribution", "View", "curves", "locate", "ranked"]

NOT_DRAWN = {
    "distortion": "distortion, as no record repeats with a gap above the noise",
    "over-plane": "the residual by rate, as the input rests",
    "levels": "modes by level, as no three levels of a broadband input show one",
}
"""Why a picture may be missing, by its name."""


def locate(
    compared: Sequence[Compared],
    floor: Floor,
    contributions: Sequence[Contribution] = (),
) -> tuple[View, ...]:
    """Say where the residual is, in views that an engineer reads.

    Parameters
    ----------
    compared : sequence of Compared
        Records beside their simulations; rates and lengths may differ.
    floor : Floor
    contributions : sequence of Contribution
        What named effects add to the simulation.

    Returns
    -------
    tuple of View
        One view of each kind that the records allow. Those in which named effects show
        come first, the largest first. Behind them stand the others, by what they save;
        last those whose p-value, times the number of views, is not below 0.05.

    Notes
    -----
    What an effect adds was fitted by the search; a view shows where on its axis that
    lies. Without a name a view fits what any function of its axis could explain. Any
    gap lies somewhere on every axis, and a free enough map holds all of it, so the
    largest share says little. A form saves description length: half of 300 facts times
    the log of how much smaller the residual's power gets, less half of log 300 for
    every parameter (the Bayesian information criterion, the facts fixed because a
    model's error is not white). So of two views that explain as much the simpler comes
    first, and no view wins by freedom.
    """
    samples = take_samples(compared, floor, contributions)
    by_level = level(samples)
    views = (
        delay(samples),
        amplitude(samples),
        branch(samples),
        frequency(samples),
        slow_time(samples),
        unexplained(samples),
        rate(samples),
        record(samples),
        *(() if by_level is None else (by_level,)),
    )
    return ranked(views)


def curves(views: Sequence[View]) -> dict[str, Any]:
    """Give what curves.json holds: pictures as data, in the order of the views.

    And which these records do not give, and why.
    """
    drawn = [asdict(picture) for view in views for picture in view.pictures]
    names = {picture["name"] for picture in drawn}
    return {
        "pictures": drawn,
        "not_drawn": [why for name, why in NOT_DRAWN.items() if name not in names],
    }


def ranked(views: Sequence[View]) -> tuple[View, ...]:
    """Put named views first, then those that save most, then what chance may give."""

    def order(view: View) -> tuple[bool, bool, float]:
        by_chance = view.p_value * len(views) >= BY_CHANCE
        return not view.named, by_chance, -view.saved

    return tuple(sorted(views, key=order))

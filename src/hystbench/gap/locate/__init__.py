"""Where the gap is: one module a view, one number by which the views are ranked."""

from __future__ import annotations

from collections.abc import Sequence

from hystbench.errors import InputError
from hystbench.gap.compared import Compared
from hystbench.gap.floor import Floor
from hystbench.gap.locate.amplitude import amplitude_view
from hystbench.gap.locate.branch import branch_view
from hystbench.gap.locate.curves import curves
from hystbench.gap.locate.delay import delay_view
from hystbench.gap.locate.distortion import take_distortion
from hystbench.gap.locate.frequency import frequency_view
from hystbench.gap.locate.levels import levels_view, take_levels
from hystbench.gap.locate.rate import rate_view
from hystbench.gap.locate.record import record_view
from hystbench.gap.locate.samples import take_samples
from hystbench.gap.locate.slow_time import slow_time_view
from hystbench.gap.locate.spectra import take_spectra
from hystbench.gap.locate.unexplained import unexplained_view
from hystbench.gap.locate.view import View

__all__ = ["LEVEL", "View", "curves", "locate", "ranked"]

LEVEL = 0.05
"""Of a view's p-value times the number of views, for more than chance."""


def locate(compared: Sequence[Compared], floor: Floor) -> tuple[View, ...]:
    """Say where the residual is, in views that an engineer reads.

    Parameters
    ----------
    compared : sequence of Compared
        Records beside their simulations; rates and lengths may differ.
    floor : Floor

    Returns
    -------
    tuple of View
        One of each kind that the records allow, the most telling first; those whose
        p-value, times the number of views, is not below 0.05 come last.

    Raises
    ------
    InputError
        If there is no record, or one is too short.

    Notes
    -----
    Any gap lies somewhere on every axis, and a wide enough range or a free enough map
    holds all of it, so the largest share says little. Each view offers a few forms,
    from one parameter (a delay) to a map, and the residual is fitted with each. A form
    saves description length: half of 300 facts times the log of how much smaller the
    residual's power gets, less half of log 300 for every parameter (the Bayesian
    information criterion, the facts fixed because a model's error is not white). A view
    ranks by the best of its forms. So of two views that explain as much, the simpler
    comes first: a delay before a gain and phase of each band; and no view wins by
    freedom. A base whose loop has a wrong shape leaves a residual that hides a smaller
    effect: forms are also tried beside what such a shape could leave, and must then
    save clearly more than the shape alone does. Ranges are chosen after that: the
    narrowest that holds four fifths.

    A share is no evidence: a free form holds much of any residual of few facts. So a
    view that chance may give, after Bonferroni's correction for the views tried, never
    stands before one that it may not.
    """
    if not compared:
        raise InputError("locate: expected at least one record, got none")
    samples = take_samples(compared, floor)
    spectra = take_spectra(samples)
    distortion = take_distortion(samples)
    moving = take_levels(samples)
    views = (
        delay_view(samples, spectra),
        amplitude_view(samples),
        branch_view(samples),
        frequency_view(samples, spectra, distortion),
        slow_time_view(samples),
        unexplained_view(samples, distortion),
        rate_view(samples),
        record_view(samples),
        *((levels_view(samples, moving),) if moving else ()),
    )
    return ranked(views)


def ranked(views: Sequence[View]) -> tuple[View, ...]:
    """Put the views that save most first, behind them those that chance may give."""

    def order(view: View) -> tuple[bool, float]:
        return view.p_value * len(views) >= LEVEL, -view.saved

    return tuple(sorted(views, key=order))

"""Several fits that know nothing of each other, on several cores."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from typing import Any

from hystbench.cores import each
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.serialize import read_like, written
from hystbench.gap.fitting.state import ModelState


def fit_each(
    fit: Callable[[Fitted], Fitted], begun: Sequence[Fitted], evaluations: int
) -> list[Fitted]:
    """Fit models on, each on its own records.

    Parameters
    ----------
    fit : callable
        Gives a fit of a model on the same records.
    begun : sequence of Fitted
    evaluations : int
        Of the residual, about as many as a fit takes.

    Returns
    -------
    list of Fitted
        In their order, the same on any number of cores.
    """

    def read(content: Any, before: Fitted) -> Fitted:
        return Fitted(*read_like(content, before.state))

    effort = evaluations * len(begun[0].state.sample) if begun else 0.0
    return each(fit, begun, "fits", effort=effort, write=write_fit, read=read)


def write_fit(found: Fitted) -> Any:
    """Write a fit, which :func:`read_like` reads as its model and its score."""
    return written((found.state, found.score))


def fit_states(
    fit: Callable[[ModelState], Fitted], states: Sequence[ModelState], evaluations: int
) -> list[Fitted]:
    """Fit models of which no fit is known yet."""
    begun = [Fitted(state, inf) for state in states]
    return fit_each(lambda own: fit(own.state), begun, evaluations)

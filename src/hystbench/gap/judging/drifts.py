"""What of a gap that is called a drift follows known signals after all.

A drift is slow and the input does not explain it. What a path leaves of one that
wanders is no white noise, so slow signals follow it by chance. Here a random walk in
each run competes with them.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from hystbench.gap.fitting.added_signals import beside_columns
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.judging.grouped_evidence import ColumnProducts, Groups
from hystbench.gap.judging.known_signals import PATH, random_walks
from hystbench.gap.thresholds import LOOSE
from hystbench.record import FloatArray

WALKS = "random walks"
"""The group of their cosines."""


def beside_a_drift(
    state: ModelState,
    own: Groups,
    generic: Groups,
    slow_power: Groups,
    structured: float,
    allowed: float,
    power: float,
) -> tuple[float, dict[str, FloatArray]]:
    """Give the share of the gap that follows known signals, and the signals.

    Parameters
    ----------
    state : ModelState
        With a drift that has a path.
    own, generic : mapping
        What the named effects and the base may own, and known signals.
    slow_power : mapping
        Slow averages of the squared input. They count where they explain much of the
        gap, and with random walks all of it likelier than paths do: that is heat.
    structured : float
        The share if what the path leaves were white.
    allowed : float
        What may stay; less is not looked at again.
    power : float
        Of the gap.

    Returns
    -------
    structured : float
    signals : dict
        The known signals that count.
    """
    short = without_paths(state, own)
    may_be_heat = _explained(state, short, slow_power) > LOOSE * power
    if structured <= allowed and not may_be_heat:
        return structured, {**generic}
    explained = partial(explained_beside_walks, state, random_walks(state))
    if structured > allowed:
        most, _ = explained(own, generic)
        structured = min(structured, most / power)
    if may_be_heat:
        _, as_path = explained(own, {})
        heat, as_heat = explained(short, slow_power)
        if heat > LOOSE * power and as_heat > as_path:
            return heat / power, {**generic, **slow_power}
    return structured, {**generic}


def without_paths(state: ModelState, own: Groups) -> dict[str, FloatArray]:
    """Give what is owned but for the paths of a drift; tones of the mains stay."""
    tones = [
        beside_columns(state.records, state.sample, beside, values)
        for beside, values in state.beside
        if beside.effect != PATH
    ]
    short = {**own, "beside": np.hstack([np.zeros((len(state.sample), 0)), *tones])}
    del short["path"]
    return short


def _explained(state: ModelState, own: Groups, signals: Groups) -> float:
    """Give the power that signals explain beyond what is owned, beside white noise."""
    table = ColumnProducts.of({**own, **signals}, state.residual)
    return table.explained(own).noise - table.explained([*own, *signals]).noise


def explained_beside_walks(
    state: ModelState,
    walks: tuple[FloatArray, FloatArray],
    own: Groups,
    signals: Groups,
) -> tuple[float, float]:
    """Explain a residual by signals and random walks, one in each run, together.

    Parameters
    ----------
    state : ModelState
    walks : (ndarray, ndarray)
        Cosines of the random walks and their sizes: :func:`random_walks`.
    own, signals : mapping
        Columns by group, shape (scored samples, k) each.

    Returns
    -------
    power : float
        Of what the signals explain in the likeliest model, the part beyond what is
        owned.
    evidence : float
        Logarithm of the probability density of the residual.
    """
    cosines, sizes = walks
    groups = {**own, **signals, WALKS: cosines}
    table = ColumnProducts.of(groups, state.residual, {WALKS: sizes})
    found = table.explained(groups)
    return table.power_beyond(signals, own, found), found.evidence

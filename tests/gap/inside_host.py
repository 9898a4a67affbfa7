"""Forces tried inside a host, alone and together."""

from functools import partial

from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.insert_law import laws_for


def forces(score, offered, turns):
    """Search for what may be put into a host, by a score."""
    return ForceSearch(partial(laws_for, offered=offered, turns=turns), score)


def each_alone(host, score, offered=None, turns="", other=None):
    """Give the host alone first; then each force by itself, the least score first."""
    return forces(score, offered, turns).singles(host, other)


def search(host, score, offered=None, turns="", other=None):
    """Give the host alone first; then every other with the score that was reached."""
    trial = forces(score, offered, turns)
    return trial.together(trial.singles(host, other))

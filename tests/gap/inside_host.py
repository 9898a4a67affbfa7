"""Forces tried inside a host, alone and together."""

from functools import partial

from hystbench.gap.inside.combine_forces import singles, together
from hystbench.gap.inside.insert_law import laws_for


def each_alone(host, score, offered=None, turns="", other=None):
    """Give the host alone first; then each force by itself, the least score first."""
    offer = partial(laws_for, offered=offered, turns=turns)
    return singles(host, offer, score, other=other)


def search(host, score, offered=None, turns="", other=None):
    """Give the host alone first; then every other with the score that was reached."""
    offer = partial(laws_for, offered=offered, turns=turns)
    return together(each_alone(host, score, offered, turns, other), offer, score)

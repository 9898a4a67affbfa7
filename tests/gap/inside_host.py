"""Forces tried inside a host, alone and together."""

from hystbench.gap.inside.search import laws_for, singles, together


def search(host, score, offered=None):
    """Give the host alone first; then every other with the score that was reached."""
    laws = laws_for(host, offered=offered)
    return together(singles(host, laws, score), laws, score)

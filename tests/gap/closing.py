"""A gap searched and written, as the command does it."""

from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.run import closed_gap, will_write


def close_gap(evidence, base, folder, *, report=True, place="model", **asked):
    """Write the result to a folder; what stands in the way is refused before."""
    will_write(folder, evidence)
    closed = closed_gap(evidence, base, Asked(**asked), place)
    closed.write(folder, report)
    return closed


def closed_beside(base, evidence, asked):
    """What is decided beside a base, by its file or by a word for it."""
    model, _ = load_base(str(base), evidence)
    return closed_gap(evidence, model, asked).outcome.content

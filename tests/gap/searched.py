"""A search on records alone, without a dataset."""

from hystbench.gap import search as module
from hystbench.gap.asked import Asked
from hystbench.gap.records.evidence import Evidence


def search(
    name, records, base, hold="band-limited", *, declared=None, quantities=None, **asked
):
    """Decide on the records as those to fit; none is held out."""
    evidence = Evidence(name, tuple(records), (), hold, declared)
    return module.search(evidence, base, Asked(**asked), quantities)

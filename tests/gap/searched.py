"""A search on records alone, without a dataset."""

from hystbench.gap import search as module
from hystbench.gap.asked import Asked
from hystbench.gap.effects import effects
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.vocabulary import Vocabulary


def among(*names):
    """Offer these effects alone, where a test is about what is told between them."""
    return Vocabulary.of(sorted(set(effects()) - set(names)))


def search(
    name, records, base, hold="band-limited", *, declared=None, quantities=None, **asked
):
    """Decide on the records as those to fit; none is held out."""
    evidence = Evidence(name, tuple(records), (), hold, declared)
    return module.search_and_judge(evidence, base, Asked(**asked), quantities)

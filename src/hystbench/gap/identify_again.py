"""A hysteresis identified again, from its record without what an effect does to it."""

from __future__ import annotations

from collections.abc import Callable, Collection

from hystbench.gap.bases.gpi import identified_gpi
from hystbench.gap.beside_base import BesideBase, leaves_much, stays
from hystbench.gap.fitting.edit_chain import without
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.freed_record import freed_of_laws, freed_of_slow_law
from hystbench.gap.progress import Say
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model

TURNS = 3
"""Times that a loop is identified anew; after each its effects are known better."""


def identified_again(
    found: BesideBase,
    named: Named,
    evidence: Evidence,
    named_beside: Callable[[Model], BesideBase],
    say: Say,
    offered: Collection[str],
) -> BesideBase:
    """Name beside a loop that is identified again, where that explains more.

    Its record is freed of what laws do to it. Where no such loop stands and laws leave
    much, it is freed of as much creep or heat as the fit records show.

    Parameters
    ----------
    found : BesideBase
        What was named beside the loop as it was first identified.
    named : Named
        Effects beside it, or beside the same with other numbers.
    evidence : Evidence
    named_beside : callable
        Gives what is named beside a base.
    say : callable
    offered : collection of str
        Effects that the device may have.
    """
    freed = freed_of_laws(found.base, named, evidence, found.floor)
    latest = _in_turns(found, freed, evidence, named_beside, say)
    laws = without(found.named.state, found.named.state.paths)  # a path is no law
    if latest is found and leaves_much(laws, found.start, found.floor):
        freed = freed_of_slow_law(found.base, evidence, found.floor, offered)
        latest = _in_turns(found, freed, evidence, named_beside, say)
    return latest


def _in_turns(
    found: BesideBase,
    freed: Evidence | None,
    evidence: Evidence,
    named_beside: Callable[[Model], BesideBase],
    say: Say,
) -> BesideBase:
    """Name beside the loop of a freed record, and free it of what is named then.

    The first of these loops still has a part of the law in it.
    """
    latest = found
    for turn in range(TURNS):
        if freed is None:
            break
        say("the base is identified again without that effect, and naming starts anew")
        base, _ = identified_gpi(freed)
        again = named_beside(base)
        if turn and stays(latest, again):
            break
        latest = again
        freed = freed_of_laws(found.base, again.named, evidence, found.floor)
    if latest is not found and stays(found, latest):
        say("that explains no more: the base stays")
        return found
    return latest

"""What a check says, in words that the terminal and its page share."""

import math

from hystbench.figures.style import unit_text
from hystbench.gap.fitting.parameter_units import written
from hystbench.inspection.check import Check
from hystbench.inspection.facts import Facts
from hystbench.inspection.visible import SmallestSeen

FLOORS = {
    "repeats": "measured by repeats",
    "declared": "declared",
    "upper-bound": "an upper bound, as nothing repeats",
}
KINDS = {"wrong": "refused by 'hystbench gap'", "missing": "to add", "note": "note"}
RIVALS_TOLD = 2
"""Rivals that are named."""
EVEN_CLOCK = 1e-6
"""Of a step: a clock that is as even as that."""


def percent(share: float) -> str:
    """Write a share in percent with two digits."""
    return "never" if math.isinf(share) else f"{100 * share:.2g} %"


def strength(item: SmallestSeen, of_input: str, of_output: str) -> str:
    """Write the number at which an effect is seen first, with its unit."""
    if math.isnan(item.value):
        return ""
    unit = written(item.unit, of_input, of_output)
    name = item.number.replace("_", " ").removesuffix(" s").removesuffix(" hz")
    return f"{name} {quantity(item.value, unit)}"


def quantity(value: float, unit: str) -> str:
    """Write a number with its unit, if it has one."""
    return f"{value:.3g} {unit_text(unit)}".removesuffix(" -").strip()


def mistaken(item: SmallestSeen) -> str:
    """Say what an effect may be mistaken for until it is how large."""
    near = item.rivals[:RIVALS_TOLD]
    if not near:
        return ""
    told = [
        f"{name} (never told)" if share > 1 else f"{name} (up to {percent(share)})"
        for name, share in near
    ]
    more = len(item.rivals) - len(near)
    return ", ".join(told) + (f" and {more} more" if more else "")


def headline(found: Check) -> str:
    """Say in one sentence what is to be done, or that nothing is."""
    wrong = sum(item.kind == "wrong" for item in found.findings)
    missing = sum(item.kind == "missing" for item in found.findings)
    seen, every = len(found.revealed), len(found.effects)
    can = f"the records to fit can reveal {seen} of {every} effects"
    if not every:
        can = "which effects the records can reveal was not asked"
    if wrong:
        things = "thing is" if wrong == 1 else "things are"
        return f"{wrong} {things} wrong, which 'hystbench gap' refuses; {can}."
    if missing:
        return f"Usable, with {missing} to add; {can}."
    return f"Usable as it is; {can}."


def level(facts: Facts, unit: str) -> str:
    """Write the range of an input."""
    item = facts.input
    return f"{item.low:.3g} to {quantity(item.high, unit)}"


def band(facts: Facts) -> str:
    """Write the band of an input."""
    item = facts.input
    return f"{item.low_hz:.3g} to {item.high_hz:.3g} Hz"


def jitter_text(jitter: float) -> str:
    """Write a jitter in percent of a step; what is rounding is none."""
    return "0 %" if jitter < EVEN_CLOCK else f"{100 * jitter:.1g} %"

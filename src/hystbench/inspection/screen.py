"""What a check says on the terminal: one screen, however many records there are.

Records that say the same are one line, and so are findings of one topic. What is cut
off is told; the page has all. The words are in ``screen.txt.j2``.
"""

import math
import re
from collections.abc import Iterable
from itertools import groupby
from textwrap import wrap
from typing import Any

from hystbench.figures.style import unit_text
from hystbench.inspection.check import Check
from hystbench.inspection.facts import Facts
from hystbench.inspection.findings import Finding
from hystbench.report.markup import one_micro
from hystbench.templates import templates

FLOORS = {
    "repeats": "measured by repeats",
    "declared": "declared",
    "upper-bound": "an upper bound if it is white, as no period comes twice",
}
KINDS = {
    "wrong": "refused by 'hystbench gap'",
    "record": "of a record",
    "model": "of the model",
    "missing": "to add",
    "note": "note",
}
EVEN_CLOCK = 1e-6
"""Share of a step to which an even clock is even."""
WIDTH = 100
"""Letters of a line."""
SCREEN_LINES = 40
"""Lines of a screen."""
FEW_RECORDS = 6
"""Records up to which each has a line of its own."""
PART_LINES = {"records": 9, "seen": 5, "alike": 4, "hidden": 3, "unjudged": 2}
"""Lines of each part where all together are more than a screen; findings get the
rest."""
TOGETHER = "\0"
"""A space at which no line is broken."""


def lines(found: Check) -> list[str]:
    """Give the lines for the terminal, at most ``SCREEN_LINES`` of ``WIDTH`` letters.

    A path or a name that is longer by itself is not broken.
    """
    words = words_of(found)

    def part(name: str, *given: int) -> list[str]:
        return [line for each in words(name, *given) for line in _broken(each)]

    parts = {
        "head": part("head"),
        "records": part("each" if len(found.facts) <= FEW_RECORDS else "grouped"),
        "findings": part("findings", FEW_RECORDS),
        **{name: part(name) for name in ("seen", "alike", "hidden", "unjudged")},
    }
    if sum(map(len, parts.values())) > SCREEN_LINES:
        parts |= {key: _cut(parts[key], most) for key, most in PART_LINES.items()}
        parts["findings"] = []
        room = SCREEN_LINES - sum(map(len, parts.values()))
        parts["findings"] = _cut(part("findings", 1), room)
    return [one_micro(line) for part in parts.values() for line in part]


def words_of(found: Check) -> Any:
    """Give what gives the paragraphs of a part of ``screen.txt.j2``, by its name."""
    topics: dict[tuple[str, str], list[Finding]] = {}
    for item in found.findings:
        topics.setdefault((item.kind, item.topic or item.text), []).append(item)
    ordered = sorted(found.facts, key=_alike)
    given = {
        "found": found,
        "groups": [list(group) for _, group in groupby(ordered, _alike)],
        "topics": list(topics.values()),
        "floors": FLOORS,
        "kinds": KINDS,
        "even_clock": EVEN_CLOCK,
    }
    environment = templates(__package__)
    environment.filters |= FILTERS
    module = environment.get_template("screen.txt.j2").make_module(given)

    def words(name: str, *given: int) -> list[str]:
        parts = re.split(r"\n(?:[ \t]*\n)+", getattr(module, name)(*given))
        joined = (re.sub(r"\s*\n\s*", " ", part.strip("\n")) for part in parts)
        return [part.rstrip() for part in joined if part.strip()]

    return words


def _alike(item: Facts) -> tuple[str, str, str]:
    """Give what records have in common that are told together."""
    return item.use, item.input.kind, f"{1 / item.dt:.5g}"


def _cut(part: list[str], most: int) -> list[str]:
    if len(part) <= most:
        return part
    left = len(part) - most + 1
    return [*part[: most - 1], f"  ... {left} more lines: the page has all (--out)"]


def _broken(paragraph: str) -> list[str]:
    """Break a paragraph into lines of the terminal's width."""
    text = paragraph.lstrip()
    indent = " " * (len(paragraph) - len(text))
    broken = wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent if TOGETHER in text else f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace(TOGETHER, " ") for line in broken]


def _jitter(items: Iterable[Facts]) -> str:
    """Tell the largest jitter, and where it comes of times that are rounded."""
    worst = max(items, key=lambda item: item.jitter or 0.0)
    jitter = worst.jitter or 0.0
    said = jitter_text(jitter)
    if jitter < EVEN_CLOCK or worst.tick_s is None:
        return said
    return f"{said} (times are rounded to {worst.tick_s:.1g} s)"


def _span(values: Iterable[float]) -> str:
    known = sorted(values)
    low, high = f"{known[0]:g}", f"{known[-1]:g}"
    return low if low == high else f"{low} to {high}"


def _as_many_as_fit(given: Iterable[str], taken: int) -> str:
    """Name as many as there is room for, at least one, and count the rest."""
    names = list(given)
    for count in range(len(names), 0, -1):
        more = len(names) - count
        said = ", ".join(names[:count]) + (f" and {more} more" if more else "")
        if len(said) <= WIDTH - taken or count == 1:
            break
    return said


def _shortened(text: str) -> str:
    """Keep a text to two lines and a half, in whole sentences where there are some."""
    room = 2 * WIDTH + WIDTH // 2
    if len(text) <= room:
        return text
    sentences = text[:room].rpartition(". ")[0]
    told = f"{sentences}." if sentences else text[:room].rpartition(" ")[0] + " ..."
    return f"{told} (The page has all: --out.)"


def percent(share: float) -> str:
    """Write a share in percent with two digits."""
    if math.isinf(share):
        return "never"
    value = 100 * share
    return f"{value:.2g} %" if value < 99.5 else f"{value:.0f} %"


def quantity(value: float, unit: str) -> str:
    """Write a number with its unit, if it has one."""
    return f"{value:.3g} {unit_text(unit)}".removesuffix(" -").strip()


def capital(text: str) -> str:
    """Begin a sentence."""
    return text[:1].upper() + text[1:]


def band(facts: Facts) -> str:
    """Write the band of an input."""
    item = facts.input
    return f"{item.low_hz:.3g} to {item.high_hz:.3g} Hz"


def jitter_text(jitter: float) -> str:
    """Write a jitter in percent of a step; what is rounding is none."""
    return "0 %" if jitter < EVEN_CLOCK else f"{100 * jitter:.1g} %"


FILTERS = {
    "as_many_as_fit": _as_many_as_fit,
    "band": band,
    "capital": capital,
    "jitter": _jitter,
    "percent": percent,
    "quantity": quantity,
    "shortened": _shortened,
    "span": _span,
    "whole": lambda text: text.replace(" ", TOGETHER),
}

"""What a check says on the terminal: one screen, however many records there are.

Records that say the same are one line, and so are findings of one topic. What is cut
off is told; the page has all.
"""

import math
from collections.abc import Iterable, Sequence
from itertools import groupby
from textwrap import wrap

from hystbench.figures.style import unit_text
from hystbench.inspection.check import Check
from hystbench.inspection.facts import Facts
from hystbench.inspection.findings import Finding
from hystbench.inspection.visible import SmallestSeen
from hystbench.report.markup import one_micro

FLOORS = {
    "repeats": "measured by repeats",
    "declared": "declared",
    "upper-bound": "an upper bound if it is white, as no period comes twice",
}
KINDS = {
    "wrong": "refused by 'hystbench gap'",
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


def lines(found: Check) -> list[str]:
    """Give the lines for the terminal, at most ``SCREEN_LINES`` of ``WIDTH`` letters.

    A path or a name that is longer by itself is not broken.
    """
    unit = found.records[0].input.unit
    few = len(found.facts) <= FEW_RECORDS
    parts = {
        "head": _head(found),
        "records": _each(found.facts, unit) if few else _grouped(found.facts, unit),
        "findings": _findings(found.findings, FEW_RECORDS),
        **_effects(found),
    }
    if sum(map(len, parts.values())) > SCREEN_LINES:
        parts |= {key: _cut(parts[key], most) for key, most in PART_LINES.items()}
        parts["findings"] = []
        room = SCREEN_LINES - sum(map(len, parts.values()))
        parts["findings"] = _cut(_findings(found.findings, 1), room)
    return [one_micro(line) for part in parts.values() for line in part]


def _cut(part: list[str], most: int) -> list[str]:
    if len(part) <= most:
        return part
    left = len(part) - most + 1
    return [*part[: most - 1], f"  ... {left} more lines: the page has all (--out)"]


def _lines(text: str, indent: int = 2, hanging: int = 4) -> list[str]:
    """Break a text into lines of the terminal's width."""
    return wrap(
        text,
        WIDTH,
        initial_indent=" " * indent,
        subsequent_indent=" " * hanging,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _head(found: Check) -> list[str]:
    record = found.records[0]
    unit = record.output.unit
    return [
        *_lines(f"{found.dataset.path}: {headline(found)}", 0, 2),
        *_lines(
            f"{record.input.label} to {record.output.label}; noise "
            f"{quantity(found.floor.rms, unit)} rms ({FLOORS[found.floor.method]}); "
            f"{leaves(found)}"
        ),
    ]


def leaves(found: Check) -> str:
    """Say what the base leaves of the records to fit."""
    base, unit = found.base, found.records[0].output.unit
    left = quantity(base.left, unit)
    if not base.given:
        return f"a loop that does not depend on the rate leaves {left}"
    return (
        f"{base.note}. It runs on all records, and leaves {left} rms of the fit "
        f"records, whose outputs move by {quantity(base.moves, unit)} rms"
    )


def _each(facts: Sequence[Facts], unit: str) -> list[str]:
    width = max(len(item.name) for item in facts)
    told = []
    for item in facts:
        several = "s" * (item.periods != 1)
        period = f"{item.periods:.3g} period{several}" if item.period else "no period"
        jitter = "" if item.jitter is None else f", jitter {_jitter([item])}"
        told += _lines(
            f"{item.name:{width}} {item.use:8} {item.samples} at {1 / item.dt:.5g} Hz"
            f"{jitter}, {item.input.kind}, {period}, {band(item)}, "
            f"{level(item, unit)}"
        )
    return told


def _grouped(facts: Sequence[Facts], unit: str) -> list[str]:
    """Tell records of one use, kind of input and rate together."""

    def key(item: Facts) -> tuple[str, str, str]:
        return item.use, item.input.kind, f"{1 / item.dt:.5g}"

    told = []
    for (use, kind, rate), group in groupby(sorted(facts, key=key), key):
        items = list(group)
        jitter = max(item.jitter or 0.0 for item in items)
        inputs = [item.input for item in items]
        low, high = min(x.low for x in inputs), max(x.high for x in inputs)
        said = [
            f"{len(items)} {use}, {kind}",
            f"{_range(item.samples for item in items)} samples at {rate} Hz",
            *_periods(items),
            f"{min(x.low_hz for x in inputs):.3g} to "
            f"{max(x.high_hz for x in inputs):.3g} Hz",
            f"{low:.3g} to {quantity(high, unit)}",
        ]
        if jitter >= EVEN_CLOCK:
            said.insert(2, f"jitter up to {_jitter(items)}")
        told += _lines(", ".join(said))
        told.append("    " + _names([item.name for item in items], WIDTH - 4))
    return told


def _periods(items: Sequence[Facts]) -> list[str]:
    """Tell how many periods records have, where some have any."""
    counts = [round(item.periods, 1) for item in items]
    if not any(counts):
        return []
    said = _range(counts) if all(counts) else f"up to {max(counts):g}"
    return [f"{said} period{'s' * (said != '1')}"]


def _jitter(items: Sequence[Facts]) -> str:
    """Tell the largest jitter, and where it comes of times that are rounded."""
    worst = max(items, key=lambda item: item.jitter or 0.0)
    jitter = worst.jitter or 0.0
    said = jitter_text(jitter)
    if jitter < EVEN_CLOCK or worst.tick_s is None:
        return said
    return f"{said} (times are rounded to {worst.tick_s:.1g} s)"


def _range(values: Iterable[float]) -> str:
    known = sorted(values)
    low, high = f"{known[0]:g}", f"{known[-1]:g}"
    return low if low == high else f"{low} to {high}"


def _names(names: Sequence[str], room: int) -> str:
    """Name as many as there is room for, at least one, and count the rest."""
    for count in range(len(names), 0, -1):
        more = len(names) - count
        said = ", ".join(names[:count]) + (f" and {more} more" if more else "")
        if len(said) <= room or count == 1:
            break
    return said


def _findings(findings: Sequence[Finding], pasted: int) -> list[str]:
    """Tell findings of one topic together: the first, and whom it is also true of.

    Of lines to be pasted as many are shown of each topic.
    """
    told = []
    topics = dict.fromkeys((item.kind, item.topic or item.text) for item in findings)
    for kind, topic in topics:
        same = [x for x in findings if (x.kind, x.topic or x.text) == (kind, topic)]
        told += _lines(f"{KINDS[kind]}: {_shortened(same[0].text)}")
        others = [item.record for item in same[1:] if item.record]
        if others:
            told.append(f"    likewise: {_names(others, WIDTH - 14)}")
        elif same[1:]:
            told.append(f"    and {len(same) - 1} more of this sort")
        whole = [line for item in same for line in item.paste]
        for line in whole[:pasted]:
            told += _lines(line, 6, 8)
        if whole[pasted:]:
            more = len(whole) - pasted
            told.append(f"      ... {more} more lines to add: the page has all (--out)")
    return told


def _shortened(text: str) -> str:
    """Keep a text to two lines and a half, in whole sentences where there are some."""
    room = 2 * WIDTH + WIDTH // 2
    if len(text) <= room:
        return text
    sentences = text[:room].rpartition(". ")[0]
    told = f"{sentences}." if sentences else text[:room].rpartition(" ")[0] + " ..."
    return f"{told} (The page has all: --out.)"


def _effects(found: Check) -> dict[str, list[str]]:
    """Tell which effects are seen, not told apart and not revealed."""
    if not found.effects:
        return {key: [] for key in ("seen", "alike", "hidden", "unjudged")}
    seen = _listed(f"{x.effect} {percent(x.seen_from)}" for x in found.revealed)
    pairs = _listed(
        f"{x.effect} from {rival} {'at any share' if share > 1 else percent(share)}"
        for x in found.revealed
        for rival, share in x.rivals[:1]
    )
    told = {
        "seen": (f"{_beside(found)} from this share of the output on (rms):", seen),
        "alike": ("Not told apart, up to this share of the output:", pairs),
        "hidden": ("Not revealed:", _hidden(found.hidden)),
        "unjudged": ("Not judged here:", _hidden(found.unjudged)),
    }
    return {
        key: [*_lines(words), *part] if part else []
        for key, (words, part) in told.items()
    }


def _beside(found: Check) -> str:
    if found.base.given:
        return f"Beside {found.base.called} seen"
    return "Seen" if found.base.fits else "Beside that loop, which does not fit, seen"


def _hidden(effects: Sequence[SmallestSeen]) -> list[str]:
    reasons = dict.fromkeys(item.why for item in effects)
    return [
        line
        for why in reasons
        for line in _lines(
            f"{', '.join(x.effect for x in effects if x.why == why)}: {why}", 4, 6
        )
    ]


def _listed(parts: Iterable[str]) -> list[str]:
    """Put parts behind each other; none is broken between two lines."""
    kept = ", ".join(part.replace(" ", "\0") for part in parts)
    return [line.replace("\0", " ") for line in _lines(kept, 4, 4)]


def percent(share: float) -> str:
    """Write a share in percent with two digits."""
    if math.isinf(share):
        return "never"
    value = 100 * share
    return f"{value:.2g} %" if value < 99.5 else f"{value:.0f} %"


def quantity(value: float, unit: str) -> str:
    """Write a number with its unit, if it has one."""
    return f"{value:.3g} {unit_text(unit)}".removesuffix(" -").strip()


def headline(found: Check) -> str:
    """Say in one sentence what is to be done, or that nothing is."""
    wrong = sum(item.kind == "wrong" for item in found.findings)
    missing = sum(item.kind == "missing" for item in found.findings)
    can = _can(found)
    if wrong:
        things = "thing is" if wrong == 1 else "things are"
        return f"{wrong} {things} wrong, which 'hystbench gap' refuses; {can}."
    doubted = any(item.kind == "model" for item in found.findings)
    but = "the model may be wrong; " * doubted
    if missing:
        return f"Usable, with {missing} to add; {but}{can}."
    return f"Usable as it is; {but}{can}."


def _can(found: Check) -> str:
    """Say how many effects the records can reveal, and beside what."""
    base, seen, every = found.base, len(found.revealed), len(found.judged)
    if not every:
        return "which effects the records can reveal was not asked"
    if not (base.fits or base.given):
        return (
            "which effects the records can reveal is not told, as the loop they would "
            f"be judged on does not fit: it leaves {percent(base.share_left)} of the "
            "output's rms. With '--model FILE' they are judged beside your simulator, "
            "with '--model linear' beside a linear model of these records"
        )
    beside = f"beside {base.called} " if base.given else ""
    can = f"{beside}the records to fit can reveal {seen} of the {every} effects judged"
    if base.fits:
        return can
    return f"{can}, but it leaves {percent(base.share_left)} of the output's rms"


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

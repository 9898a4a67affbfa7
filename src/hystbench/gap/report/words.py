"""The verdict and the numbers as they are said on the page."""

from __future__ import annotations

import math
import shlex
from typing import Any

from markupsafe import Markup

from hystbench.device_kinds import DeviceKind
from hystbench.figures.style import unit_text
from hystbench.gap.thresholds import LOOSE
from hystbench.gap.vocabulary import called_in, in_words
from hystbench.sentences import shortly
from hystbench.templates import paragraphs

#: A narrow space that does not break.
NARROW = "\u202f"


def verdict_sentence(gap: dict[str, Any]) -> str:
    """Say the verdict in plain words (``verdict.txt.j2``), what the user put in first.

    Effects are called as they are called in such a device.
    """
    kind: DeviceKind | None = (gap.get("device") or {"kind": None})["kind"]
    names = {
        "names": [effect["name"] for effect in gap["effects"]],
        "taken": (gap["withdrawn"] or {"names": ()})["names"],
        "put_in": (gap.get("asked") or {"with": ()})["with"],
    }
    called = {
        whose: [called_in(name, kind) for name in each] for whose, each in names.items()
    }
    about = {"gap": gap, "loose": LOOSE, **called}
    (said,) = paragraphs(__package__, "verdict.txt.j2", **about)
    return said


def verdict_text(gap: dict[str, Any]) -> str:
    """Give the verdict and its reason as two paragraphs, for a page of several."""
    said = f"**{verdict_sentence(gap)}**\n"
    if gap["verdict"] == "no-gap":  # the sentence holds the reason
        return said
    reason = in_words(gap["reason"]).rstrip(".")
    return f"{said}\n{reason[:1].upper()}{reason[1:]}.\n"


def rerun_commands(gap: dict[str, Any]) -> list[tuple[str, str]]:
    """Give what an engineer may say to a verdict, and the command for each.

    Returns
    -------
    list of (str, str)
    """
    place = gap.get("command") or {"dataset": "DATASET", "model": "MODEL", "out": "OUT"}
    asked = gap.get("asked") or {"without": [], "with": []}
    named = [effect["name"] for effect in gap["effects"]]
    if gap["withdrawn"]:
        named = gap["withdrawn"]["names"]
    known = {*named, *asked["with"], *asked["without"]}
    likely = [x for effect in gap["effects"] for x in effect["cannot_be_told_from"]]
    tried = [
        item["name"]
        for item in gap["ranking"]
        if item["round"] == 1 and not item["look"] and "declined" not in item
    ]
    rival = next((name for name in (*likely, *tried) if name not in known), None)
    found = [(f"it is not {name}", [name], "") for name in dict.fromkeys(named)]
    if rival is not None:
        found.append((f"it is {rival}", [], rival))
        if named:
            first = named[0]
            found.append((f"it is not {first}, it is {rival}", [first], rival))
    return [
        (in_words(words), _command(place, asked, without, put_in))
        for words, without, put_in in found
    ]


def _command(
    place: dict[str, str], asked: dict[str, list[str]], without: list[str], put_in: str
) -> str:
    barred = [*asked["without"], *without]
    effects = [*asked["with"], *([put_in] if put_in else [])]
    label = "".join(f"-without-{name}" for name in without)
    label += f"-with-{put_in}" if put_in else ""
    words = ["hystbench", "gap", place["dataset"], "--model", place["model"]]
    words += ["--out", f"{place['out'].rstrip('/')}{label}"]
    for name in barred:
        words += ["--without", name]
    for name in effects:
        words += ["--with", name]
    return shlex.join(words)


def number(value: float | None, digits: int = 3) -> Markup:
    """Print a number shortly; the page's source holds all of its digits."""
    if value is None:
        return Markup('<span class="none">none</span>')
    text = shortly(value, digits)
    if "e" in text:
        mantissa, exponent = text.split("e")
        shown = Markup("{}&thinsp;·&thinsp;10<sup>{}</sup>").format(
            mantissa, _minus(str(int(exponent)))
        )
    else:
        shown = Markup("{}").format(_minus(text))
    return Markup('<data value="{}">{}</data>').format(repr(float(value)), shown)


def size(value: float | None, ends: list[float] | None = None) -> Markup:
    """Print an RMS, with its interval; a model that runs away has none."""
    if value is None:
        return Markup("unbounded")
    if not ends:
        return number(value)
    return Markup("{} ({} to {})").format(number(value), *map(number, ends))


def with_error(value: Any, error: Any) -> Markup:
    """Print a value and its standard error, rounded to two digits of the error.

    A single value may be zero if its error is larger than itself.
    """
    if isinstance(value, str):
        return Markup("{}").format(value)
    if isinstance(value, list):
        errors = error if isinstance(error, list) else [None] * len(value)
        pairs = zip(value, errors, strict=True)
        return Markup(", ").join(_with_error(*pair) for pair in pairs)
    known = error is None or error <= abs(value)
    return _with_error(value, error) + ("" if known else " (may be zero)")


def _with_error(value: float, error: float | None) -> Markup:
    if error is None:
        return number(value)
    digits = 3
    if error > 0 and value != 0:
        size = math.floor(math.log10(abs(value))) - math.floor(math.log10(error))
        digits = min(max(size + 2, 2), 12)
    return number(value, digits) + Markup(" ± ") + number(error, 2)


def percent(share: float | None, decimals: int = 0) -> Markup:
    """Print a share in per cent."""
    if share is None:
        return number(None)
    text = f"{100 * share:.{decimals}f}"
    shown = _minus(text if float(text) else text.lstrip("-")) + NARROW + "%"
    return Markup('<data value="{}">{}</data>').format(repr(float(share)), shown)


def explained(share: Any) -> Markup:
    """Print the share that is gone: a number, a range or none."""
    values = share if isinstance(share, list) else [share]
    ends = [percent(x, 1) for x in values]
    same = ends[0].striptags() == ends[-1].striptags()
    return ends[0] if same else Markup("{} to {}").format(ends[0], ends[-1])


def sentence(text: str) -> str:
    """Write a reason as a sentence: with a capital letter and a stop."""
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def p_value(value: float) -> Markup:
    """Print a p-value; below 0.001 the exact one matters to nobody."""
    shown = f"<{NARROW}0.001" if value < 0.001 else f"{value:.2g}"
    return Markup('<data value="{}">{}</data>').format(repr(float(value)), shown)


def unit(text: str) -> str:
    """Print a unit; none for a plain number."""
    return "" if text in ("", "-", "1") else unit_text(text)


def bound(value: float | str) -> Markup:
    """Print an end of a range, which may be a word."""
    return Markup("{}").format(value) if isinstance(value, str) else number(value)


def _minus(text: str) -> str:
    return text.replace("-", "−")  # noqa: RUF001  (a minus sign, not a hyphen)

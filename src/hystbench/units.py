"""Units as files spell them: known ones, one spelling each, whether two are the same.

Messages and files keep the user's unit in letters that any program reads: ``um``. What
is shown, axes and pages, is written by :func:`hystbench.figures.style.unit_text`.
"""

import math
import re
from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from hystbench.errors import InputError, nearest, short

PREFIXES = {"n": 1e-9, "u": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}
"""SI prefixes by a thousand; ``u`` is micro."""
SYMBOLS = ("m", "s", "A", "V", "N", "T", "W", "J", "K", "C", "Hz", "Pa", "rad", "g")
"""Symbols that carry prefixes and need no library to be known."""
SIMPLE = re.compile(f"([{''.join(PREFIXES)}]?)({'|'.join(SYMBOLS)})")
"""A symbol with a prefix or without one."""
NONE = ("-", "1", "")
"""What stands for a number without a unit."""
LONGEST = 40
"""Letters of a unit."""

_MICRO = re.compile("[\u00b5\u03bc]")  # the sign, and the Greek letter
_TORQUE = re.compile(f"(?<![A-Za-z])([{''.join(PREFIXES)}]?N)([cm]?m)(?![A-Za-z])")
_EXPONENT = r"(?:\*\*|\^)\s*[-+]?(?:\d(?:\.\d)?|\(\s*[-+]?\d(?:[./]\d)?\s*\))"
_WORDS = (
    *("ampere", "amp", "volt", "newton", "meter", "metre", "millimeter", "micrometer"),
    *("second", "millisecond", "minute", "degree", "percent", "ohm", "pascal", "tesla"),
    *("millivolt", "milliampere", "kilonewton", "radian", "hertz", "kelvin", "gauss"),
)


def plain(unit: str) -> str:
    """Write a unit in its one spelling: ``um`` for ``µm`` with either letter mu."""
    return _MICRO.sub("u", unit.strip())


def sized(value: float, unit: str) -> str:
    """Print a number to three digits, with its unit if it has one."""
    return f"{value:.3g}" if unit in NONE else f"{value:.3g} {unit}"


def check_known(place: str, unit: str) -> None:
    """Refuse what is no unit.

    Parameters
    ----------
    place : str
        Where it stands, for the message.
    unit : str

    Raises
    ------
    InputError
        With the nearest unit, and how to write a number without one.
    """
    if unit.strip() in NONE or SIMPLE.fullmatch(plain(unit)):
        return
    _parsed(place, unit)


def is_known(unit: str) -> bool:
    """Tell whether a text is a unit."""
    try:
        check_known("", unit)
    except InputError:
        return False
    return True


def seconds(place: str, unit: str) -> float:
    """Give how many seconds a unit of time is.

    Raises
    ------
    InputError
        If it is no unit of time.
    """
    unit = plain(unit)
    if unit == "s":
        return 1.0
    import pint  # late: a fifth of a second, and rarely needed

    parsed = _parsed(place, unit)
    try:
        return float(pint.Quantity(1, parsed).to("s").magnitude)
    except pint.DimensionalityError:
        raise InputError(
            f"{place}: {unit!r} is no time; expected a unit of time such as s or ms"
        ) from None


def check_same_unit(
    place: str, ours: str, whose: str, theirs: str, of_model: bool = False
) -> None:
    """Refuse two units that are not the same one, in whatever spelling.

    Nothing is converted: a factor that is not one is told and refused.

    Parameters
    ----------
    place : str
        Where ``ours`` stands, for the message.
    ours, theirs : str
        The units.
    whose : str
        What has ``theirs``.
    of_model : bool, optional
        Whether ``ours`` is a model file's, which may be changed as well.

    Raises
    ------
    InputError
        If they are of different dimensions, one is no unit, or a factor lies between.
    """
    if plain(ours) == plain(theirs):
        return
    import pint  # late: a fifth of a second, and rarely needed

    where = f"{place} {ours!r}, but {whose} has {theirs!r}"
    given, wanted = _parsed(where, theirs), _parsed(where, ours)
    try:
        factor = float(pint.Quantity(1, given).to(wanted).magnitude)
    except pint.DimensionalityError as error:
        raise InputError(f"{where}: {error}; expected the same unit") from None
    except pint.OffsetUnitCalculusError:
        factor = float("nan")
    if not abs(factor - 1) <= 1e-12:
        model = f"write the model file in {theirs!r}, its numbers too, or "
        first = model if of_model else ""
        raise InputError(
            f"{where}; nothing is converted silently: {first}multiply the record's "
            f"column by {factor:g} and say {ours!r} in its dataset.yaml; if only its "
            f"header is wrong, say {ours!r} and 'meant: true' there"
        )


def prefixed(unit: str, factor: float) -> str | None:
    """Give the unit whose prefix is smaller by a power of a thousand, if there is one.

    Parameters
    ----------
    unit : str
        The unit that is said; its first symbol carries the prefix.
    factor : float
        By how much numbers look too large: 1000 makes ``mA`` of ``A``.
    """
    found = re.match(SIMPLE.pattern + r"(?![A-Za-z])", plain(unit))
    if found is None:
        return None
    prefix, symbol = found.groups()
    for name, size in PREFIXES.items():
        if abs(size * factor / PREFIXES[prefix] - 1) < 1e-6:
            return f"{name}{symbol}{plain(unit)[found.end() :]}"
    return None


def by_thousands(unit: str, ratio: float) -> str | None:
    """Give the unit in which numbers likely are that look so many times too large.

    Parameters
    ----------
    unit : str
        The unit that is said.
    ratio : float
        Above zero; the nearest power of a thousand counts.

    Returns
    -------
    str or None
        None where the ratio is nearer to another power of ten than to one of a
        thousand, or is nearest to one, or no prefix makes up for it.
    """
    power = round(math.log10(ratio))
    return prefixed(unit, 10.0**power) if power and power % 3 == 0 else None


def named_otherwise(column: str, unit: str) -> str | None:
    """Give the unit at the end of a column's name where another one is said.

    Prefixes alone are looked at: ``time_ms`` beside ``s``, ``i (mA)`` beside ``A``.
    """
    said = SIMPLE.fullmatch(plain(unit))
    last = re.search(r"[\s_/(\[]([^\W\d_]+)[)\]]?$", plain(column))
    named = SIMPLE.fullmatch(last[1]) if last else None
    if said is None or named is None or said[2] != named[2] or said[1] == named[1]:
        return None
    return named[0]


def alike(place: str, unit: str, references: Iterable[str]) -> str | None:
    """Give the one of some units that measures the same kind of thing.

    A size plays no part: ``mm`` is like ``m``. An angle is told from a plain number,
    and a torque from an energy, as a unit of force is part of it.

    Parameters
    ----------
    place : str
        Where the unit stands, for the message.
    unit : str
    references : iterable of str

    Returns
    -------
    str or None
        None where it is like none of them.

    Raises
    ------
    InputError
        If it is no unit.
    """
    references = tuple(references)
    simple = SIMPLE.fullmatch(plain(unit))
    if simple is not None and simple[2] in references:
        return simple[2]  # known without a library that takes long to load
    base, with_force = _made_of(place, unit)
    for reference in references:
        if (base, with_force) == _made_of(place, reference):
            return reference
    return None


def _made_of(place: str, unit: str) -> tuple[Any, bool]:
    """Give the base units, the radian one of them, and whether it is a torque."""
    parsed = _parsed(place, unit)
    import pint

    registry: Any = pint.application_registry
    _, base = registry.get_base_units(parsed)
    if base != registry.get_base_units("joule")[1]:
        return base, False
    parts = [name for name, _ in pint.Quantity(1, parsed).unit_items()]
    force = registry.get_dimensionality("newton")
    return base, any(registry.get_dimensionality(name) == force for name in parts)


def _parsed(place: str, unit: str) -> Any:
    """Read a unit with pint."""
    import pint  # late: a fifth of a second, and rarely needed

    # pint reads Nm as a number of metres, where files mean a torque.
    text = _TORQUE.sub(r"\1*\2", plain(unit))
    if text in NONE:
        text = ""
    registry: Any = pint.application_registry
    # A tower of exponents would be worked out for ever.
    bare = re.sub(_EXPONENT, "|", text)
    tower = re.search(r"\|\s*\||\*\*|\^|(?<!\w)[02-9]", bare)
    # Files write cm2 where pint wants cm**2; it knows mmH2O as it stands.
    spelt = re.sub(r"(?<=[^\W\d_])(?=\d)", "**", text)
    for each in () if tower or len(text) > LONGEST else dict.fromkeys((text, spelt)):
        # What pint raises for a text that is no unit has no common base.
        with suppress(Exception):
            return registry.parse_units(each)
    raise InputError(
        f"{place}: {short(unit)} is no unit; {_nearest_unit(unit)} "
        "('-' stands for a number without a unit)"
    )


def _nearest_unit(unit: str) -> str:
    """Name the unit that may be meant, or say where they are listed."""
    import pint

    said = plain(unit)
    symbols = [f"{prefix}{symbol}" for symbol in SYMBOLS for prefix in PREFIXES]
    registry = pint.application_registry
    registry.parse_units("m")  # reads its list, which it puts off until it is asked
    rare = list(registry)
    for name in (*symbols, *_WORDS, *rare):
        if name.lower() == said.lower():
            return f"did you mean {name!r}?"
    # What is spelt out is near to words, whatever symbols it shares letters with.
    for known in (_WORDS, rare) if len(said) > 3 else (symbols,):
        told = nearest(said.lower(), known)
        if told.startswith("did"):
            return told
    return "expected one such as V, mA, um or N/m"

"""What the names of columns tell: which is time, input or output, and in which unit."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from hystbench.errors import InputError
from hystbench.quantities import Quantities, quantity_of
from hystbench.units import PREFIXES, SIMPLE, is_known, plain, seconds
from hystbench.yaml_files import table_of

#: Words of a name by what it is, and units that tell an input from an output.
KNOWN: Mapping[str, Sequence[str]] = table_of(__file__)

_BRACKET = re.compile(r"^(?P<name>.*?)\s*/?\s*[\[(](?P<unit>[^\[\]()]*)[\])]\s*$")
_SLASH = re.compile(r"^(?P<name>.*?)\s+(?:/|in)\s+(?P<unit>\S+)\s*$")
_COMMA = re.compile(r"^(?P<name>.*?),\s*(?P<unit>\S+)\s*$")
ENDS = ("cm", "deg", "degC", "degF", "rpm", "bar", "psi", "Nm", "mNm", "kNm", "Ncm")
"""Units without a prefix that end a name: no word of a name is one of them."""
_OVER = re.compile(r"^(?P<name>[^/]*[^/\s])/(?P<unit>[^\s/]+)$")
SIGNS = ("%", "°", "°C", "Nm")
"""What else stands below a quantity."""
SYMBOLS = {"T": ("K", "°C", "degC"), "s": ("m", "mm", "um")}
"""Units that stand for a quantity too, and the units of that quantity."""
_SUFFIX = re.compile(r"^(?P<name>.*[^_])_(?P<unit>[^\W_]+)$")


def split_unit(name: str) -> tuple[str, str | None]:
    """Split a column's name from the unit that it ends with.

    ``Zeit [s]``, ``force (N)``, ``U / V``, ``stroke, um``, ``time_s`` and ``I/mA`` are
    known.

    Returns
    -------
    name : str
    unit : str or None
        None where it ends with none that is known.
    """
    for form in (_BRACKET, _SLASH, _COMMA):
        found = form.match(name)
        if found and is_known(found["unit"]):
            return found["name"].strip(), plain(found["unit"])
    found = _OVER.match(name)
    if found and _is_over(found["name"], plain(found["unit"])):
        return found["name"].replace("_", " ").strip(), plain(found["unit"])
    found = _SUFFIX.match(name)
    # Nothing else than letters with a prefix, or such a word, ends a name so.
    unit = found["unit"] if found else ""
    if found and (unit in ENDS or SIMPLE.fullmatch(plain(unit))):
        return found["name"].replace("_", " ").strip(), plain(found["unit"])
    return name.replace("_", " ").strip(), None


def _is_over(name: str, unit: str) -> bool:
    """Tell whether a quantity stands over its unit: ``I/mA``, but not ``N/A``.

    Over a time stands a rate as well, as in ``steps/s``, unless it is called time.
    """
    if _is_of_time(unit):
        return is_time(name, unit)
    if not _is_plain(unit):
        return False
    return not _is_plain(plain(name)) or unit in SYMBOLS.get(name, ())


def _is_plain(unit: str) -> bool:
    """Tell whether a text is a unit of one symbol."""
    return unit in (*ENDS, *SIGNS) or SIMPLE.fullmatch(unit) is not None


def _is_of_time(unit: str) -> bool:
    try:
        return seconds("", unit) > 0
    except InputError:
        return False


def is_time(name: str, unit: str | None) -> bool:
    """Tell whether a column is called time, and its unit, if it has one, is of time."""
    if not _has(name, "time") and name.strip().lower() != "x value":
        return False
    return unit is None or _is_of_time(unit)


def is_simulated(name: str) -> bool:
    """Tell whether a column is called an output of a simulator."""
    return _has(name, "simulated")


def leaning(name: str, unit: str | None) -> int:
    """Tell whether a column looks like an input (above zero) or an output (below).

    The words of its name count twice, its unit once.
    """
    words = 2 * (_has(name, "input") - _has(name, "output"))
    symbol = plain(unit or "").lstrip("".join(PREFIXES)) or plain(unit or "")
    units = (symbol in KNOWN["driven by"]) - (
        symbol in KNOWN["answered in"] or plain(unit or "") == "m"
    )
    return words + units


def choose(
    columns: Sequence[tuple[str, str | None]],
) -> tuple[int | None, int | None]:
    """Choose input and output by what names and units tell.

    Parameters
    ----------
    columns : sequence of (str, str or None)
        Name without unit, and unit.

    Returns
    -------
    tuple of (int or None, int or None)
        Places of input and output; None where they are not told.
    """
    leans = [leaning(name, unit) for name, unit in columns]
    if both_answer(columns):
        return None, None
    if force_and_motion(columns) is not None:  # they are called input and output
        first = int(np.argmax([_role(name) for name, _ in columns]))
        return first, 1 - first
    found: list[int | None] = []
    for wanted in (1, -1):
        best = max((wanted * lean for lean in leans), default=0)
        places = [k for k, lean in enumerate(leans) if wanted * lean == best > 0]
        found.append(places[0] if len(places) == 1 else None)
    one, two = found
    if len(columns) == 2:  # one that is told leaves the other
        one = 1 - two if one is None and two is not None else one
        two = 1 - one if two is None and one is not None else two
    return one, two


def both_answer(columns: Sequence[tuple[str, str | None]]) -> bool:
    """Tell whether there are two columns that look like outputs, as way and force.

    A shaker's rig has the force as its input, a damper's the way. Nothing is open where
    a force and a motion are called input or output.
    """
    if force_and_motion(columns) is not None:
        one, two = (_role(name) for name, _ in columns)
        return one == two
    return len(columns) == 2 and all(leaning(*column) < 0 for column in columns)


def force_and_motion(
    columns: Sequence[tuple[str, str | None]],
) -> tuple[int, int] | None:
    """Give the places of a force and of a motion, if two columns are that."""
    if len(columns) != 2:
        return None
    kinds = [quantity_of("", unit or "-") for _, unit in columns]
    for force, motion in ((0, 1), (1, 0)):
        pair = Quantities(kinds[force], kinds[motion])
        if pair.input == "force" and pair.causality == "force to motion":
            return force, motion
    return None


def _role(name: str) -> int:
    """Tell whether a column is called an input (above zero) or an output (below).

    What it measures is no such word.
    """
    return _has(name, "called input") - _has(name, "called output")


def _has(name: str, what: str) -> bool:
    """Tell whether a name has a word of some kind; of compounds the end counts."""
    words, known = re.findall(r"[^\W\d_]+", name.lower()), KNOWN[what]
    return any(
        word in known or any(len(end) > 3 and word.endswith(end) for end in known)
        for word in words
    )

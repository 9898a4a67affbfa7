"""What a user did wrong, said in one line."""

import difflib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


class InputError(ValueError):
    """Bad input from a user: one line that names the place and what was expected.

    The command line prints the message and exits with status 2; a traceback
    would only hide it.
    """


LONG = 80
"""Letters of what a user gave that a message repeats."""


def short(value: object) -> str:
    """Write what a user gave, shortened where it is long, in one line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= LONG else f"{text[: LONG - 3]}..."


def in_line(error: BaseException) -> str:
    """Write what somebody else's code raised, with its kind, in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())


def nearest(name: object, known: Iterable[object]) -> str:
    """End a message with the nearest valid name, or with all of them.

    Parameters
    ----------
    name : object
        What the user wrote.
    known : iterable of object
        The valid names.

    Returns
    -------
    str
        ``did you mean 'x'?``, or ``expected one of a, b, c`` where nothing is near, or
        ``expected none`` where nothing is valid.
    """
    names = [str(item) for item in known]
    # Leading zeros are what people forget: sine-40hz for sine-040hz.
    plain = {_without_leading_zeros(item): item for item in names}
    close = difflib.get_close_matches(_without_leading_zeros(str(name)), plain, n=1)
    if close:
        return f"did you mean {plain[close[0]]!r}?"
    if not names:
        return "expected none, as there is none"
    return "expected one of " + ", ".join(names)


def refuse_unknown(name: object, known: Iterable[object], told: str) -> None:
    """Refuse a name that is not one of those known.

    Parameters
    ----------
    name, known
        As for :func:`nearest`.
    told : str
        What is said of the name, before the nearest one: ``hold: 'x' is unknown``.

    Raises
    ------
    InputError
        If the name is not known.
    """
    names = tuple(known)
    if name not in names:
        raise InputError(f"{told}; {nearest(name, names)}")


@contextmanager
def placed(place: str) -> Iterator[None]:
    """Let a refusal within the block begin with a place: ``chain: block 2: ``."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{place}{error}") from None


def _without_leading_zeros(name: str) -> str:
    return re.sub(r"(?<!\d)0+(?=\d)", "", name)

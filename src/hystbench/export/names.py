"""Names that code may bear: of a model, of its channels and of its states."""

import keyword
import re
import sys

#: Keywords of C and C++ that a model may be called, and the standard headers.
C_WORDS = """
alignas alignof asm auto bool break case char class const constexpr continue default do
double else enum extern float for goto if inline int long new nullptr register restrict
return short signed sizeof static struct switch template this thread_local typedef
typeof union unsigned using virtual void volatile while
assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal
stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib
stdnoreturn string tgmath threads time uchar wchar wctype
"""
#: Windows makes no files of these names.
DEVICES = {"aux", "con", "nul", "prn"} | {
    f"{port}{number}" for port in ("com", "lpt") for number in range(1, 10)
}
#: So begin functions of C that are copied, and what stands beside a unit's sources.
OPENINGS = ("hb_", "fmi")
TAKEN = (
    {*keyword.kwlist, *C_WORDS.split(), "numpy", "hb"}
    | {name.lower() for name in sys.stdlib_module_names}
    | DEVICES
)


def identifier(name: str) -> str:
    """Turn a name into an identifier of C and of Python, and into a file's name.

    Names of modules, headers, keywords and the like get an ending: a file ``math.py``
    would stand in the way of Python's own.
    """
    word = plain(name)
    return f"{word}_model" if word in TAKEN or word.startswith(OPENINGS) else word


def one_line(text: str) -> str:
    """Make a user's text one line without control or other unprintable characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def plain(name: str) -> str:
    """Write a name in small letters, digits and underscores, no digit first."""
    word = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_") or "model"
    return f"model_{word}" if word[0].isdigit() else word

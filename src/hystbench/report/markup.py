"""The little markup of captions and verdicts as HTML."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

_MARKS = re.compile(
    r"``(?P<code>.+?)``|\*\*(?P<strong>.+?)\*\*|\*(?P<em>[^*\s][^*]*?)\*"
)


def inline(text: str) -> Markup:
    """Write a paragraph as HTML: code, strong and stressed words, the rest as it is."""
    parts = []
    last = 0
    for found in _MARKS.finditer(text):
        parts.append(escape(text[last : found.start()]))
        tag = str(found.lastgroup)
        parts.append(Markup("<{0}>{1}</{0}>").format(tag, found[tag]))
        last = found.end()
    parts.append(escape(text[last:]))
    return Markup("").join(parts)


def paragraphs(text: str) -> list[str]:
    """Split text at its blank lines; a paragraph becomes one line."""
    return [" ".join(part.split()) for part in re.split(r"\n\s*\n", text.strip())]


def plain(text: str) -> str:
    """Drop the marks of code, strong and stressed words."""
    return _MARKS.sub(lambda found: str(found[str(found.lastgroup)]), text)


def first_sentence(text: str) -> str:
    """Give the first sentence of a text, without marks."""
    first, *_ = re.split(r"\.\s(?=[A-Z])", plain(text), maxsplit=1)
    return f"{first.rstrip('.')}."

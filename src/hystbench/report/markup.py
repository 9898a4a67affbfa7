"""The little markup of captions and verdicts as HTML."""

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
    """Split text at its blank lines and before the items of a list.

    A paragraph becomes one line; an item keeps its dash.
    """
    parts = re.split(r"\n\s*\n|\n(?=- )", text.strip())
    return [" ".join(part.split()) for part in parts]


def first_sentence(text: str) -> str:
    """Give the first sentence of a text, without marks."""
    plain = _MARKS.sub(lambda found: str(found[str(found.lastgroup)]), text)
    first, *_ = re.split(r"\.\s(?=[A-Z])", plain, maxsplit=1)
    return f"{first.rstrip('.')}."


def one_micro(page: str) -> str:
    """Write micro in the page's sentences as tables and axes do: ``2 um`` as 2 µm.

    Only behind a number and a space, or a bracket: pictures have neither in their text.
    """
    return re.sub(r"(?:(?<=\d )|(?<=\())u(?=(?:m|s|g|A|V|N|T|C|rad)\b)", "µ", page)

"""Pictures that stand inside a page."""

import base64
import re
from dataclasses import dataclass
from pathlib import Path

from markupsafe import Markup

_SIZE = re.compile(r'\s(width|height)="([\d.]+)pt"')

#: A column of a journal is 3.5 inches wide, a page 7.2 (CSS pixels, 96 an inch).
COLUMN_PIXELS = 500


@dataclass(frozen=True)
class Link:
    """A file beside the page; its path is relative to the page."""

    label: str
    href: str


@dataclass(frozen=True)
class PagePicture:
    """A picture with its caption."""

    name: str
    """Name of the element, by which it can be linked."""
    source: str
    """The image itself, as a data URI."""
    alt: str
    """What it shows, for those who do not see it."""
    caption: Markup
    width: int
    height: int
    """Height in CSS pixels."""
    files: tuple[Link, ...] = ()
    """Files in which it can be had."""

    @property
    def wide(self) -> bool:
        """Whether it is as wide as a page of a journal, not as a column."""
        return self.width > COLUMN_PIXELS


def svg_source(content: bytes) -> str:
    """Give an SVG picture as a data URI."""
    return f"data:image/svg+xml;base64,{base64.b64encode(content).decode('ascii')}"


def embedded(
    path: Path, alt: str, caption: Markup, files: tuple[Link, ...] = ()
) -> PagePicture:
    """Take an SVG file of matplotlib, whose first tag tells its size, into a page."""
    content = path.read_bytes()
    tag = re.search(r"<svg[^>]*>", content[:2000].decode("utf-8", "replace"), re.S)
    size = dict(_SIZE.findall(tag[0])) if tag else {}
    return PagePicture(
        name=path.stem,
        source=svg_source(content),
        alt=alt,
        caption=caption,
        width=round(float(size["width"]) * 4 / 3),
        height=round(float(size["height"]) * 4 / 3),
        files=files,
    )

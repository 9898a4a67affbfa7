"""What a reader sees of a page at three widths, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .chromium import Chromium

#: A notebook's window, a screen, a phone.
SIZES = ((1300, 900), (1920, 1080), (390, 844))
PROBE = Path(__file__).with_name("probe.js").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Seen:
    """A page as it was seen in one window."""

    about: dict[str, Any]
    complaints: list[str]
    fetched: list[str]

    def faults(self) -> Iterator[str]:
        """Tell what is cut off, missing or complained of."""
        about = self.about
        width, height = about["width"], about["height"]
        if about["document_width"] > width:
            yield f"the document is {about['document_width']} wide in {width}"
        yield from (f"outside of the window: {name}" for name in about["outside"])
        yield from (f"cut off in its box: {name}" for name in about["clipped"])
        if about["headline"] is None or not about["headline_text"]:
            yield "no headline"
        else:
            left, top, right, bottom = about["headline"]
            inside = 0 <= left < right <= width and 0 <= top < bottom <= height
            if not inside:
                yield f"the headline is at {about['headline']} in {width} x {height}"
        for image in about["images"]:
            if not (image["natural"] and image["width"]):
                yield f"missing picture {image['name']!r}"
            if not image["alt"]:
                yield f"picture {image['name']!r} has no alternative text"
        yield from (f"the console says: {said}" for said in self.complaints)
        yield from (f"fetched from elsewhere: {url}" for url in self.fetched)


def look(
    browser: Chromium, page: Path, size: tuple[int, int], scheme: str = "light"
) -> Seen:
    """Open a page in a window and look at it."""
    browser.open(page, *size, scheme)
    about = browser.evaluate(PROBE)
    return Seen(about, browser.complaints(), browser.fetched())


def all_faults(browser: Chromium, page: Path) -> list[str]:
    """Look at a page in each window, and at its colours in a dark system."""
    found = []
    for size in SIZES:
        light = look(browser, page, size)
        found += [f"{size[0]}x{size[1]}: {fault}" for fault in light.faults()]
    dark = look(browser, page, size, "dark")
    found += [f"dark: {fault}" for fault in dark.faults()]
    for key in ("background", "ink"):
        if dark.about[key] == light.about[key]:
            found.append(f"dark: the {key} is {dark.about[key]} as in the light")
    return found

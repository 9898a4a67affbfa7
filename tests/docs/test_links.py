"""Links of the pages lead to what exists, and every page is linked."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from tests.conftest import ROOT

from .pages import NAMES, PAGES, without_code

LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
DOCS = ROOT / "docs"


def anchors(page: Path) -> set[str]:
    """Name the headings of a page as the site and repository hosts do."""
    heads = HEADING.findall(without_fences(page.read_text(encoding="utf-8")))
    words = (re.sub(r"[^\w\s-]", "", head).strip().lower() for head in heads)
    return {re.sub(r"\s+", "-", word) for word in words}


def without_fences(text: str) -> str:
    return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def links(page: Path) -> list[str]:
    text = without_code(page.read_text(encoding="utf-8"))
    return [link for link in LINK.findall(text) if "://" not in link]


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_links_lead_somewhere(page):
    lost = []
    for link in links(page):
        name, _, anchor = link.partition("#")
        place = (page.parent / name).resolve() if name else page
        if not place.exists() or (anchor and anchor not in anchors(place)):
            lost.append(link)
    assert lost == []


def test_the_first_page_leads_to_every_page():
    linked = {
        (DOCS / link.partition("#")[0]).resolve() for link in links(DOCS / "index.md")
    }
    pages = {*DOCS.rglob("*.md"), *DOCS.rglob("*.ipynb")} - {DOCS / "index.md"}
    assert sorted(pages - linked) == []


def test_the_site_lists_every_page():
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"]
    doors = [page for door in nav for pages in door.values() for page in pages]
    listed = {
        "index.md",
        *(name for page in doors if isinstance(page, dict) for name in page.values()),
    }
    pages = {page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md")}
    assert listed == pages | {"CONTRIBUTING.md"}


#: Files that a page names in code, from the folder of the repository or of the package.
NAMED = re.compile(
    r"`((?:src|tests|workflow|gap|challenge|export|kernels|commands)/[\w/.-]+)`"
)


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_files_of_the_project_that_a_page_names_are_there(page):
    if page.name == "CHANGELOG.md":
        return  # tells of what is gone
    named = NAMED.findall(page.read_text(encoding="utf-8"))
    places = (ROOT, ROOT / "src" / "hystbench")
    assert [
        name for name in named if not any((p / name).exists() for p in places)
    ] == []

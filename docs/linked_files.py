"""A hook of mkdocs: files beside docs/ that pages link to stand in the site as well.

In the repository a page links to ``../CONTRIBUTING.md``; the site has that file beside
its pages, so the link is one step shorter there.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mkdocs.structure.files import File

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

LINK = re.compile(r"(?<=\]\()[^)#:\s]+")
"""Where a link leads, without a heading; none to another host."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add each file of the repository that a page of docs/ links to."""
    docs = Path(config.docs_dir)
    for page in files.documentation_pages():
        for link in LINK.findall(page.content_string):
            name = _beside(Path(page.src_uri), link)
            if name and files.get_file_from_path(name) is None:
                root, site = str(docs.parent), config.site_dir
                files.append(File(name, root, site, config.use_directory_urls))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Let links lead to where the site has what they name."""
    here = Path(page.file.src_uri)

    def moved(found: re.Match[str]) -> str:
        link = found[0]
        if here.name == "CONTRIBUTING.md":
            return link.removeprefix("docs/")
        return link.replace("../", "", 1) if _beside(here, link) else link

    return LINK.sub(moved, markdown)


def _beside(page: Path, link: str) -> str | None:
    """Give a link's file from the repository's folder, where it is not in docs/."""
    up = len(page.parents)
    steps = "../" * up
    return link.removeprefix(steps) if link.startswith(steps) else None

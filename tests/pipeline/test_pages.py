"""README.md and docs say what the full reproduction gives today."""

from __future__ import annotations

import re
import shutil

import pytest

from hystbench.commands.docs import MAKERS
from tests.conftest import ROOT, own_config, run_hystbench

from .conftest import Workflow

NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")
#: A number with the blanks around it, which keep the columns of a table even.
FILLING = re.compile(rf" *{NUMBER.pattern} *|:?-{{3,}}:?")
SOURCE = re.compile(r"<!-- (?:from|picture) ([^\s;]+)")


def sources(page) -> list[str]:
    return SOURCE.findall(page.read_text())


def is_reproduced(source: str) -> bool:
    """Tell whether ``make reproduce`` makes a source: the contest has its own."""
    maker = next(command for start, command in MAKERS if source.startswith(start))
    return source.startswith("results/") and maker == "make reproduce"


#: Pages of which `all` makes every number that is not archived or another page's.
PAGES = [
    page
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    if all(is_reproduced(s) or s.startswith("docs/") for s in sources(page))
]


@pytest.fixture(scope="module")
def planned(tmp_path_factory) -> Workflow:
    """A folder with the project's own config, in which nothing has run."""
    workflow = Workflow(tmp_path_factory.mktemp("reproduction"))
    workflow.configure(own_config())
    return workflow


def read_by_pages() -> list[str]:
    read = (source for page in PAGES for source in sources(page))
    return [source for source in dict.fromkeys(read) if is_reproduced(source)]


@pytest.fixture(scope="module")
def reproduced(planned) -> Workflow:
    """What the pages read; that the workflow runs it, its own tests say."""
    assert planned.run_here(*read_by_pages()) > 100
    return planned


def test_nothing_but_figures_and_rdgpis_own_table_is_on_no_page(planned):
    read, every = planned.would_run(*read_by_pages()), planned.would_run()
    unread = {rule for rule, count in every.items() if count > read.get(rule, 0)}
    drawn = {rule for rule in unread if rule.startswith("draw_")}
    # The page of the results alone shows RDGPI's printed parameters.
    assert unread - drawn == {"page", "rdgpi_published"}


def test_pages_hold_the_numbers_of_the_results(reproduced):
    assert {ROOT / "README.md", ROOT / "docs" / "reproduction.md"} <= {*PAGES}
    shutil.copytree(ROOT / "docs" / "archive", reproduced.folder / "docs" / "archive")
    for source in sources(ROOT / "README.md"):
        if source.startswith("docs/"):  # a block of it is repeated
            shutil.copy(ROOT / source, reproduced.folder / source)
    copies = [reproduced.folder / page.relative_to(ROOT) for page in PAGES]
    for page, copy in zip(PAGES, copies, strict=True):
        shutil.copy(page, copy)
    done = run_hystbench("docs", *copies, cwd=reproduced.folder)
    assert done.returncode == 0, done.stderr
    for page, copy in zip(PAGES, copies, strict=True):
        written, filled = page.read_text(), copy.read_text()
        assert FILLING.sub("#", written) == FILLING.sub("#", filled), page.name
        # Optimisers end elsewhere in the last digits on another processor, and may
        # take a step more.
        for there, here in zip(
            NUMBER.findall(written), NUMBER.findall(filled), strict=True
        ):
            least = 1 if there.isdigit() and here.isdigit() else 2e-4
            near = pytest.approx(float(here), rel=0.02, abs=least)
            assert float(there) == near, page.name

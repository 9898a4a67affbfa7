"""README.md and docs say what the full reproduction gives today."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from hystbench.commands.docs import MAKERS, PICTURE
from hystbench.plants import model_files
from hystbench.twins import parts
from hystbench.twins.runs import read_twins
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


#: Places of the twins on which claims are judged here: two of the actuator's own
#: hysteresis, and each of another. All would take most of a minute.
TWINS = [0, 1, -2, -1]
#: In how many experiments a claim holds, and the range of an error: the filled page is
#: of fewer twins.
HELD = re.compile(r"gpi (\d+) of (\d+)")
RANGE = re.compile(r"equally good twins ours goes from (\S+) to ([^\s,]+)")


def read_by_pages() -> list[str]:
    """Name what is read; pictures are drawn by tests of their own."""
    read = (source for page in PAGES for source in sources(page))
    return [
        source
        for source in dict.fromkeys(read)
        if is_reproduced(source) and not source.startswith("results/figures/")
    ]


@pytest.fixture(scope="module")
def twins() -> list[str]:
    config = own_config()
    names = [config["twin"]["model"], *config["pressure"]["twins"]]
    return [file for name in names for file in model_files(name)]


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory, twins) -> Workflow:
    """What the pages read; that the workflow runs it, its own tests say."""
    config = own_config()
    config["pressure"]["twins"] = [str(Path(twins[i]).resolve()) for i in TWINS[1:]]
    # The pages show the first twin's alone.
    config["constants"]["twins"] = []
    # One of two starts ends where the best of ten does.
    config["identification"]["starts"] = 2
    config["rdgpi"]["starts"] = 2
    workflow = Workflow(tmp_path_factory.mktemp("reproduction"))
    workflow.configure(config)
    places = [i % len(twins) for i in TWINS]
    draw = parts.experiments
    with pytest.MonkeyPatch.context() as patch:
        # Each twin has the draws that it has among all.
        patch.setattr(parts, "experiments", lambda given, i: draw(given, places[i]))
        assert workflow.run_here(*read_by_pages()) > 100
    return workflow


def test_nothing_but_figures_and_rdgpis_own_table_is_on_no_page(reproduced):
    unread = {*reproduced.would_run()}
    drawn = {rule for rule in unread if rule.startswith("draw_")}
    assert len(drawn) > 10
    # The page of the results alone shows RDGPI's printed parameters.
    assert unread - drawn == {"page", "rdgpi_published"}


def same_on_some_twins(
    written: str, filled: str, families: list[str]
) -> tuple[str, str]:
    """Compare what is said of all twins with some; take it out of both texts."""
    of_each = own_config()["pressure"]["members"] + 1
    every = families.count("gpi") * of_each
    some = [families[i] for i in TWINS].count("gpi") * of_each
    for there, here in zip(HELD.findall(written), HELD.findall(filled), strict=True):
        (held, judged), (found, tried) = map(int, there), map(int, here)
        assert (judged, tried) == (every, some)
        assert found <= held <= every - (some - found)
    for there, here in zip(RANGE.findall(written), RANGE.findall(filled), strict=True):
        (low, high), (least, most) = map(float, there), map(float, here)
        assert low <= 1.02 * least <= 1.02 * most <= 1.02**2 * high
    for pattern in (HELD, RANGE):
        written, filled = pattern.sub("", written), pattern.sub("", filled)
    return written, filled


def test_pages_hold_the_numbers_of_the_results(reproduced, twins):
    assert {ROOT / "README.md", ROOT / "docs" / "reproduction.md"} <= {*PAGES}
    shutil.copytree(ROOT / "docs" / "archive", reproduced.folder / "docs" / "archive")
    for source in sources(ROOT / "README.md"):
        if source.startswith("docs/"):  # a block of it is repeated
            shutil.copy(ROOT / source, reproduced.folder / source)
    copies = [reproduced.folder / page.relative_to(ROOT) for page in PAGES]
    for page, copy in zip(PAGES, copies, strict=True):
        shutil.copy(page, copy)
        for found in PICTURE.finditer(page.read_text()):
            picture = reproduced.folder / found["source"]
            picture.parent.mkdir(exist_ok=True)
            shutil.copy(page.parent / found["copy"], picture)
    done = run_hystbench("docs", *copies, cwd=reproduced.folder)
    assert done.returncode == 0, done.stderr
    families = [twin.family for twin in read_twins(map(Path, twins))]
    for page, copy in zip(PAGES, copies, strict=True):
        texts = page.read_text(), copy.read_text()
        written, filled = same_on_some_twins(*texts, families)
        assert FILLING.sub("#", written) == FILLING.sub("#", filled), page.name
        # Optimisers end elsewhere in the last digits on another processor, and may
        # take a step more.
        for there, here in zip(
            NUMBER.findall(written), NUMBER.findall(filled), strict=True
        ):
            least = 1 if there.isdigit() and here.isdigit() else 2e-4
            near = pytest.approx(float(here), rel=0.02, abs=least)
            assert float(there) == near, page.name

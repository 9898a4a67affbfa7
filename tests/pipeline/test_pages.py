"""README.md and docs say what the full reproduction gives today."""

from __future__ import annotations

import re
import shutil

import pytest
import yaml

from tests.conftest import ROOT, run_hystbench

from .conftest import Workflow

NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")
#: A number with the blanks around it, which keep the columns of a table even.
FILLING = re.compile(rf" *{NUMBER.pattern} *|:?-{{3,}}:?")
SOURCE = re.compile(r"<!-- (?:from|picture) ([^\s;]+)")


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory) -> Workflow:
    """The project's own config, run in full."""
    workflow = Workflow(tmp_path_factory.mktemp("reproduction"))
    workflow.configure(yaml.safe_load((ROOT / "config.yaml").read_text()))
    workflow.run()
    return workflow


def test_pages_hold_the_numbers_of_the_results(reproduced):
    # Pages on `snakemake blind` and the like name results that `all` does not make.
    pages = [
        page
        for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
        if all(
            (reproduced.folder / source).is_file()
            for source in SOURCE.findall(page.read_text())
        )
    ]
    assert ROOT / "README.md" in pages
    assert ROOT / "docs" / "reproduction.md" in pages
    (reproduced.folder / "docs").mkdir()
    copies = [reproduced.folder / page.relative_to(ROOT) for page in pages]
    for page, copy in zip(pages, copies, strict=True):
        shutil.copy(page, copy)
    done = run_hystbench("docs", *copies, cwd=reproduced.folder)
    assert done.returncode == 0, done.stderr
    for page, copy in zip(pages, copies, strict=True):
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

import shutil

import pytest

from hystbench.written import ENTRIES
from tests.report.reproduction.made import make_page, make_results


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """A folder of results with its page; tests copy it before they write."""
    folder = tmp_path_factory.mktemp("results")
    make_page(folder, make_results(folder))
    return folder


@pytest.fixture
def copied(results, tmp_path):
    """Results of which a test may change the tables, as if somebody else wrote them."""
    folder = tmp_path / "results"
    shutil.copytree(results, folder)
    shutil.rmtree(folder / "compare" / ENTRIES)
    return folder

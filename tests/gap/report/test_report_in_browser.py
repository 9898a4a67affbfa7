"""The gap's page in a real browser."""

import pytest

from hystbench.gap.report.page import write_report
from tests.browser.seen import SIZES, all_faults, look
from tests.gap.report.test_report import GAP, Reader, write_folder


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return write_report(write_folder(tmp_path_factory.mktemp("page")))


def test_nothing_is_cut_off_at_any_width_in_light_or_dark(browser, page):
    assert all_faults(browser, page) == []


def test_headline_tables_and_pictures_are_there(browser, page):
    about = look(browser, page, SIZES[0]).about
    assert about["headline_text"] == "The simulator lacks resonance and creep."
    # Every picture of the file is shown, and every table has the rows of its file.
    written = Reader()
    written.feed(page.read_text(encoding="utf-8"))
    assert len(about["images"]) == written.tags.count("img") > 5
    rows = [table["rows"] for table in about["tables"]]
    assert written.tags.count("table") == len(rows)
    for count in (len(GAP["records"]), len(GAP["where"]), len(GAP["ladder"])):
        assert any(shown >= count for shown in rows)

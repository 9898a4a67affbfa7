"""The front page, against the files that it is made of."""

import json
import math
import re
from html.parser import HTMLParser
from urllib.parse import unquote

import pytest

from hystbench.errors import InputError
from hystbench.report.markup import first_sentence, inline, paragraphs
from hystbench.report.table import Body, Cell, Heading, PageTable, number
from tests.conftest import table as rows
from tests.report.reproduction.made import (
    SIGNALS,
    make_measured,
    make_page,
    make_results,
    write_rows,
)

FILTERS = ("gpo", "backlash", "volterra", "delayed")


class Reader(HTMLParser):
    """Collect what a page says, its tables' rows, links and pictures."""

    def __init__(self, path):
        super().__init__()
        self.text, self.links, self.sources, self.alts, self.tags = [], [], [], [], []
        self.rows, self.sentence = {}, ""
        self._table, self._inside = "", []
        self.feed(path.read_text(encoding="utf-8"))
        self.said = re.sub(r"\s+", " ", " ".join(self.text))

    def handle_starttag(self, tag, attrs):
        about = dict(attrs)
        self.tags.append(tag)
        self._inside.append((tag, about.get("class") or ""))
        if tag == "div" and about.get("class") == "table":
            self._table = about["id"]
            self.rows[self._table] = []
        if tag == "tr" and about.get("class") != "heading" and self._body():
            self.rows[self._table].append([])
        if tag == "td" and self._table:
            self.rows[self._table][-1].append("")
        if tag == "a":
            self.links.append(about["href"])
        if tag == "img":
            self.sources.append(about["src"])
            self.alts.append(about["alt"])

    def handle_endtag(self, tag):
        while self._inside and self._inside.pop()[0] != tag:
            pass
        if tag == "table":
            self._table = ""

    def handle_data(self, data):
        if any(tag in ("style", "script") for tag, _ in self._inside):
            return
        self.text.append(data)
        if any(tag == "p" and mark == "sentence" for tag, mark in self._inside):
            self.sentence += data
        if self._table and any(tag == "td" for tag, _ in self._inside):
            self.rows[self._table][-1][-1] += data

    def _body(self):
        return self._table and any(tag == "tbody" for tag, _ in self._inside)


@pytest.fixture(scope="module")
def page(results):
    return Reader(results / "report.html")


def test_the_verdict_counts_held_out_errors_alone(results, page):
    held = [
        cell
        for cell in rows(results / "compare" / "cells.csv")
        if cell["half"] == "held-out"
        and cell["metric"] == "mse"
        and cell["model"] in FILTERS
        and cell["status"] != "not run"
    ]
    assert {cell["signal"] for cell in held} == {"sine-060hz", "sine-120hz"}
    near = sum(
        cell["ours"] != ""
        and 0.5 <= float(cell["ours"]) / float(cell["published"]) <= 2
        for cell in held
    )
    assert f"On the 2 signals that the twin was not fitted to, {near} of 8 filter" in (
        page.sentence
    )


def test_each_sentence_of_the_verdict_is_an_item(results, page):
    said = (results / "compare" / "verdict.md").read_text(encoding="utf-8")
    items = [line[2:] for line in said.splitlines() if line.startswith("- ")]
    assert items
    assert page.tags.count("li") >= len(items)
    assert all(inline(item).striptags() in page.said for item in items)
    assert " - " not in page.said[page.said.index(items[0][:20]) :][: len(said)]


@pytest.mark.parametrize(
    ("verdicts", "told"),
    [
        (["reproduced", "not reproduced", "reproduced"], "Of 3 results of the paper "),
        (["reproduced"], "Of 1 result of the paper "),
        ([], "No result of the paper "),
    ],
)
def test_the_verdict_counts_what_stands_on_held_out_signals(copied, verdicts, told):
    summary = copied / "compare" / "summary.json"
    content = json.loads(summary.read_text())
    judged = [{"id": "any", "verdict": verdict} for verdict in verdicts]
    summary.write_text(json.dumps(content | {"claims_on_held_out": judged}))
    page = Reader(make_page(copied, figures_of(copied)))
    assert told in page.sentence
    standing = {3: "alone, 2 stand.", 1: "alone, 1 stands.", 0: "was put to the test."}
    assert page.sentence.endswith(standing[len(verdicts)])


def test_claims_are_counted_by_what_they_rest_on_held_out_first(copied):
    file = copied / "compare" / "claims.csv"
    claims = rows(file)
    bases = ("fitted", "held-out", "constrained", "built-in", "")
    verdicts = ("reproduced", "not reproduced", "refuted by the paper")
    for place, row in enumerate(claims):
        row["basis"] = bases[place % 5] if place < 12 else "built-in"
        row["verdict"] = verdicts[place % 3]
    write_rows(file, claims)
    page = Reader(make_page(copied, figures_of(copied)))
    # Rows 1, 6 and 11 are held out: their verdicts are 1, 0 and 2.
    counted = {row[0]: row[1:] for row in page.rows["claims-counted"]}
    assert counted["held-out"] == ["1", "1", "1"]
    assert next(iter(counted)) == "held-out"
    assert [row[1] for row in page.rows["claims"][:3]] == ["held-out"] * 3


def figures_of(folder):
    return sorted((folder / "figures").glob("*.svg"))


def test_every_row_of_the_files_is_on_the_page(results, page):
    for name in ("cells", "claims", "off", "audit"):
        file = rows(results / "compare" / f"{name}.csv")
        assert len(page.rows[name]) == len(file) > 0, name
    for number_ in (1, 2, 3, 4):
        file = rows(results / "compare" / "tables" / f"table-{number_}.csv")
        shown = page.rows[f"table-{number_}"]
        given = [v for row in file for k, v in row.items() if k.endswith(" ours")]
        assert sorted(given) == sorted(v for row in shown for v in row[3::2])
    evidence = {row["evidence"] for row in rows(results / "compare" / "claims.csv")}
    assert evidence <= {cell for row in page.rows["claims"] for cell in row}
    audit = {row["statement"] for row in rows(results / "compare" / "audit.csv")}
    assert audit == {row[2] for row in page.rows["audit"]}


def test_held_out_signals_come_first(page):
    assert [row[0] for row in page.rows["beside-the-paper"]] == [
        "60 Hz sine",
        "120 Hz sine",
    ]
    for name in ("cells", "off"):
        halves = [row[0] for row in page.rows[name]]
        assert halves == sorted(halves, key=lambda half: half != "held out"), name


def test_a_page_stands_alone_and_its_links_lead_to_files(results, page):
    assert page.sources
    assert all(source.startswith("data:image/") for source in page.sources)
    assert all(page.alts)
    assert not {"link", "iframe", "object"} & set(page.tags)
    files = [link for link in page.links if not link.startswith("#")]
    assert len(files) > 20
    for link in files:
        assert (results / unquote(link)).is_file(), link


def test_figures_have_the_captions_of_the_workflow(page):
    assert "The output stays while the input crosses a band of width" in page.said
    assert "The last full cycle of each record is shown" in page.said


def test_what_a_partial_run_lacks_is_said(tmp_path, page):
    assert "This is a part of the benchmark" in page.said
    assert (
        "Not drawn, as the run has not what they show: figure-04-generalized-play"
        in page.said
    )
    folder = tmp_path / "partial"
    partial = Reader(
        make_page(folder, make_results(folder, SIGNALS[:1], ("backlash", "rdgpi")))
    )
    assert partial.sentence.startswith("No filter was run on a signal that the twin")
    assert "Not run, of the models: gpo, volterra and delayed." in partial.said
    assert "No loop is drawn" in partial.said
    assert "that the twin was fitted to; no held-out signal was run" in partial.said


def test_a_measured_dataset_has_a_page_of_its_own(tmp_path):
    folder = tmp_path / "bench"
    page = Reader(make_page(folder, make_measured(folder), dataset="bench"))
    assert "b" not in page.tags  # a record may be called anything
    assert "the GPO filter has the smallest relative error on 2 of the 2" in (
        page.sentence
    )
    assert page.sentence.endswith("All 5 models stay finite on every record.")
    assert "twin" not in page.sentence
    assert len(page.rows["errors"]) == 10
    for link in page.links:
        assert link.startswith("#") or (folder / unquote(link)).is_file(), link


def test_text_of_a_file_is_text(copied):
    file = copied / "compare" / "claims.csv"
    claims = rows(file)
    claims[0]["evidence"] = "<script>alert(1)</script> & *more*"
    write_rows(file, claims)
    page = Reader(make_page(copied, figures_of(copied)))
    assert page.tags.count("script") == 1
    assert "<script>alert(1)</script> & *more*" in page.said


def test_same_input_same_page(copied):
    first = (copied / "report.html").read_bytes()
    make_page(copied, sorted(figures_of(copied)))
    assert (copied / "report.html").read_bytes() == first


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("cells.csv", "table\n1\n", r"cells\.csv: no column 'signal'"),
        ("claims.csv", None, r"claims\.csv"),
        ("verdict.md", None, r"verdict\.md"),
    ],
)
def test_a_wrong_file_is_one_line_and_the_page_stays(copied, name, text, told):
    before = (copied / "report.html").read_bytes()
    file = copied / "compare" / name
    file.unlink() if text is None else file.write_text(text)
    # The command line tells the error of a missing file by its name.
    with pytest.raises((InputError, FileNotFoundError), match=told) as caught:
        make_page(copied, figures_of(copied))
    assert "\n" not in str(caught.value)
    assert (copied / "report.html").read_bytes() == before


def test_the_little_markup_of_captions():
    assert inline("``a<b`` and *J* (Eq. 11), **no** 2 * 3 * 4") == (
        "<code>a&lt;b</code> and <em>J</em> (Eq. 11), <strong>no</strong> 2 * 3 * 4"
    )
    assert paragraphs("one\ntwo\n\nthree\n") == ["one two", "three"]
    assert first_sentence("Output *w* (Figure 3, Eqs. 1 and 2). More.") == (
        "Output w (Figure 3, Eqs. 1 and 2)."
    )


def test_a_table_knows_its_groups_choices_and_rows():
    table = PageTable(
        "t",
        "",
        [Heading("a"), Heading("x", True, "g"), Heading("y", True, "g")],
        [Body([[Cell("p"), number(1.0), number(None)]]), Body([[Cell("q")]])],
        filtered=("a",),
    )
    assert table.groups == [("", 1), ("g", 2)]
    assert table.choices == [("a", 0, ("p", "q"))]
    assert table.count == 2
    assert number(math.inf).shown == "diverged"

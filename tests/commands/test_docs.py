"""``hystbench docs`` fills pages from results, and leaves a page that lacks any."""

import pytest

from tests.conftest import run_hystbench


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "t.md").write_text("new text\n")
    (tmp_path / "t.csv").write_text("a,b,c\n1,x|y,no\n2,z,yes\n")
    (tmp_path / "p.png").write_bytes(b"picture")
    return tmp_path


def fill(folder, text):
    (folder / "page.md").write_text(text)
    result = run_hystbench("docs", "page.md", cwd=folder)
    return result, (folder / "page.md").read_text()


def test_a_block_gets_the_text_of_its_file(folder):
    text = "before\n<!-- from t.md -->\nold\n<!-- end -->\nafter\n"
    result, page = fill(folder, text)
    assert result.returncode == 0, result.stderr
    assert page == ("before\n<!-- from t.md -->\n\nnew text\n\n<!-- end -->\nafter\n")
    assert fill(folder, page)[1] == page


def test_a_csv_file_becomes_a_table_of_what_is_asked_for(folder):
    open_line = "<!-- from t.csv; columns: c, b; rows: c = no -->"
    _, page = fill(folder, f"{open_line}\n<!-- end -->\n")
    assert page == (
        f"{open_line}\n\n| c | b |\n| --- | --- |\n| no | x\\|y |\n\n<!-- end -->\n"
    )


def test_a_block_of_another_page_is_repeated(folder):
    """README tells numbers of the contest, which is not run with the rest."""
    (folder / "other.md").write_text(
        "<!-- from a.md -->\nnot this\n<!-- end -->\n"
        "<!-- from results/gone.csv; columns: a -->\n\n| a |\n\n<!-- end -->\n"
    )
    line = "<!-- from other.md; block: results/gone.csv -->"
    _, page = fill(folder, f"{line}\nold\n<!-- end -->\n")
    assert page == f"{line}\n\n| a |\n\n<!-- end -->\n"


def test_readme_repeats_what_a_page_got_in_the_same_call(folder):
    (folder / "docs").mkdir()
    block = "<!-- from {} -->\nold\n<!-- end -->\n"
    (folder / "docs" / "own.md").write_text(block.format("t.md"))
    (folder / "README.md").write_text(block.format("docs/own.md; block: t.md"))
    assert run_hystbench("docs", cwd=folder).returncode == 0
    assert "new text" in (folder / "README.md").read_text()


def test_a_picture_is_copied(folder):
    text = "<!-- picture p.png -->\n![loops](images/p.png)\n"
    assert fill(folder, text)[1] == text
    assert (folder / "images" / "p.png").read_bytes() == b"picture"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("<!-- from gone.md -->", "no file gone.md"),
        ("<!-- from t.csv; columns: aa -->", "no column 'aa'; did you mean 'a'?"),
        ("<!-- from t.csv; row: a = 1 -->", "did you mean 'rows'?"),
        ("<!-- from page.md; block: t.cvs -->", "no block 't.cvs'"),
    ],
)
def test_what_is_missing_is_told_and_the_page_kept(folder, line, expected):
    text = f"{line}\nold\n<!-- end -->\n"
    result, page = fill(folder, text)
    assert result.returncode == 2
    assert expected in result.stderr
    assert result.stderr.count("\n") == 1
    assert page == text


def test_a_page_on_records_that_are_not_shipped_is_no_failure(folder):
    """Unless it is named: then somebody wants it filled."""
    (folder / "docs").mkdir()
    block = "<!-- from {} -->\nold\n<!-- end -->\n"
    page = folder / "docs" / "devices.md"
    page.write_text(block.format("results/blind/elsewhere.csv"))
    (folder / "README.md").write_text(block.format("t.md"))
    result = run_hystbench("docs", cwd=folder)
    assert (result.returncode, result.stderr) == (0, "")
    assert "docs/devices.md: left as it is" in result.stdout
    assert "new text" in (folder / "README.md").read_text()
    named = run_hystbench("docs", "docs/devices.md", cwd=folder)
    assert named.returncode == 2
    assert "(made by 'hystbench job blind-elsewhere')" in named.stderr


def test_every_page_that_can_be_filled_is(folder):
    docs = folder / "docs"
    docs.mkdir()
    block = "<!-- from {} -->\nold\n<!-- end -->\n"
    missing = (
        ("cluster", "results/benchmarks/slurm.csv", "make test-slurm"),
        ("gone", "gone.md", "make reproduce"),
        ("speed", "results/benchmarks/reach.csv", "make bench"),
        ("blind", "results/blind/reach.csv", "snakemake blind"),
    )
    for name, source, _ in missing:
        page = block.format("t.md") + block.format(source)
        (docs / f"{name}.md").write_text(page)
    (docs / "whole.md").write_text(block.format("t.md"))
    (folder / "README.md").write_text(block.format("t.md"))
    result = run_hystbench("docs", cwd=folder)
    assert result.returncode == 2
    for page in (docs / "whole.md", folder / "README.md"):
        assert "new text" in page.read_text()
    lines = sorted(result.stderr.splitlines())
    assert lines == sorted(
        f"hystbench: docs/{name}.md: left as it is: no file {source} "
        f"(made by '{command}')"
        for name, source, command in missing
    )
    assert all("new text" not in (docs / f"{m[0]}.md").read_text() for m in missing)

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
    ],
)
def test_what_is_missing_is_told_and_the_page_kept(folder, line, expected):
    text = f"{line}\nold\n<!-- end -->\n"
    result, page = fill(folder, text)
    assert result.returncode == 2
    assert expected in result.stderr
    assert result.stderr.count("\n") == 1
    assert page == text

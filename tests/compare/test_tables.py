"""Tables and verdict: what a reader sees."""

import csv
import io

import docutils.core
import pytest

from hystbench.compare.cells import compare_cells
from hystbench.compare.comparison import Comparison
from hystbench.compare.runs import ClaimEvidence
from hystbench.compare.tables import PrintedTable, paper_table
from hystbench.compare.verdict import (
    first_result,
    sentences,
    verdict_page,
)

from .made import make_run, published_runs


def table(number, changes=None, missing=()):
    runs = published_runs(changes)
    for cell in missing:
        del runs[cell]
    return paper_table(number, compare_cells(ClaimEvidence(runs=runs)), {})


def row(number, signal, error, **options):
    frame = table(number, **options).frame
    (found,) = frame[(frame.signal == signal) & (frame.error == error)].to_dict(
        "records"
    )
    return found


def test_shapes_are_those_of_the_paper():
    # two lines a signal; signal, error and two columns a model
    shapes = [each.frame.shape for each in Comparison(ClaimEvidence()).tables]
    assert shapes == [(18, 10), (2, 10), (6, 10), (20, 6)]


def test_paper_and_ours_by_hand():
    changes = {("chirp-1-100hz", "gpo"): 0.123456}
    found = row(2, "chirp-1-100hz", "MSE (um^2)", changes=changes)
    assert found["gpo paper"] == "0.0646"
    assert found["gpo ours"] == "0.1235"
    assert found["volterra paper"] == "0.4882"


@pytest.mark.parametrize(
    ("ours", "text"),
    [(0.00012345, "0.00012"), (1e-3, "0.0010"), (12345.6, "1.235e+04"), (None, "d")],
)
def test_very_small_and_very_large_errors_keep_digits(ours, text):
    changes = {("chirp-1-100hz", "gpo"): ours}
    found = row(2, "chirp-1-100hz", "MSE (um^2)", changes=changes)
    assert found["gpo ours"] == (text if ours is not None else "diverged")


def test_marks():
    found = row(1, "sine-200hz", "RE")
    assert found["delayed paper"] == "0.0736†"
    assert found["gpo paper"] == "0.0246"
    found = row(3, "multisine-10-30-50hz", "MSE (um^2)")
    assert found["volterra paper"] == "1.6099‡"


def test_missing_run_is_told():
    cell = ("sine-200hz", "gpo")
    assert row(1, "sine-200hz", "RE", missing=[cell])["gpo ours"] == "not run"


def test_table_4_repeats_the_gpo_filter():
    found = row(4, "sine-100hz", "RE")
    assert found["rdgpi paper"] == "0.1"
    assert found["gpo paper"] == "0.0141"


def test_captions_name_the_kind_of_error_and_the_twin():
    for number in (1, 2, 3, 4):
        caption = table(number).caption
        assert "one-step a priori" in caption.lower()
        assert "twin, a simulation" in caption
    assert "rdgpi: errors of a free-run simulation" in table(4).caption


def test_csv_has_the_same_cells_and_the_caption():
    made = table(1)
    rows = list(csv.DictReader(io.StringIO(made.csv())))
    assert len(rows) == 18
    assert rows[0]["gpo paper"] == "0.0094"
    assert "one-step" in rows[0]["note"].lower()


def test_markdown_keeps_digits():
    text = table(1).markdown()
    assert "0.2880" in text
    assert "0.0736†" in text
    assert "‡ one of several" in text


def test_latex_marks_and_escapes():
    import pandas as pd

    made = PrintedTable(
        "t_1", "a_b 5 % um^2", "", pd.DataFrame({"x_y": ["1†"], "z": ["2^3"]})
    )
    text = made.latex()
    assert r"\caption{a\_b 5 \% \textmu m$^2$}" in text
    assert r"x\_y & z \\" in text
    assert r"1$^\dagger$ & 2\textasciicircum{}3 \\" in text


def test_tables_are_written_in_three_formats(tmp_path):
    table(3).write(tmp_path)
    written = [tmp_path / f"table-3.{suffix}" for suffix in ("csv", "md", "tex")]
    assert all(p.read_text(encoding="utf-8") for p in written)


@pytest.fixture
def comparison():
    return Comparison(ClaimEvidence(runs=published_runs()))


def test_verdict_takes_its_numbers_from_the_summary(comparison):
    summary = comparison.summary | {"within_factor_2": 0.25}
    text = " ".join(sentences(summary))
    assert "25 % are within a factor of 2" in text
    assert "78 of 78 pairs" in text
    assert "typical MSE is off by a factor of 1.00" in text


def test_verdict_without_runs_says_so():
    summary = Comparison(ClaimEvidence()).summary
    assert "No filter was run" in sentences(summary)[0]


def test_verdict_where_most_diverged_says_so(comparison):
    text = sentences(comparison.summary | {"median_abs_log10_ratio": None})[0]
    assert "the typical run diverged" in text


def test_verdict_never_mixes_calibrated_and_held_out():
    held_out = ("sine-060hz", "chirp-1-100hz")
    summary = Comparison(ClaimEvidence(runs=published_runs()), held_out).summary
    changed = summary | {
        "calibrated": summary["calibrated"] | {"within_factor_2": 0.5},
        "held_out": summary["held_out"] | {"within_factor_2": 0.125},
        "within_factor_2": 0.375,
    }
    text = " ".join(sentences(changed))
    held, fitted = (
        "Of the 8 filter errors (MSE) of the held-out signals, 12 % are within",
        "Of the 44 errors to which the twin is fitted, 50 % are within",
    )
    assert text.startswith(held)
    assert fitted in text
    assert "38 %" not in text
    # 6 pairs of filters under each signal.
    assert "12 of 12 pairs" in text
    assert "66 of 66 pairs" in text
    assert "78" not in text


def test_the_first_result_has_numbers_and_links():
    held_out = ("sine-060hz", "chirp-1-100hz")
    found = Comparison(
        ClaimEvidence(runs=published_runs({("sine-060hz", "gpo"): 1.0})), held_out
    )
    usual = {
        "constant_tap": 0.0,
        "zero_error_A": -6e-3,
        "gpo_first": 13,
        "signals": 13,
        "pairs_held_out": (26, 30),
        "pairs_calibrated": (45, 48),
    }
    changed = {"gpo_first": 10, "pairs_held_out": (22, 30)}
    tap = usual | changed | {"constant_tap": 1.0}
    summary = found.summary | {
        "eq19": {
            "edges": 52,
            "inside": 3,
            "example": {"signal": "s", "model": "gpo", "edge": 2.2, "bound": 3.46},
        },
        "constant_tap": {
            "without": usual,
            "with": [usual | {"constant_tap": 0.1}, tap],
            "zero_errors": [usual, usual | {"zero_error_A": 7e-3, "gpo_first": 4}],
        },
    }  # fmt: skip
    text = first_result(summary)
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in text.splitlines()
    ]
    found = dict(rows)
    answers = {
        "within a factor of 2": "7 of 8",
        "in the paper's order": "9 of 12",
        "fail below the bound": "3 of 52",
        "the GPO filter is first": "13 of 13",
        "with a constant tap": "10 of 13",
        "a zero error of +7 mA instead of -6 mA": "4 of 13",
    }
    for words, answer in answers.items():
        (told,) = (value for key, value in found.items() if words in key)
        assert told == answer, words
    links = ("docs/reproduction.md#eq-19", "docs/pressure.md")
    assert all(f"]({link})" in text for link in links)


def test_verdict_is_valid_rst(comparison):
    document = docutils.core.publish_string(
        verdict_page(comparison.summary, "rst"),
        writer="html",
        settings_overrides={"halt_level": 2, "report_level": 2},
    ).decode()
    assert "<table" in document
    assert "median |log10(ours/paper)|" in document


def test_verdict_in_markdown_has_a_row_for_each_filter(comparison):
    text = verdict_page(comparison.summary, "pipe")
    for model in ("gpo", "backlash", "volterra", "delayed"):
        assert f"| {model} " in text
    assert "| rdgpi, our guess" in text


def test_the_small_table_keeps_the_halves_apart():
    found = Comparison(ClaimEvidence(runs=published_runs()), ("sine-060hz",))
    text = verdict_page(found.summary, "pipe")
    for half in ("held out", "calibrated"):
        assert f"| {half}: gpo" in text
        assert f"| {half}: all" in text
    assert "| gpo " not in text


def test_text_for_the_terminal(comparison):
    text = comparison.text()
    assert "sine-010hz" in text
    assert "0.0094" in text
    assert "gpo-best-anywhere" in text
    assert text.count("with ours beside it") == 4


def test_a_diverged_run_is_told_below_its_table():
    told = "diverged at sample 7, mu = 3 above 1/tr[R] = 2"
    runs = published_runs()
    first = next(iter(runs))
    runs[first] = make_run(*first, None, diverged=told)
    table = paper_table(1, compare_cells(ClaimEvidence(runs=runs)), {})
    assert f"{first[0]}, {first[1]}: {told}" in table.legend
    assert "diverged" in table.markdown()

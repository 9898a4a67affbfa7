"""The audit's findings against facts read off the paper by hand."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.published import Pair, Printed, load_errors, load_table4_gpo, load_text
from hystbench.published.discrepancies import (
    audit,
    chirp_rate,
    crossings,
    envelopes,
    frequency_list,
    gpo_dips,
    gpo_not_best,
    table4_gpo_repeats,
    table4_rows,
    units_of_sums,
    write_audit,
)
from tests.conftest import table


def test_table_4_repeats_the_gpo_column():
    assert table4_gpo_repeats(load_errors(), load_table4_gpo())


def test_a_changed_digit_of_table_4_is_seen():
    rows = load_table4_gpo()
    changed = (replace(rows[0], mse=Printed("0.0095")), *rows[1:])
    assert not table4_gpo_repeats(load_errors(), changed)
    assert next(table4_rows(load_errors(), changed)).kind == "conflict"


def test_last_row_of_table_4_is_the_random_sum():
    (label,) = [
        r for r in table4_rows(load_errors(), load_table4_gpo()) if r.kind == "label"
    ]
    assert "multisine-random-0-100hz in Table 3" in label.evidence


def test_text_and_table_1_name_different_sines():
    first, second = frequency_list(load_errors(), load_text())
    assert first.evidence == "only in the text: 1 Hz; only in Table 1: 10 Hz"
    assert second.evidence.startswith("50 Hz; Table 1 has 10, 20, 40")


def test_equal_lists_of_sines_give_no_row():
    tabled = (10.0, 20.0, 40.0, 60.0, 80.0, 100.0, 120.0, 150.0, 200.0)
    text = replace(load_text(), sine_frequencies_hz=tabled, order_sweep_hz=40.0)
    assert list(frequency_list(load_errors(), text)) == []


def test_gpo_is_beaten_at_200_hz_alone():
    (row,) = gpo_not_best(load_errors())
    assert "sine-200hz" in row.where
    assert "volterra 0.0172 < gpo 0.0221" in row.evidence


def test_gpo_dips_at_100_hz_in_mse_and_not_in_re():
    (row,) = gpo_dips(load_errors())
    assert "0.0122 at 80 Hz to 0.0119" in row.evidence
    assert "RE rises from 0.0134 to 0.0141" in row.evidence


def test_rising_errors_give_no_dip():
    pairs = tuple(
        Pair(1, f"sine-{f:03}hz", "gpo", Printed(f"0.{f:03}"), Printed(f"0.{f:03}"))
        for f in (10, 20, 40)
    )
    assert list(gpo_dips(pairs)) == []


def test_chirp_takes_two_seconds():
    # (63.4 - 1)/1.28 = 48.75, (69.7 - 1)/1.41 = 48.72; 99/48.74 = 2.03
    (row,) = chirp_rate(load_text())
    assert row.evidence == "48.75 and 48.72 Hz/s, so 1 to 100 Hz takes 2.03 s"


def test_published_envelopes_cross_on_the_working_range():
    ((start, end, excess),) = crossings(load_text().envelope, -0.632, 0.632)
    assert (start, end) == (
        pytest.approx(0.384, abs=5e-4),
        pytest.approx(0.439, abs=5e-4),
    )
    assert excess == pytest.approx(9.3e-5, abs=1e-6)
    inside = [r for r in envelopes(load_text()) if "again below" in r.evidence]
    assert "-0.6725 A" in inside[0].evidence


def test_envelopes_apart_do_not_cross():
    apart = {**load_text().envelope, "a3": 1.0}
    assert crossings(apart, -0.632, 0.632) == ()


def test_sums_in_amperes_outrun_the_sines():
    rows = list(units_of_sums(load_errors(), load_text()))
    # RMS input of the 3 sines: sqrt((0.01 + 0.04 + 0.09) / 2) = 0.26458
    assert f"{6.646 / np.sqrt(0.07):.1f} um/A" in rows[0].evidence
    assert len(rows) == 2


def test_sums_in_volts_do_not():
    text = load_text()
    amperes = {
        signal: {f: 1.264 * a for f, a in lines.items()}
        for signal, lines in text.sums.items()
    }
    assert list(units_of_sums(load_errors(), replace(text, sums=amperes))) == []


def test_coarse_digits_are_named():
    (row,) = [row for row in audit() if row.kind == "rounding"]
    assert "sine-100hz, rdgpi" in row.where


def test_audit_file_has_every_row(tmp_path):
    write_audit(tmp_path / "audit.csv")
    assert [tuple(row.values()) for row in table(tmp_path / "audit.csv")] == [
        (r.kind, r.where, r.statement, r.evidence) for r in audit()
    ]

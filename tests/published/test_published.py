"""The printed numbers as data, against values read off the paper by hand."""

from collections import Counter

import pytest

from hystbench.published import (
    FILTERS,
    Interval,
    Pair,
    Printed,
    load_errors,
    load_table4_gpo,
    load_text,
    signals,
    sine_frequency,
)


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("0.1", 0.05, 0.15),
        ("0.0106", 0.01055, 0.01065),
        ("0.2880", 0.28795, 0.28805),
        ("3", 2.5, 3.5),
    ],
)
def test_rounding_interval_is_half_a_unit_in_the_last_printed_place(text, low, high):
    assert Printed(text).interval == Interval(low, high)


def test_a_number_that_is_not_finite_has_no_rounding_interval():
    with pytest.raises(ValueError, match="finite"):
        _ = Printed("nan").interval


def test_tables_hold_62_pairs_as_counted_in_the_paper():
    pairs = load_errors()
    # Table 1: 9 sines x 4 filters; 2: 1 chirp x 4; 3: 3 sums x 4; 4: 10 of the RDGPI
    assert Counter(pair.table for pair in pairs) == {1: 36, 2: 4, 3: 12, 4: 10}
    assert len({(pair.signal, pair.model) for pair in pairs}) == 62
    assert len(signals(pairs)) == 13
    assert all((p.model in FILTERS) == (p.table != 4) for p in pairs)


def test_digits_stay_as_printed():
    by_cell = {(p.signal, p.model): p for p in load_errors()}
    assert by_cell["sine-100hz", "rdgpi"].re.text == "0.1"
    assert by_cell["sine-010hz", "delayed"].mse.text == "0.2880"
    assert by_cell["chirp-1-100hz", "volterra"].re.value == 0.0814


def test_rms_interval_by_hand():
    # 0.25 is anything in [0.245, 0.255], 0.5 anything in [0.45, 0.55]
    pair = Pair(1, "s", "gpo", Printed("0.25"), Printed("0.5"))
    assert pair.rms.low == pytest.approx(0.245**0.5 / 0.55)
    assert pair.rms.high == pytest.approx(0.255**0.5 / 0.45)


def test_text_numbers():
    text = load_text()
    assert text.envelope["a3"] == -0.6671
    assert text.chirp_resonance.frequency_hz == 69.7
    assert text.sums["multisine-10-30-50hz"] == {10: 0.1, 30: 0.2, 50: 0.3}
    assert text.sine_frequencies_hz[0] == 1.0
    assert len(load_table4_gpo()) == 10


@pytest.mark.parametrize(
    ("name", "frequency"),
    [("sine-010hz", 10.0), ("sine-200hz", 200.0), ("chirp-1-100hz", None)],
)
def test_frequency_of_a_sine_is_in_its_name(name, frequency):
    assert sine_frequency(name) == frequency

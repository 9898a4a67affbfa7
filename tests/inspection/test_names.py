"""Units and channels are read off the names of columns."""

import pytest

from hystbench.inspection.names import choose, is_time, split_unit


@pytest.mark.parametrize(
    ("name", "words", "unit"),
    [
        ("Zeit [s]", "Zeit", "s"),
        ("Spulenstrom [mA]", "Spulenstrom", "mA"),
        ("Weg [µm]", "Weg", "um"),
        ("force (N)", "force", "N"),
        ("U / V", "U", "V"),
        ("Zeit in s", "Zeit", "s"),
        ("stroke, um", "stroke", "um"),
        ("coil_current_A", "coil current", "A"),
        ("plate_degC", "plate", "degC"),
        ("shaft_rpm", "shaft", "rpm"),
        ("torque_Nm", "torque", "Nm"),
        ("shaft_mNm", "shaft", "mNm"),
        ("run_two", "run two", None),
        # DIN and ISO write a quantity over its unit.
        ("I_coil/mA", "I coil", "mA"),
        ("time/s", "time", "s"),
        ("t/ms", "t", "ms"),
        ("F/kN", "F", "kN"),
        ("T/°C", "T", "°C"),
        ("p/bar", "p", "bar"),
        ("Q/(l/min)", "Q", "l/min"),
        ("v / (m/s)", "v", "m/s"),
        # These are units themselves, rates, or words.
        ("N/A", "N/A", None),
        ("m/s", "m/s", None),
        ("l/min", "l/min", None),
        ("km/h", "km/h", None),
        ("steps/s", "steps/s", None),
        ("rev/min", "rev/min", None),
        ("in/out", "in/out", None),
        ("on/off", "on/off", None),
        ("I/O", "I/O", None),
        ("A/D", "A/D", None),
        ("and/or", "and/or", None),
        ("flow [furlongs per blink]", "flow [furlongs per blink]", None),
        ("y", "y", None),
    ],
)
def test_units_in_names(name, words, unit):
    assert split_unit(name) == (words, unit)


@pytest.mark.parametrize(
    ("columns", "expected"),
    [
        ([("current", "A"), ("stroke", "um")], (0, 1)),
        ([("Weg", "um"), ("Spulenstrom", "mA")], (1, 0)),
        ([("channel 1", "V"), ("channel 2", "um")], (0, 1)),
        ([("y", None), ("u", None)], (1, 0)),
        ([("foo", None), ("u", None)], (1, 0)),
        ([("channel 1", None), ("channel 2", None)], (None, None)),
        ([("voltage", "V"), ("current", "A"), ("stroke", "um")], (None, 2)),
        ([("pump", "V"), ("level", "V")], (0, 1)),
        ([("Weg", "mm"), ("Kraft", "N")], (None, None)),
        ([("force", "N"), ("displacement", "mm")], (None, None)),
        ([("force", "N"), ("x", None), ("y", None)], (None, None)),
        ([("angle", "deg"), ("torque", "Nm")], (None, None)),
        # Words of a role tell, whatever a column measures.
        ([("displacement command", "mm"), ("force", "N")], (0, 1)),
        ([("force response", "N"), ("stroke", "mm")], (1, 0)),
    ],
)
def test_input_and_output_by_name_and_unit(columns, expected):
    assert choose(columns) == expected


def test_time_has_a_unit_of_time_or_none():
    assert is_time("Zeit", "s")
    assert is_time("t", None)
    assert not is_time("time", "V")
    assert not is_time("current", "s")

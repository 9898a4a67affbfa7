"""Units: which are known, how they are written, which is likely meant."""

import subprocess
import sys

import pint
import pytest

from hystbench import units
from hystbench.errors import InputError
from tests.messages import message


@pytest.mark.parametrize(
    "unit",
    [
        *("A", "mA", "um", "µm", "μm", "m/s^2", "m/s2", "uC/cm2", "N.m", "N*m", "°C"),
        *("deg", "%", "1", "-", "counts", "kA/m", "1/s", "mm**2", "ohm", "Ω", "mmH2O"),
    ],
)
def test_units_that_are_known(unit):
    units.check_known("x.yaml: unit", unit)


def test_what_is_taken_as_known_without_pint_is_known_to_it():
    registry = pint.UnitRegistry()
    for prefix, size in units.PREFIXES.items():
        for symbol in units.SYMBOLS:
            factor = registry.Quantity(1, prefix + symbol).to(symbol).magnitude
            assert factor == pytest.approx(size)


@pytest.mark.parametrize(
    ("unit", "near"),
    [
        ("Volt", "'volt'"),
        ("mv", "'mV'"),
        ("UM", "'um'"),
        ("Amper", "'ampere'"),
        ("mikrometer", "'micrometer'"),
        ("m**9**9**9", "V, mA, um or N/m"),
        ("(((9**9)**9)**9)**9", "V, mA, um or N/m"),
        ("0.1 mm", "V, mA, um or N/m"),
        ("x" * 1000, "V, mA, um or N/m"),
    ],
)
def test_units_that_are_none(unit, near):
    said = message(lambda: units.check_known("x.yaml: unit", unit))
    assert said.startswith("x.yaml: unit: ")
    assert near in said


def test_both_letters_mu_are_written_as_one():
    assert {units.plain(text) for text in ("um", "µm", "μm", " um ")} == {"um"}


@pytest.mark.parametrize(
    ("unit", "factor", "likely"),
    [
        ("A", 1e3, "mA"),
        ("mA", 1e-3, "A"),
        ("um", 1e3, "nm"),
        ("m/s", 1e3, "mm/s"),
        ("A", 1e12, None),
        ("deg", 1e3, None),
        ("min", 1e3, None),
    ],
)
def test_the_prefix_that_is_likely(unit, factor, likely):
    assert units.prefixed(unit, factor) == likely


@pytest.mark.parametrize(
    ("column", "unit", "named"),
    [
        ("time_ms", "s", "ms"),
        ("time [ms]", "s", "ms"),
        ("i (mA)", "A", "mA"),
        ("displacement_µm", "mm", "um"),
        ("displacement_µm", "um", None),
        ("time_s", "s", None),
        ("acceleration_m_s2", "m/s^2", None),
        ("current", "A", None),
        ("sensor_A", "V", None),
    ],
)
def test_the_unit_in_the_name_of_a_column(column, unit, named):
    assert units.named_otherwise(column, unit) == named


@pytest.mark.parametrize("unit", ["2 um", "1e-6 m", "1/0", "3*V"])
def test_a_text_with_a_number_is_refused(unit):
    with pytest.raises(InputError, match=r"^file: .*is no unit"):
        units.check_known("file", unit)


def test_it_is_refused_by_a_process_that_asked_for_no_unit_yet():
    code = "from hystbench.units import check_known; check_known('file', '2 um')"
    told = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    ).stderr.splitlines()
    assert "is no unit" in told[-1]
    assert told[-1].startswith("hystbench.errors.InputError: file: ")

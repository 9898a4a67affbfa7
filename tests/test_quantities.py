"""What units say of a device: its quantities, and which causes the other."""

import re

import pytest

from hystbench.dataset import load_dataset
from hystbench.device_kinds import DEVICE_KINDS, causes
from hystbench.gap.effects import effects, own
from hystbench.gap.vocabulary import EVERYTHING
from hystbench.quantities import QUANTITIES, Quantities, quantity_of
from tests.messages import message
from tests.test_dataset import HEADER, TIME, U, Y, csv_text


@pytest.mark.parametrize(
    ("unit", "quantity"),
    [
        *((unit, "position") for unit in ("mm", "um", "µm", "m", "inch")),
        *((unit, "position") for unit in ("rad", "mrad", "deg", "°")),
        *((unit, "velocity") for unit in ("m/s", "mm/s", "rad/s", "deg/s", "rpm")),
        *((unit, "acceleration") for unit in ("m/s^2", "m/s2", "rad/s^2", "g_0")),
        *((unit, "force") for unit in ("N", "kN", "lbf", "kg*m/s^2")),
        *((unit, "force") for unit in ("Nm", "N*m", "N m", "mNm", "kNm", "Ncm")),
        *((unit, "voltage") for unit in ("V", "mV", "kV")),
        *((unit, "current") for unit in ("A", "mA")),
        *((unit, "temperature") for unit in ("K", "degC", "°C")),
        # A gram; whoever means gravity says g_0, or the quantity.
        ("g", "none-known"),
        *((unit, "none-known") for unit in ("uC/cm2", "J", "bar", "%", "N/m", "Hz")),
        *((unit, "none-known") for unit in ("-", "1", "nm/V", "cd", "l/min")),
    ],
)
def test_a_unit_tells_the_quantity(unit, quantity):
    assert quantity_of("input", unit) == quantity


@pytest.mark.parametrize(
    ("given", "output", "causality"),
    [
        ("force", "position", "force to motion"),
        ("voltage", "velocity", "force to motion"),
        ("current", "acceleration", "force to motion"),
        ("position", "force", "motion to force"),
        ("velocity", "force", "motion to force"),
        ("voltage", "level", "storage"),
        ("current", "temperature", "storage"),
        ("voltage", "voltage", "unknown"),
        ("force", "force", "unknown"),
        ("position", "velocity", "unknown"),
        ("none-known", "position", "unknown"),
        ("voltage", "none-known", "unknown"),
    ],
)
def test_which_causes_the_other(given, output, causality):
    assert Quantities(given, output).causality == causality


@pytest.mark.parametrize(
    ("unit", "told"),
    [
        *(("V", "level"), ("A", "force"), ("-", "position"), ("%", "level")),
        *(("mm", "level"), ("g", "acceleration"), ("N", "force")),
    ],
)
def test_a_signal_may_stand_for_any_quantity(unit, told):
    assert quantity_of("output", unit, told) == told


def dataset_with(write_dataset, change, to):
    text = HEADER.replace(change, to) + "records: [{file: r.csv}]"
    return write_dataset({"r.csv": csv_text(TIME, U, Y)}, text)


def test_a_dataset_tells_its_quantities(write_dataset):
    found = load_dataset(dataset_with(write_dataset, "", "")).quantities
    assert found == Quantities("current", "position")
    assert found.causality == "force to motion"


@pytest.mark.parametrize(
    ("column", "quantity"),
    [("level_mm", "level"), ("Level 2", "level"), ("levelled_mm", "position")],
)
def test_a_length_is_a_level_where_its_column_says_so(write_dataset, column, quantity):
    text = HEADER.replace("displacement_um", column) + "records: [{file: r.csv}]"
    file = csv_text(TIME, U, Y).replace("displacement_um", column)
    path = write_dataset({"r.csv": file}, text)
    assert load_dataset(path).quantities.output == quantity


def test_what_is_told_goes_before_the_unit(write_dataset):
    path = dataset_with(write_dataset, "unit: A}", "unit: A, quantity: force}")
    assert load_dataset(path).quantities == Quantities("force", "position")


@pytest.mark.parametrize(
    ("change", "to", "said"),
    [
        (
            "unit: A}",
            "unit: A, quantity: forse}",
            "input: quantity: 'forse' is unknown; did you mean 'force'?",
        ),
        (
            "unit: um}",
            "unit: um, quantity: force}",
            "output: quantity: 'force', but its unit 'um' is one of position; "
            "expected position or level",
        ),
        (
            "name: bench",
            "name: bench\ndevice: {kind: piezoelectrc}",
            "device: kind: 'piezoelectrc' is unknown; did you mean 'piezoelectric'?",
        ),
        (
            "name: bench",
            "name: bench\ndevice: {kind: magnetorheological}",
            "electronic, mechanical; leave 'device' out where none fits",
        ),
        ("name: bench", "name: bench\ndevice: {}", "device: expected the key 'kind'"),
    ],
)
def test_what_cannot_be_is_refused_in_a_line(write_dataset, change, to, said):
    path = dataset_with(write_dataset, change, to)
    assert re.search(re.escape(said), message(lambda: load_dataset(path)))


def test_a_quantity_without_that_name_is_refused():
    said = message(lambda: quantity_of("x.yaml: input", "V", "volume"))
    assert said.startswith("x.yaml: input: quantity: 'volume'; ")
    assert "none-known" in QUANTITIES


@pytest.mark.parametrize("kind", DEVICE_KINDS)
def test_a_dataset_tells_the_kind_of_device(write_dataset, kind):
    path = dataset_with(write_dataset, "name: b", f"device: {{kind: {kind}}}\nname: b")
    assert load_dataset(path).device_kind == kind


def test_a_dataset_need_not_tell_the_kind(write_dataset):
    assert load_dataset(dataset_with(write_dataset, "", "")).device_kind is None


def test_every_effect_has_its_causes():
    assert set(causes()) == {name for name, item in own().items() if not item.causes}
    for name, rows in causes().items():
        assert effects()[name].causes_in(None) == tuple(rows)
        for kinds in rows.values():
            assert set(kinds) <= set(DEVICE_KINDS)


def impossible_in(kind):
    return EVERYTHING.in_device(kind).impossible


def test_what_nothing_causes_cannot_be_there():
    forces = {"drag", "gravity", "hysteretic-force", "slider-with-gap", "stop"}
    stores = {"outflow", "overflow"}
    assert (
        set(impossible_in("electronic")) == {"friction", "backlash"} | forces | stores
    )
    assert {"friction", "resonance"} < set(impossible_in("thermal"))
    assert impossible_in(None) == ()


def test_a_ceramic_has_no_eddy_currents():
    said = " ".join(effects()["eddy-diffusion"].causes_in("piezoelectric"))
    assert "polarization" in said
    assert "eddy" not in said

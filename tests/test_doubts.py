"""What is hardly meant: refused or warned of, until dataset.yaml says that it is."""

import numpy as np
import pytest
import yaml

from hystbench.copies import Written, common_piece
from hystbench.dataset import load_dataset
from hystbench.doubts import doubts
from hystbench.gap.records.evidence import load_evidence
from tests.gap.made import record, sine, write_folder
from tests.messages import message

RNG = np.random.default_rng(3)
U = sine(3.0, count=1200) + 0.5 * sine(7.1, count=1200)
Y = 5 * U + 0.02 * RNG.standard_normal(1200)
OTHER = sine(4.0, count=1200)
OTHER_Y = 5 * OTHER + 0.02 * RNG.standard_normal(1200)


def shared(one, two):
    return common_piece(Written.of(one), Written.of(two))


def printed(values, form):
    """Numbers as a file with fewer digits holds them."""
    return np.array([float(form % value) for value in values])


def rows(part):
    return record(U[part], Y[part], name="copy", use="hold-out")


COPIES = {
    "all": rows(slice(None)),
    "a piece": rows(slice(400, 700)),
    "shifted": record(np.roll(U, 500), np.roll(Y, 500)),
    "shifted, and longer": record(
        np.concatenate([OTHER[:300], U]), np.concatenate([OTHER_Y[:300], Y])
    ),
    "four digits": record(printed(U, "%.4g"), printed(Y, "%.4g")),
    "two decimals": record(printed(U, "%.2f"), printed(Y, "%.2f")),
    "every third sample": record(U[1::3], Y[1::3], dt=0.003),
    "another clock": record(U, Y, dt=0.5),
}
NO_COPIES = {
    "another input": record(OTHER, OTHER_Y),
    "measured again": record(U, 5 * U + 0.02 * RNG.standard_normal(1200)),
    "measured again, coarsely": record(
        U, np.round(5 * U + 0.02 * RNG.standard_normal(1200), 2)
    ),
    "another gain": record(U, 1.001 * Y),
    "less than half": record(
        np.concatenate([U[:500], OTHER[:700]]), np.concatenate([Y[:500], OTHER_Y[:700]])
    ),
    "a rest before": record(np.append(np.zeros(500), U), np.append(np.zeros(500), U)),
}


@pytest.mark.parametrize("name", COPIES)
def test_a_copy_is_seen_from_either_side(name):
    plain = record(U, Y)
    assert shared(plain, COPIES[name]) is not None
    assert shared(COPIES[name], plain) is not None


@pytest.mark.parametrize("name", NO_COPIES)
def test_what_is_no_copy(name):
    plain = record(np.append(np.zeros(400), U), np.append(np.zeros(400), Y))
    assert shared(plain, NO_COPIES[name]) is None
    assert shared(NO_COPIES[name], plain) is None


def test_a_copied_piece_is_told_with_its_place():
    piece = shared(record(U, Y), rows(slice(400, 700)))
    assert piece == (300, 400, 0, True)
    piece = shared(rows(slice(400, 700)), record(U, Y))
    assert piece == (300, 0, 400, True)


def fit(name="a", u=OTHER, y=OTHER_Y, **about):
    return record(u, y, name=name, **about)


def held_out(name="h", u=U, y=Y):
    return record(u, y, name=name, use="hold-out")


def warned(folder):
    return load_evidence(folder).warnings


def say(folder, **about):
    """Write what dataset.yaml says of records, or of itself, in another way."""
    file = folder / "dataset.yaml"
    content = yaml.safe_load(file.read_text())
    for key, value in about.items():
        if key in ("time", "input", "output"):
            content[key] |= value
        else:
            for entry in content["records"]:
                if entry["file"] == f"{key}.csv":
                    entry |= value
    file.write_text(yaml.safe_dump(content))
    return folder


def test_sound_records_are_not_warned_of(tmp_path):
    assert warned(write_folder(tmp_path / "d", [fit(), held_out()])) == ()


@pytest.mark.parametrize("part", [slice(None), slice(300, 900)])
def test_a_copy_that_is_held_out_is_refused(tmp_path, part):
    made = [fit(), fit("b", U, Y), held_out(u=U[part], y=Y[part])]
    folder = write_folder(tmp_path / "d", made)
    said = message(lambda: load_evidence(folder))
    assert "h.csv" in said
    assert "b.csv" in said
    assert "which is to be fitted" in said
    # It is no matter of what is meant: such a record shows nothing.
    say(folder, b={"meant": ["copy"]}, h={"meant": ["copy"]})
    assert message(lambda: load_evidence(folder)) == said


@pytest.mark.parametrize("role", ["fit", "hold-out"])
def test_equal_records_of_one_role_are_warned_of(tmp_path, role):
    made = [fit(), fit("b"), held_out()]
    if role == "hold-out":
        made = [fit(), held_out(), held_out("b")]
    folder = write_folder(tmp_path / "d", made)
    (line,) = warned(folder)
    assert "equals b.csv" in line
    assert "meant: [copy]" in line
    assert "\n" not in line
    assert warned(say(folder, b={"meant": ["copy"]})) == ()


def staircase(size=1.0):
    levels = size * np.random.default_rng(2).standard_normal(len(U) // 20)
    return np.repeat(levels, 20)


def test_an_input_that_a_converter_held_is_warned_of_unless_it_is_said(tmp_path):
    held = staircase()
    made = [fit(u=held, y=5 * held), held_out()]
    folder = write_folder(tmp_path / "d", made)
    (line,) = warned(folder)
    assert "stands still and jumps" in line
    assert "taken as band-limited" in line
    assert warned(say(folder, a={"meant": ["hold"]})) == ()
    said = write_folder(tmp_path / "e", made)
    assert warned(say(said, input={"hold": "zero-order"})) == ()


def test_a_coarse_converter_makes_no_staircase(tmp_path):
    coarse = np.round(U / np.ptp(U) * 200) * np.ptp(U) / 200
    made = [fit(u=coarse, y=5 * coarse), held_out()]
    assert warned(write_folder(tmp_path / "d", made)) == ()


@pytest.mark.parametrize(
    ("unit", "likely", "dt", "told"),
    [
        ("s", "ms", 1.0, "nothing in any record is faster than 0.0"),
        ("s", "ms", 10.0, "a record of 3.33 hours"),  # 1200 samples
        ("ms", "s", 5e-5, "a record sampled at 20 MHz"),
    ],
)
def test_times_that_no_test_has(tmp_path, unit, likely, dt, told):
    """A column of milliseconds read as seconds, or the other way round."""
    slow, slower = sine(2.5, count=1200), sine(1.7, count=1200)
    made = [
        record(slow, 5 * slow, name="a", dt=dt),
        record(slower, 4 * slower, name="h", dt=dt, use="hold-out"),
    ]
    folder = write_folder(tmp_path / "d", made)
    for file in folder.glob("*.csv"):
        file.write_text(file.read_text().replace("time_s", "t"))
    say(folder, time={"unit": unit, "column": "t"})
    (line,) = warned(folder)
    assert f"time: unit: {unit!r}" in line
    assert told in line
    assert f"write 'unit: {likely}'" in line
    assert warned(say(folder, time={"meant": True})) == ()


def test_a_tank_or_a_heated_body_may_be_slow(tmp_path):
    u = sine(2.5, count=1200)
    made = [
        record(u, 5 * u, name="a", dt=10.0),
        record(0.5 * u + 0.1 * u**2, 2 * u, name="h", dt=10.0, use="hold-out"),
    ]
    folder = write_folder(tmp_path / "d", made)
    (line,) = warned(folder)
    assert "3.33 hours" in line
    for file in folder.glob("*.csv"):
        file.write_text(file.read_text().replace("_um", "_degC"))
    output = {"name": "temperature", "unit": "degC"}
    content = yaml.safe_load((folder / "dataset.yaml").read_text())
    column = content["output"]["column"].replace("_um", "_degC")
    assert warned(say(folder, output={**output, "column": column})) == ()


@pytest.mark.parametrize(
    ("channel", "factor", "likely"),
    [("input", 1000, "mA"), ("input", 1e-3, "kA"), ("output", 1000, "nm")],
)
def test_a_record_a_thousand_times_another(tmp_path, channel, factor, likely):
    u, y = (factor if channel == each else 1 for each in ("input", "output"))
    made = [fit(), fit("b", u * OTHER * 0.6, y * OTHER_Y * 0.6), held_out()]
    folder = write_folder(tmp_path / "d", made)
    (line,) = warned(folder)
    assert "b.csv" in line
    assert f"is it in {likely}?" in line
    assert "meant: [amplitude]" in line
    assert warned(say(folder, b={"meant": ["amplitude"]})) == ()
    # `load` tells of its own record alone.
    about = load_dataset(folder)
    records = [about.read(name) for name in about.record_files]
    say(folder, b={"meant": []})
    about = load_dataset(folder)
    assert doubts(about, records, "b") == (line,)
    assert doubts(about, records, "h") == ()


def test_a_series_of_amplitudes_is_no_fault(tmp_path):
    """Ten times each from 0.01 to 100: no step of a thousand."""
    sizes = {"a": 0.01, "b": 0.1, "c": 1, "d": 10, "e": 100}
    made = [
        record(size * OTHER, size * (OTHER_Y + 0.01 * k * OTHER), name=name)
        for k, (name, size) in enumerate(sizes.items())
    ]
    assert warned(write_folder(tmp_path / "d", [*made, held_out()])) == ()


def test_a_column_that_is_named_in_another_unit(tmp_path):
    folder = write_folder(tmp_path / "d", [fit(), held_out()])
    for file in folder.glob("*.csv"):
        file.write_text(file.read_text().replace("current_A", "current_mA"))
    say(folder, input={"column": "current_mA"})
    (line,) = warned(folder)
    assert "input: unit: 'A'" in line
    assert "write 'unit: mA'" in line
    assert warned(say(folder, input={"meant": True})) == ()


@pytest.mark.parametrize("unit", ["µm", "μm"])
def test_both_letters_mu_are_one_unit_with_one_spelling(tmp_path, unit):
    folder = write_folder(tmp_path / "d", [fit(), held_out()])
    for file in folder.glob("*.csv"):
        text = file.read_text(encoding="utf-8").replace("ment_um", f"ment_{unit}")
        file.write_text(text, encoding="utf-8")
    say(folder, output={"unit": unit, "column": f"displacement_{unit}"})
    evidence = load_evidence(folder)
    assert (evidence.output.name, evidence.output.unit) == ("displacement", "um")
    assert evidence.warnings == ()


def test_a_copy_inside_one_file_is_told_by_the_rows_of_the_file(tmp_path):
    u = np.tile(RNG.standard_normal(400), 3)
    write_folder(tmp_path, [fit(), fit("run", u, 5 * u)])
    path = tmp_path / "dataset.yaml"
    about = yaml.safe_load(path.read_text())
    entry = next(each for each in about["records"] if each["file"] == "run.csv")
    about["records"].remove(entry)
    for name, rows_, use in (
        ("a-1", [1, 400], "fit"),
        ("a-2", [801, 1200], "hold-out"),
    ):
        about["records"].append({**entry, "name": name, "rows": rows_, "use": use})
    path.write_text(yaml.safe_dump(about))
    said = message(lambda: load_evidence(tmp_path))
    # The header is row 1.
    assert "400 of 400 samples, from row 802 on, equal those of run.csv" in said
    assert "from row 2 on" in said

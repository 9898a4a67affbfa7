"""Files that other programs wrote, each with the same signals (files/make.*)."""

import importlib.util
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from hystbench import libraries
from hystbench.formats import format_of, read_table
from tests.messages import message

FILES = Path(__file__).parent / "files"
K = np.arange(400)
T = K * 0.001
U = 1.5 * np.sin(2 * np.pi * 5 * T)
Y = 2 * U + 0.25 * U**2
needs_h5py = pytest.mark.skipif(
    importlib.util.find_spec("h5py") is None, reason="h5py is not installed"
)
needs_tdms = pytest.mark.skipif(
    importlib.util.find_spec("nptdms") is None, reason="nptdms is not installed"
)
needs_parquet = pytest.mark.skipif(
    not any(map(importlib.util.find_spec, ("pyarrow", "fastparquet"))),
    reason="neither pyarrow nor fastparquet is installed",
)


@pytest.mark.parametrize(
    ("name", "columns"),
    [
        ("octave-v6.mat", {"t": T, "u": U, "y": Y}),
        ("octave-v7.mat", {"t": T, "u": U, "y": Y}),
        ("octave-matrix.mat", {"data(:,1)": T, "data(:,2)": U, "data(:,3)": Y}),
        ("octave-runs.mat", {"runs(1)/u": U, "runs(2)/y": 0.5 * Y}),
        ("octave.csv", {"time_s": T, "current_A": U, "displacement_um": Y}),
        ("octave-bare.txt", {"column 1": T, "column 2": U, "column 3": Y}),
        ("german.csv", {"Zeit [s]": T, "Spulenstrom [mA]": 1000 * U, "Weg [µm]": Y}),
        ("float.wav", {"channel 1": U / 2, "channel 2": Y / 8}),
        pytest.param("octave.h5", {"t": T, "u": U, "y": Y}, marks=needs_h5py),
        pytest.param("v73.mat", {"t": T, "u": U, "y": Y}, marks=needs_h5py),
        pytest.param(
            "v73-runs.mat", {"a/i": U, "b/x": 0.5 * Y}, marks=needs_h5py
        ),
        pytest.param(
            "pytables.h5",
            {
                "slow/current": U,
                "fast/stroke": 0.5 * Y,
                "log/time_s": T,
                "log/stroke_um": Y,
            },
            marks=needs_h5py,
        ),
        pytest.param(
            "pyarrow.parquet",
            {"time_s": T, "current_A": U, "stroke_um": Y},
            marks=needs_parquet,
        ),
        pytest.param(
            "fastparquet.parquet",
            {"time_s": T, "current_A": U, "stroke_um": Y},
            marks=needs_parquet,
        ),
        pytest.param(
            "rig.tdms", {"slow/current": U, "fast/stroke": 0.5 * Y}, marks=needs_tdms
        ),
    ],
)  # fmt: skip
def test_what_another_program_wrote(name, columns):
    table = read_table(FILES / name)
    for column, values in columns.items():
        np.testing.assert_allclose(
            table.column(column).values, values, rtol=1e-12, atol=1e-15
        )


@pytest.mark.parametrize(("name", "bits"), [("int16.wav", 15), ("int24.wav", 23)])
def test_whole_numbers_of_sound_are_shares_of_full_scale(name, bits):
    table = read_table(FILES / name)
    np.testing.assert_allclose(
        table.column("channel 1").values, U / 2, atol=1.01 * 2.0**-bits
    )
    assert table.sampling_frequency(table.columns) == 1000


@pytest.mark.parametrize(
    ("name", "group", "column", "unit"),
    [
        pytest.param("pytables.h5", "slow", "current", "A", marks=needs_h5py),
        pytest.param("rig.tdms", "fast", "stroke", "um", marks=needs_tdms),
    ],
)
def test_units_and_rate_that_a_file_tells(name, group, column, unit):
    table = read_table(FILES / name)
    found = table.column(column, group)
    assert found.unit == unit
    assert table.sampling_frequency([found]) == pytest.approx(1000)


@pytest.mark.parametrize(
    "name", ["octave-v7.mat", pytest.param("v73.mat", marks=needs_h5py)]
)
def test_a_lone_number_tells_the_rate(name):
    assert read_table(FILES / name).sampling_frequency() == 1000


@needs_h5py
def test_a_file_of_matlab_itself():
    """SciPy's own tests have one; MATLAB wrote it as v7.3."""
    import scipy.io.matlab

    path = Path(scipy.io.matlab.__file__).parent / "tests/data/testhdf5_7.4_GLNX86.mat"
    if not path.is_file():
        pytest.skip("this scipy has no tests with it")
    (column,) = read_table(path).columns
    np.testing.assert_allclose(column.values, np.linspace(0, 2 * np.pi, 9), rtol=1e-12)


@needs_tdms
def test_a_file_of_labview_itself():
    """Nptdms has one for its own tests."""
    import nptdms

    path = Path(nptdms.__file__).parent / "test/data/raw1.tdms"
    if not path.is_file():
        pytest.skip("this nptdms has no tests with it")
    theirs = nptdms.TdmsFile.read(path)
    table = read_table(path)
    count = 0
    for group in theirs.groups():
        for channel in group.channels():
            ours = table.column(f"{group.name}/{channel.name}")
            np.testing.assert_array_equal(ours.values, channel[:])
            count += 1
    assert count > 0


def test_what_gcc_makes_a_program_print(tmp_path):
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    (tmp_path / "log.c").write_text(
        "#include <stdio.h>\n#include <math.h>\n"
        'int main(void) { puts("Rig 3, run 7"); puts("t\\tu\\ty\\n[s]\\t[A]\\t[um]");\n'
        "for (int k = 0; k < 400; k++) { double u = 1.5 * sin(2 * M_PI * 5 * k * .001);"
        'printf("%.17g\\t%.17g\\t%.17g\\n", k * .001, u, 2 * u + .25 * u * u); }\n'
        "return 0; }\n"
    )
    program = tmp_path / "log"
    subprocess.run(["gcc", "log.c", "-o", program, "-lm"], cwd=tmp_path, check=True)
    (tmp_path / "log.txt").write_bytes(
        subprocess.run([program], capture_output=True, check=True).stdout
    )
    table = read_table(tmp_path / "log.txt")
    assert [(c.name, c.unit) for c in table.columns] == [
        ("t", "s"),
        ("u", "A"),
        ("y", "um"),
    ]
    np.testing.assert_allclose(table.column("y").values, Y, rtol=1e-12, atol=1e-15)
    assert table.place(0) == "row 4"


TEXTS = {
    "comments": "# a\n% b\nt,u\n0,1\n1,2\n2,3\n",
    "a commented header": "# t,u\n0,1\n1,2\n2,3\n",
    "bars": "t|u\n0|1\n1|2\n2|3\n",
    "spaces": "t   u\n0   1\n1   2\n2   3\n",
    "quotes": '"t";"u"\n"0,0";"1,0"\n"1,0";"2,0"\n"2,0";"3,0"\n',
    "an oscilloscope": "Model,XY\nPoints,3\nt,u\n0,1\n1,2\n2,3\n",
    "a column of words": "t,u,say\n0,1,a\n1,2,b\n2,3,c\n",
    "cells left out at the end": "t\tu\tsay\n0\t1\tx\n1\t2\n2\t3\n",
    "separators at the end": "t;u;\n0;1;\n1;2;\n2;3;\n",
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-8-sig"])
def test_layouts_of_text(tmp_path, text, encoding):
    path = tmp_path / "a.csv"
    path.write_text(text, encoding=encoding)
    table = read_table(path)
    assert table.names == ["t", "u"]
    np.testing.assert_array_equal(table.column("t").values, [0, 1, 2])
    np.testing.assert_array_equal(table.column("u").values, [1, 2, 3])


@pytest.mark.parametrize(
    ("cell", "said"),
    [
        (
            "OVLD",
            "'OVLD' (the first of 3); expected a finite number: make such samples ",
        ),
        ("1.130,22", "'1.130,22' (the first of 3); expected a finite number, without "),
        ("-12.000.130,5", "without points between thousands"),
    ],
)
def test_a_cell_that_is_no_number_is_told_as_it_stands(tmp_path, cell, said):
    cells = [f"{k / 1000:.3f}".replace(".", ",") for k in range(40)]
    outputs = [*cells[:20], cell, cell, cell, *cells[23:]]
    rows = [f'{t};{t};"{y}"' for t, y in zip(cells, outputs, strict=True)]
    (tmp_path / "run.csv").write_text("\n".join(["t;u;y", *rows]) + "\n")
    error = message(lambda: read_table(tmp_path / "run.csv", ["t", "u", "y"]))
    assert "run.csv: row 22: column 'y' is" in error
    assert said in error


@pytest.mark.parametrize(
    ("cell", "grouped"),
    [
        ("1,130.22", True),
        ("-12,000,130", True),
        # Of a decimal comma nothing is to be taken out: 1,5 is not 15.
        ("1,5", False),
        ("1130,225", False),
        ("1,13,225", False),
    ],
)
def test_commas_between_thousands_are_told(tmp_path, cell, grouped):
    rows = [f'0.{k:03d},1.0,"{k}.5"' for k in range(10, 40)]
    rows[20] = f'0.030,1.0,"{cell}"'
    (tmp_path / "run.csv").write_text("\n".join(["t,u,y", *rows]) + "\n")
    error = message(lambda: read_table(tmp_path / "run.csv", ["t", "u", "y"]))
    assert f"row 22: column 'y' is '{cell}'; expected a finite number" in error
    assert ("without commas between thousands" in error) == grouped


def test_an_empty_cell_is_no_number_and_a_word_is_an_error(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,u\n0,1\n1,\n2,NaN\n3,4\n")
    np.testing.assert_array_equal(
        read_table(path).column("u").values, [1, np.nan, np.nan, 4]
    )
    path.write_text("t,u\n0,1\n1,off\n2,3\n3,4\n")
    assert "row 3: column 'u' is 'off'" in message(lambda: read_table(path))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.mat", b"MATLAB 5.0 MAT-file" + bytes(200)),
        ("a.mat", b"no matlab at all"),
        pytest.param("a.mat", b"MATLAB 7.3 MAT-file" + bytes(99), marks=needs_h5py),
        pytest.param("a.mat", bytes(512) + b"\x89HDF\r\n\x1a\n1", marks=needs_h5py),
        pytest.param("a.h5", b"\x89HDF\r\n\x1a\n" + bytes(50), marks=needs_h5py),
        pytest.param("a.parquet", b"PAR1" + bytes(50), marks=needs_parquet),
        pytest.param("a.tdms", b"TDSm" + bytes(50), marks=needs_tdms),
        ("a.npz", b"PK\x03\x04" + bytes(50)),
        ("a.wav", b"RIFF" + bytes(50)),
        ("a.xlsx", b"PK\x03\x04"),
        ("a.bin", bytes(range(256))),
        ("a.csv", bytes(range(256))),
        ("a.csv", b""),
        ("a.csv", b"only words\nand more\n"),
    ],
)  # fmt: skip
def test_a_damaged_file_is_one_line(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    said = message(lambda: read_table(path))
    assert said.startswith(str(path))
    assert len(said) < 400


def test_a_pickle_is_never_loaded(tmp_path):
    class Evil:
        def __reduce__(self):
            return (Path.touch, (tmp_path / "pwned",))

    path = tmp_path / "a.npz"
    np.savez(path, u=U, bad=np.array([Evil()], dtype=object))
    table = read_table(path)
    assert table.names == ["u"]
    assert "never unpickled" in table.notes[0]
    assert not (tmp_path / "pwned").exists()


def test_a_missing_library_is_told_with_what_to_install(monkeypatch):
    def missing(name):
        raise ImportError(f"No module named {name!r}")

    monkeypatch.setattr(libraries.importlib, "import_module", missing)
    said = message(lambda: libraries.library("h5py", "rig.mat", "formats"))
    assert "rig.mat: needs the package h5py" in said
    assert "pip install 'hystbench[formats]'" in said


@pytest.mark.parametrize(
    ("name", "content", "kind"),
    [
        ("a.mat", b"MATLAB 5.0 MAT-file", "matlab"),
        ("a.dat", b"TDSm", "tdms"),
        ("a.mat", b"\x89HDF\r\n\x1a\n", "matlab"),
        ("a", b"t,u\n", "text"),
    ],
)
def test_the_beginning_of_a_file_tells_its_format(tmp_path, name, content, kind):
    (tmp_path / name).write_bytes(content)
    assert format_of(tmp_path / name) == kind


def test_a_row_of_units_may_end_with_an_empty_cell(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("t,u,n\ns,V,\n0,1,2\n1,2,3\n2,3,4\n")
    assert [c.unit for c in read_table(file).columns] == ["s", "V", None]


@pytest.mark.parametrize(
    "form",
    ["2024-01-01T10:00:0{}.5Z", "2024-01-01 10:00:0{},5", "2024-01-01 10:0{}+01:00"],
)
def test_dates_and_times_in_a_text(tmp_path, form):
    file = tmp_path / "a.csv"
    cells = [form.format(k) for k in range(4)]
    cells[2] = ""
    file.write_text("when;u;y\n" + "".join(f"{c};1;2\n" for c in cells))
    step = 60 if "+" in form else 1
    for wanted in (None, ["when", "u"]):
        column = read_table(file, wanted).column("when")
        assert column.unit == "s"
        np.testing.assert_allclose(column.values, [0, step, np.nan, 3 * step])


def test_a_date_that_is_none_is_one_line(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("t,u,y\n" + "2024-02-31 10:00:00,1,2\n" * 3)
    said = message(lambda: read_table(file, ["t", "u"]))
    assert "row 2: column 't' is '2024-02-31 10:00:00'" in said


@needs_h5py
def test_a_cell_array_that_holds_itself_is_read_once(tmp_path, monkeypatch):
    import h5py

    from hystbench.formats import matlab

    file = tmp_path / "a.mat"
    with h5py.File(file, "w", userblock_size=512) as content:
        content["#refs#/u"] = U
        content["c"] = np.empty((4, 1), dtype=h5py.ref_dtype)
        own = content["c"].ref
        content["c"][:, 0] = [own, own, own, content["#refs#/u"].ref]
    calls = []
    inside = matlab._inside_73
    monkeypatch.setattr(
        matlab, "_inside_73", lambda *given: calls.append(given) or inside(*given)
    )
    table = read_table(file)
    np.testing.assert_array_equal(table.column("c(4)").values, U)
    assert len(table.columns) == 1
    assert len(calls) == 5  # the cell array and its four references


@needs_tdms
def test_a_file_that_ends_too_early_is_noted_and_nothing_printed(tmp_path, capfd):
    whole = (FILES / "rig.tdms").read_bytes()
    cut = tmp_path / "cut.tdms"
    cut.write_bytes(whole[: len(whole) * 3 // 4])
    table = read_table(cut)
    assert any("less data than expected" in note for note in table.notes)
    assert capfd.readouterr() == ("", "")

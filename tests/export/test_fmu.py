"""A model as a unit of FMI 2.0 and of 3.0: accepted by FMPy, built and run."""

import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.export.code import fmu_files, write_fmu
from hystbench.export.described import describe
from hystbench.model import Model, load_model
from tests.conftest import run_hystbench

from .test_models import (
    AUGMENTED,
    BEHIND,
    DT,
    NASTY,
    PLANTS,
    SINE,
    TIME,
    exported,
    nasty,
    needs_compiler,
)

both = pytest.mark.parametrize("fmi", ["2", "3"], ids="fmi{}".format)

#: Plays that a record has passed, and forces in balance with the first sample.
SETTLED = """
name: settled
input: {name: current, unit: A}
output: {name: displacement, unit: um}
chain:
- gpi:
    envelope: {a0: 1.3, a1: 0.36, a2: 0.6, a3: -0.67, a4: 0.32, a5: 1.2, a6: 0.11,
      a7: -0.025}
    thresholds: [0.0, 0.05, 0.1]
    weights: [1.0, 0.5, 0.25]
    start: settled
- mechanism: {mass: 0.002, damping: 0.2, stiffness: 100.0, bias: 30.0, start: settled}
- stiffness: {quadratic: 0.0, cubic: 1000.0}
- friction-force: {coulomb: 1.0, presliding_distance: 0.001}
"""


def parsed(text):
    return ElementTree.fromstring(text)  # noqa: S314 - our own


@pytest.fixture(scope="module")
def augmented(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("gap") / "model.yaml"
    path.write_text(AUGMENTED)
    return path


def built(fmpy, file, folder):
    """Check a unit as FMPy does, also how it is to be built, and build it."""
    from fmpy.build import build_platform_binary
    from fmpy.validation import validate_fmu
    from lxml import etree

    assert validate_fmu(str(file)) == []
    unpacked, room = folder / "unpacked", folder / "built"
    room.mkdir(parents=True)
    with zipfile.ZipFile(file) as archive:
        archive.extractall(unpacked)
    schemas = Path(fmpy.__file__).parent / "schema" / "fmi3"
    schema = etree.XMLSchema(etree.parse(schemas / "fmi3BuildDescription.xsd"))
    schema.assertValid(etree.parse(unpacked / "sources" / "buildDescription.xml"))
    build_platform_binary(unpacked, build_dir=room)
    return unpacked


def seen(fmpy, folder, u):
    """Give what an importer sees: the output of a step at its end."""
    given = np.array(
        list(zip(TIME, u, strict=True)), [("time", float), ("current", float)]
    )
    found = fmpy.simulate_fmu(
        str(folder),
        stop_time=TIME[-1],
        output_interval=DT,
        input=given,
        output=["displacement"],
    )
    assert len(found) == len(TIME)
    return found["displacement"][1:]


@pytest.mark.parametrize(("fmi", "late"), [("2", 1), ("3", 0)])
def test_the_fmu_is_accepted_and_fmpy_runs_it(fmi, late, augmented, tmp_path, fmpy):
    exported(tmp_path, augmented, "fmu", "--fmi", fmi, "--delay", late)
    file = tmp_path / "fmu" / "gpi_of_the_slow_loop_augmented.fmu"
    y = seen(fmpy, built(fmpy, file, tmp_path), SINE)
    wanted = load_model(augmented).simulate(SINE, DT)
    off = y[late:] - wanted[: -1 - late]
    assert np.abs(off)[6:].max() <= BEHIND * np.ptp(wanted)


@both
def test_a_unit_starts_as_the_record_that_it_was_exported_with(fmi, tmp_path, fmpy):
    file, record = tmp_path / "model.yaml", tmp_path / "record.csv"
    file.write_text(SETTLED)
    u = 0.2 + SINE
    rows = np.column_stack([TIME, u])
    np.savetxt(record, rows, "%.17g", ",", header="time_s,current_A", comments="")
    exported(tmp_path, file, "fmu", "--fmi", fmi, "--past", record)
    folder = built(fmpy, tmp_path / "fmu" / "settled.fmu", tmp_path)
    wanted = load_model(file).simulate(u, DT)
    y = seen(fmpy, folder, u)
    assert np.abs(y - wanted[:-1]).max() <= 1e-9 * np.ptp(wanted)


class Unit:
    """An instance of a unit that FMPy made, called alike in both versions."""

    def __init__(self, fmpy, folder) -> None:
        from fmpy.simulation import instantiate_fmu

        about = fmpy.read_model_description(folder)
        self.raw = instantiate_fmu(folder, about, "CoSimulation")
        is_2 = about.fmiVersion == "2.0"
        self.get = self.raw.getReal if is_2 else self.raw.getFloat64
        self.set = self.raw.setReal if is_2 else self.raw.setFloat64
        self.kept = self.raw.getFMUstate if is_2 else self.raw.getFMUState
        self.back = self.raw.setFMUstate if is_2 else self.raw.setFMUState
        self.free = self.raw.freeFMUstate if is_2 else self.raw.freeFMUState
        self.other_types = [
            (getattr(self.raw, f"get{name}"), getattr(self.raw, f"set{name}"))
            for name in ("Integer" if is_2 else "Int32", "Boolean", "String")
        ]
        self.is_2 = is_2
        self.begin()

    def begin(self, time=0.0) -> None:
        if self.is_2:
            self.raw.setupExperiment(startTime=time)
            self.raw.enterInitializationMode()
        else:
            self.raw.enterInitializationMode(startTime=time)
        self.raw.exitInitializationMode()
        self.time = time

    def step(self, u) -> float:
        self.set([1], [u])
        self.raw.doStep(self.time, DT)
        self.time += DT
        return self.get([2])[0]

    def run(self, inputs) -> list[float]:
        return [self.step(u) for u in inputs]


@pytest.fixture(scope="module", params=("2", "3"), ids="fmi{}".format)
def units(request, tmp_path_factory, fmpy):
    """Give what makes instances of a unit, and the output that the simulation has."""
    folder = tmp_path_factory.mktemp("units")
    model = load_model(PLANTS / "gma.yaml")
    write_fmu(describe(model, Sampling(DT)), folder / "gma.fmu", request.param)
    unpacked = built(fmpy, folder / "gma.fmu", folder)
    return lambda: Unit(fmpy, unpacked), model.simulate(SINE[:200], DT)


def near(y, wanted):
    return np.abs(np.subtract(y, wanted)).max() <= 1e-9 * np.ptp(wanted)


def test_values_are_set_and_got(units):
    unit = units[0]()
    assert unit.get([0, 1, 2]) == [0.0, 0.0, 0.0]
    unit.set([1], [0.3])
    assert unit.get([1]) == [0.3]
    assert near(unit.run(SINE[:200]), units[1])
    time, u, y = unit.get([0, 1, 2])
    assert time == pytest.approx(200 * DT)
    assert u == SINE[199]
    assert y == unit.get([2])[0] != 0.0


@pytest.mark.parametrize("reference", [0, 2, 3])
def test_only_the_input_can_be_set_and_only_variables_got(units, reference, capfd):
    unit = units[0]()
    with pytest.raises(Exception, match="failed with status 3"):
        unit.set([reference], [1.0])
    assert "only the input can be set" in capfd.readouterr().out
    with pytest.raises(Exception, match="failed with status 3"):
        unit.get([reference, 3])
    assert "no such variable" in capfd.readouterr().out


def test_of_other_types_there_is_no_variable(units, capfd):
    for get, put in units[0]().other_types:
        assert list(get([])) == []
        put([], [])
        with pytest.raises(Exception, match="failed with status 3"):
            get([1])
        assert ": all variables are of " in capfd.readouterr().out


def test_instances_know_nothing_of_each_other(units):
    first, second = units[0](), units[0]()
    alone = units[0]().run(-SINE[:200])
    pairs = [(first.step(u), second.step(-u)) for u in SINE[:200]]
    assert near([y for y, _ in pairs], units[1])
    assert [y for _, y in pairs] == alone
    assert first.get([2]) != second.get([2])


def test_after_a_reset_a_unit_begins_anew_at_any_time(units):
    unit = units[0]()
    before = unit.run(SINE[:100])
    unit.raw.reset()
    assert unit.get([0, 1, 2]) == [0.0, 0.0, 0.0]
    unit.begin(7.5)
    assert unit.run(SINE[:100]) == before


def test_a_state_that_was_kept_comes_back(units):
    unit = units[0]()
    unit.run(SINE[:100])
    state, time = unit.kept(), unit.time
    after = unit.run(SINE[100:200])
    unit.back(state)
    unit.time = time
    assert unit.run(SINE[100:200]) == after
    unit.free(state)


def test_a_step_of_an_importer_may_be_several_of_the_model_or_none(units):
    """The input stands still meanwhile, as for a model that is called so often."""
    unit = units[0]()
    held = np.repeat([0.1, 0.4], 4)
    each = units[0]().run(held)
    found = []
    for k, u in enumerate([0.1, 0.4]):
        unit.set([1], [u])
        unit.raw.doStep(4 * k * DT, 3.5 * DT)
        unit.raw.doStep((4 * k + 3.5) * DT, 0.5 * DT)
        found += unit.get([2])
    assert found == [each[3], each[7]]


def test_a_unit_of_another_model_is_not_begun(units, capfd):
    unit = units[0]()
    unit.raw.guid = "another"
    with pytest.raises(Exception, match=r"[Ff]ailed to instantiate"):
        unit.raw.instantiate()
    assert "that of another model" in capfd.readouterr().out


#: FMPy's header of FMI 2.0 leaves the prefix out; that of the standard has it.
NO_PREFIX = "#define fmi2FullName(name) name"
PREFIX = """
#if defined(FMI2_FUNCTION_PREFIX)
#define joined(a, b) a##b
#define given(a, b) joined(a, b)
#define fmi2FullName(name) given(FMI2_FUNCTION_PREFIX, name)
#else
#define fmi2FullName(name) name
#endif
"""


@needs_compiler
@both
def test_sources_compile_without_a_warning_and_functions_bear_the_models_name(
    fmi, tmp_path, fmpy
):
    """But not in a shared library (FMI 2.0, 2.1.1); of FMI 3.0 alike."""
    files = fmu_files(describe(load_model(PLANTS / "gma.yaml"), Sampling(DT)), fmi)
    for name, text in files.items():
        (tmp_path / Path(name).name).write_text(text)
    for header in (Path(fmpy.__file__).parent / "c-code").glob(f"fmi{fmi}*.h"):
        text = header.read_text().replace(NO_PREFIX, PREFIX)
        (tmp_path / header.name).write_text(text)

    def compiled(*more) -> str:
        command = ["cc", "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", *more]
        return subprocess.run(
            command, cwd=tmp_path, check=True, capture_output=True, text=True
        ).stdout

    own = f"fmi{fmi}.c"
    compiled("-c", "gma.c", own)
    assert f" gma_fmi{fmi}DoStep(" in compiled("-E", own)
    library = compiled("-E", f"-DFMI{fmi}_OVERRIDE_FUNCTION_PREFIX", own)
    assert f" fmi{fmi}DoStep(" in library
    assert "gma_fmi" not in library


@both
def test_the_fmu_tells_its_units_and_what_its_steps_do_otherwise(fmi, augmented):
    files = fmu_files(describe(load_model(augmented), Sampling(DT)), fmi)
    about = files["modelDescription.xml"]
    assert f'fmiVersion="{fmi}.0"' in about
    assert 'unit="A"' in about
    assert 'unit="um"' in about
    assert "polynomial through the newest 6" in about
    assert not any("@" in text for text in files.values())


@both
def test_names_of_channels_that_clash_are_told_apart(fmi):
    mapping = load_model(PLANTS / "gma.yaml").to_mapping()
    mapping["input"]["name"] = mapping["output"]["name"] = "time & motion"
    model = Model.from_mapping(mapping, "here")
    about = fmu_files(describe(model, Sampling(DT)), fmi)["modelDescription.xml"]
    assert 'name="input time &amp; motion"' in about
    assert 'name="output time &amp; motion"' in about


@both
@pytest.mark.parametrize("text", NASTY)
def test_no_name_gets_into_the_unit(fmi, text):
    model = nasty(text)
    files = fmu_files(model, fmi)
    about = parsed(files["modelDescription.xml"])
    assert about.get("modelName") == model.title
    variables = {"2": "ScalarVariable", "3": "Float64"}[fmi]
    assert [item.get("name") for item in about.iter(variables)] == [
        "time", model.input.name, model.output.name,
    ]  # fmt: skip
    assert parsed(files["sources/buildDescription.xml"]) is not None
    assert text not in files[f"sources/fmi{fmi}.c"] + files["sources/hb_unit.h"]


def test_a_version_without_a_unit_is_one_line(tmp_path):
    done = run_hystbench(
        "export", PLANTS / "gma.yaml", "--to", "c", "--fmi", 2, "--dt", DT,
        "--out", tmp_path / "c",
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr == "hystbench: --fmi: expected it with --to fmu alone\n"
    assert not (tmp_path / "c").exists()


def test_without_a_version_the_unit_is_of_3(tmp_path):
    exported(tmp_path, PLANTS / "gma.yaml", "fmu")
    with zipfile.ZipFile(tmp_path / "fmu" / "gma.fmu") as archive:
        assert b'fmiVersion="3.0"' in archive.read("modelDescription.xml")

"""The twin and models as `hystbench gap` writes them, as C and Python."""

import ast
import importlib.util
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.export import code
from hystbench.export.described import describe, identifier
from hystbench.model import Model, load_model
from tests.conftest import ROOT, run_hystbench

from .compiled import Compiled

PLANTS = ROOT / "src" / "hystbench" / "plants"
DT = 1e-4
TIME = np.arange(2001) * DT
#: A sine of the paper after a cycle of it, and one with others beside it.
SINE = 0.632 * np.sin(2 * np.pi * 100 * TIME)
SUM = sum(0.15 * np.sin(2 * np.pi * f * TIME) for f in (5, 25, 50, 75, 100))

#: Share of the range by which code may be off behind hysteresis; docs/export.md.
BEHIND = 1e-4

#: What `hystbench gap` adds to a base, as it writes it: the dataset's hold with it.
AUGMENTED = """
name: gpi of the slow loop, augmented
input: {name: current, unit: A}
output: {name: displacement, unit: um}
free: [sensor-lag.time_constant_s]
chain:
- gpi:
    envelope: {a0: 7.65, a1: 0.24, a2: 1.53, a3: -6.93, a4: 0.32, a5: 1.18, a6: 0.11,
      a7: -0.03}
    thresholds: [0.0, 0.04, 0.08, 0.12, 0.16]
    weights: [46.2, 5.1, 6.0, 4.2, 3.1]
- rate-dependent-hysteresis: {coefficient: 0.002, exponent: 0.73, hold: band-limited,
    form: acting-field}
- eddy-diffusion: {time_constant_s: 0.0004, hold: band-limited}
- creep: {magnitudes: [0.03, 0.02], time_constants_s: [0.05, 0.5], hold: band-limited}
- sensor-lag: {time_constant_s: 0.00083, hold: band-limited}
- mains-pickup: {frequency_hz: 50.0, amplitudes: [0.05], phases: [0.4]}
"""


@pytest.fixture(scope="module")
def augmented(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("gap") / "model.yaml"
    path.write_text(AUGMENTED)
    return path


def exported(tmp_path, model, to, *more):
    done = run_hystbench(
        "export", model, "--to", to, "--dt", DT, "--out", tmp_path / to, *more
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


needs_compiler = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


@needs_compiler
def test_c_of_the_twins_is_their_simulation(tmp_path):
    files = sorted(PLANTS.glob("gma*.yaml"))
    models = {identifier(load_model(file).name): load_model(file) for file in files}
    run = Compiled(
        [describe(model, Sampling(DT)) for model in models.values()], tmp_path, "-O2"
    )
    for u in (SINE, SUM):
        for name, y in run.outputs(u).items():
            wanted = models[name].simulate(u, DT)
            assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted), name


def share_off(y, wanted):
    return np.abs(y - wanted)[6:].max() / np.ptp(wanted)


@needs_compiler
def test_behind_hysteresis_c_is_nearer_the_simulation_than_it_is_to_the_truth(
    augmented, tmp_path
):
    """Corners lie between samples, where no two curves through them are alike.

    The truth is the same model with twenty times as many samples of the same sine.
    """
    model = load_model(augmented)
    run = Compiled([describe(model, Sampling(DT))], tmp_path, "-O2")
    (y,) = run.outputs(SINE).values()
    fine = np.arange(20 * (len(TIME) - 1) + 1) * DT / 20
    truth = model.simulate(0.632 * np.sin(2 * np.pi * 100 * fine), DT / 20)[::20]
    simulated = model.simulate(SINE, DT)
    assert share_off(y, simulated) < 0.2 * share_off(simulated, truth)
    assert share_off(y, truth) < 1.2 * share_off(simulated, truth)


@needs_compiler
def test_with_two_points_c_is_the_simulation_with_straight_lines(augmented, tmp_path):
    mapping = load_model(augmented).to_mapping()
    mapping["chain"] = [
        item for item in mapping["chain"] if "rate-dependent-hysteresis" not in item
    ]
    smooth = Model.from_mapping(mapping, "here")
    for item in mapping["chain"]:
        for values in item.values():
            values.pop("hold", None)
    straight = Model.from_mapping(mapping, "here").with_hold("linear")
    run = Compiled([describe(smooth, Sampling(DT, points=2))], tmp_path)
    for u in (SINE, SUM):
        (y,) = run.outputs(u).values()
        wanted = straight.simulate(u, DT)
        assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted)


@needs_compiler
def test_the_python_module_stands_alone(augmented, tmp_path):
    told = exported(tmp_path, augmented, "python")
    assert "not from as many on either side" in told
    file = tmp_path / "python" / "gpi_of_the_slow_loop_augmented.py"
    spec = importlib.util.spec_from_file_location("exported", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    few, model = SINE[:300], module.Model()
    y, wanted = model.simulate(few), load_model(augmented).simulate(SINE, DT)
    assert np.abs(y - wanted[:300])[6:].max() <= BEHIND * np.ptp(wanted)
    code = describe(load_model(augmented), Sampling(DT))
    (by_c,) = Compiled([code], tmp_path, "-O2").outputs(few).values()
    np.testing.assert_array_equal(y, by_c)
    model.reset()
    np.testing.assert_array_equal(model.simulate(few), y)
    imported = {
        line.split()[1]
        for line in file.read_text().splitlines()
        if line.startswith(("import ", "from "))
    }
    own = {"ctypes", "os", "pathlib", "subprocess", "tempfile"}
    assert imported == own | {"numpy"}  # besides Python only NumPy


@needs_compiler
def test_c_compiles_as_cpp_would_use_it(augmented, tmp_path):
    exported(tmp_path, augmented, "c")
    name = "gpi_of_the_slow_loop_augmented"
    (tmp_path / "c" / "main.c").write_text(
        f'#include "{name}.h"\nint main(void) {{ {name}_state s; {name}_init(&s);'
        f" return {name}_step(&s, 0.0) != {name}_step(&s, 0.0) + 1.0 ? 0 : 1; }}\n"
    )
    command = ["cc", "-std=c99", "-pedantic", "-Werror", "main.c", f"{name}.c", "-lm"]
    subprocess.run([*command, "-o", "run"], cwd=tmp_path / "c", check=True)
    subprocess.run(["./run"], cwd=tmp_path / "c", check=True)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("gma", "gma"),
        ("2 Loops!", "model_2_loops"),
        ("for", "for_model"),
        ("math", "math_model"),
        ("NumPy", "numpy_model"),
        ("fmi3", "fmi3_model"),
        ("fmi2Functions", "fmi2functions_model"),
        ("stdint", "stdint_model"),
        ("switch", "switch_model"),
        ("aux", "aux_model"),
        ("hb", "hb_model"),
        ("§", "model"),
    ],
)
def test_any_name_makes_an_identifier(name, wanted):
    assert identifier(name) == wanted


#: Each would end a docstring, a comment or an attribute, or splice what follows.
NASTY = [
    """x\"\"\" + str(__import__('os').system('touch pwned')) + \"\"\"""",
    "a */ int injected = 1; /* b",
    "*//**/*/ int injected; /*/",
    "a *?" + "?/",
    "ends with \\",
    "ends with " + "?" * 3 + "/",
    'a <b a="1"> & \x01\u2028\n*/ int injected; \\N{dash} \\x',
    "word " * 14 + "twelve more \\ and more */ to come",
]


def nasty(text):
    mapping = load_model(PLANTS / "gma.yaml").to_mapping()
    mapping["name"] = text
    mapping["input"]["name"] = text
    mapping["output"]["name"] = f"{text}."
    return describe(Model.from_mapping(mapping, "here"), Sampling(DT))


@pytest.mark.parametrize("text", NASTY)
def test_no_name_gets_into_the_python_code(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    model = replace(nasty(text), name="nasty")
    tree = ast.parse(code.module(model))
    plain = ast.parse(code.module(replace(nasty("plain"), name="nasty")))
    assert [ast.dump(item) for item in tree.body[1:]] == [
        ast.dump(item) for item in plain.body[1:]
    ]
    assert " ".join(ast.get_docstring(tree).split()).startswith(model.title)
    assert code.loaded(model).step(0.1) != 0.0
    assert list(tmp_path.iterdir()) == []


@needs_compiler
def test_no_name_gets_into_the_c_code(tmp_path):
    models = [replace(nasty(text), name=f"nasty_{k}") for k, text in enumerate(NASTY)]
    for model in models:
        (tmp_path / f"{model.name}.h").write_text(code.header(model))
        assert "injected" in code.header(model) or "injected" not in model.title
    given = "\n".join(f'#include "{model.name}.h"' for model in models)
    command = ["cc", "-std=c99", "-E", "-P", "-"]
    seen = subprocess.run(
        command, cwd=tmp_path, input=given, capture_output=True, text=True, check=True
    ).stdout
    assert "injected" not in seen
    assert seen.count("_step(") == len(models)
    Compiled(models, tmp_path)


def test_a_model_called_math_lets_numpy_be(tmp_path):
    mapping = load_model(PLANTS / "gma.yaml").to_mapping() | {"name": "math"}
    file = tmp_path / "model.yaml"
    Model.from_mapping(mapping, "here").save(file)
    exported(tmp_path, file, "python")
    code = "import math_model; math_model.Model().step(0.1)"
    folder = tmp_path / "python"
    subprocess.run([sys.executable, "-c", code], cwd=folder, check=True)


def test_a_delay_of_very_many_samples_is_one_line(tmp_path):
    mapping = load_model(PLANTS / "gma.yaml").to_mapping()
    mapping["chain"] = [{"input-delay": {"delay_s": 900.0}}]
    mapping.pop("provenance")
    file = tmp_path / "late.yaml"
    Model.from_mapping(mapping, "here").save(file)
    done = run_hystbench(
        "export", file, "--to", "c", "--dt", DT, "--out", tmp_path / "c"
    )
    assert done.returncode == 2
    assert done.stderr == (
        f"hystbench: {file}: chain: block 1: input-delay: code would keep 9e+06 "
        "numbers at --dt 0.0001 s; expected at most 1000000: a shorter memory "
        "or a longer --dt\n"
    )
    told = run_hystbench(
        "export", file, "--to", "c", "--dt", 1, "--out", tmp_path / "c"
    ).stdout
    # 900 s back, the curve's sixteen samples behind that, the one now, and a count.
    assert "Its state holds 918 numbers, 7344 bytes." in told


@pytest.mark.parametrize(
    ("option", "value"), [("--dt", "nan"), ("--dt", "0"), ("--duration", "inf")]
)
def test_a_time_that_is_none_is_one_line(tmp_path, option, value):
    times = {"--dt": "1e-4", option: value}
    words = [word for pair in times.items() for word in pair]
    file = PLANTS / "gma.yaml"
    done = run_hystbench("export", file, "--to", "c", *words, "--out", tmp_path / "c")
    assert done.returncode == 2
    assert done.stderr == f"hystbench: {option}: {value} s; expected a time above 0\n"


def test_a_simulator_of_ones_own_is_one_line(tmp_path):
    mapping = load_model(PLANTS / "gma.yaml").to_mapping()
    mapping["chain"] = [{"external": {"function": "rig:displacement"}}]
    mapping.pop("provenance")
    file = tmp_path / "rig.yaml"
    Model.from_mapping(mapping, "here").save(file)
    done = run_hystbench(
        "export", file, "--to", "c", "--dt", DT, "--out", tmp_path / "c"
    )
    assert done.returncode == 2
    assert done.stderr == (
        f"hystbench: {file}: chain: block 1: external: a simulator of somebody's own "
        "cannot be turned into code; expected --part before or --part behind: it runs "
        "between the two\n"
    )
    assert not (tmp_path / "c").exists()


@pytest.mark.parametrize("to", ["c", "python", "fmu"])
def test_code_is_written_again_until_somebody_changes_it(to, augmented, tmp_path):
    exported(tmp_path, augmented, to)
    exported(tmp_path, augmented, to, "--points", 3)
    (written, *_) = sorted((tmp_path / to).glob("gpi*"))
    written.write_bytes(written.read_bytes() + b" ")
    done = run_hystbench(
        "export", augmented, "--to", to, "--dt", DT, "--out", tmp_path / to
    )
    assert done.returncode == 2
    assert "changed since hystbench wrote it" in done.stderr


def test_what_a_user_wrote_stays(augmented, tmp_path):
    theirs = tmp_path / "python" / "gpi_of_the_slow_loop_augmented.py"
    theirs.parent.mkdir()
    theirs.write_text("mine = True\n")
    done = run_hystbench(
        "export", augmented, "--to", "python", "--dt", DT, "--out", theirs.parent
    )
    assert done.returncode == 2
    assert "hystbench: " in done.stderr
    assert done.stderr.count("\n") == 1
    assert theirs.read_text() == "mine = True\n"

"""Checkers accept units of FMI 2.0, and refuse those with a mistake."""

import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from hystbench.blocks.step import Sampling
from hystbench.export.code import write_fmu
from hystbench.export.described import describe
from hystbench.model import Model, load_model

from .test_gap_models import FOLDER, WRITTEN
from .test_models import DT, PLANTS

#: What FMI 2.0 forbids, and its clause: an input without a start value (2.2.7); an
#: attribute that is none (2.2.1); a unit that is not defined (2.2.7); an output that
#: is not listed as one (2.2.8); a file that is named twice (4.3.1).
BROKEN = {
    "no start": (' start="0"/>', "/>"),
    "no such attribute": ("guid=", 'instantiationToken="1" guid='),
    "unit not defined": ('<Real unit="um"', '<Real unit="furlong"'),
    "input as an output": ('<Unknown index="3"', '<Unknown index="2"'),
    "same file twice": ('"fmi2.c"/>', '"fmi2.c"/><File name="fmi2.c"/>'),
}
#: Of those, what FMPy does not look at.
UNSEEN_BY_FMPY = {"same file twice"}


def broken(what, path):
    """Write the twin's unit with one mistake in its description."""
    right, wrong = BROKEN[what]
    write_fmu(describe(load_model(PLANTS / "gma.yaml"), Sampling(DT)), path, "2")
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    text = files["modelDescription.xml"].decode()
    assert right in text
    files["modelDescription.xml"] = text.replace(right, wrong).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


@pytest.mark.parametrize("what", sorted(set(BROKEN) - UNSEEN_BY_FMPY))
def test_fmpy_refuses_a_broken_description(what, tmp_path, fmpy):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(broken(what, tmp_path / "gma.fmu"))) != []


@pytest.fixture(scope="module")
def vdmcheck(tmp_path_factory):
    """Lay VDMCheck2 out as its program expects, from the jars that Maven fetches."""
    jars = os.environ.get("HYSTBENCH_VDMCHECK")
    if not jars:
        pytest.skip("HYSTBENCH_VDMCHECK gives no class path of VDMCheck2")
    if shutil.which("java") is None:
        pytest.skip("no java for VDMCheck2")
    folder = tmp_path_factory.mktemp("vdmcheck")
    for jar in map(Path, jars.split(os.pathsep)):
        shutil.copy(jar, folder / re.sub(r"-\d[^-]*\.jar$", ".jar", jar.name))
        with zipfile.ZipFile(jar) as archive:
            models = [name for name in archive.namelist() if name.startswith("fmi2")]
            archive.extractall(folder, models)

    def check(file):
        command = ["java", "-cp", folder / "vdmcheck2.jar", "VDMCheck", file]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    return check


def checked_models():
    """Name models, and give how each is described."""
    late = load_model(FOLDER / "twin.yaml")
    clash = load_model(PLANTS / "gma.yaml").to_mapping()
    clash["input"]["name"] = clash["output"]["name"] = "time & motion"
    written = {
        name: (load_model(FOLDER / f"{name}.yaml"), Sampling(dt, duration_s=1200 * dt))
        for name, (dt, _, _) in WRITTEN.items()
    }
    return {
        "plant": (load_model(PLANTS / "gma.yaml"), Sampling(DT)),
        "late": (late, Sampling(DT, delay=4)),
        "clash": (Model.from_mapping(clash, "here"), Sampling(DT)),
        **written,
    }


@pytest.mark.parametrize("name", ["plant", "late", "clash", *WRITTEN])
def test_vdmcheck_accepts_units_of_fmi_2(name, tmp_path, vdmcheck):
    write_fmu(describe(*checked_models()[name]), tmp_path / "unit.fmu", "2")
    done = vdmcheck(tmp_path / "unit.fmu")
    assert done.returncode == 0, done.stdout + done.stderr
    # of the model's description, and of how it is built
    assert done.stdout.count("No errors found.") == 2


@pytest.mark.parametrize("what", BROKEN)
def test_vdmcheck_refuses_a_broken_description(what, tmp_path, vdmcheck):
    done = vdmcheck(broken(what, tmp_path / "gma.fmu"))
    assert done.returncode != 0
    assert "Errors found." in done.stdout or "cvc-" in done.stdout + done.stderr

"""Simulators that other programs make: a unit by gcc, a program by gcc."""

import shutil
import subprocess
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

FILES = Path(__file__).with_name("files")
RNN = FILES / "rnn.onnx"
PROGRAM = """
#include <stdio.h>
#include <stdlib.h>
int main(int count, char **words) {
    double t, u, y = 0, gain = count > 1 ? atof(words[1]) : 3;
    char header[99];
    if (!fgets(header, 99, stdin)) return 1;
    while (scanf("%lf,%lf", &t, &u) == 2) printf("%.17g\\n", y += 0.1 * (gain * u - y));
    return 0;
}
"""


def needs(*packages):
    """Skip where a package is not installed, with a word."""
    for name in packages:
        if find_spec(name) is None:
            pytest.skip(f"{name} is not installed")


def compiled(folder, text=PROGRAM):
    """Compile a program that reads u and writes y: a lag of a tenth a sample."""
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    source = folder / "program.c"
    source.write_text(text)
    subprocess.run(["gcc", "-O2", source, "-o", folder / "program", "-lm"], check=True)
    return folder / "program"


def unit(folder):
    """Compile a unit of FMI 2 for co-simulation: a lag of 2 ms, gain 3."""
    needs("fmpy")
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    import fmpy

    library = folder / f"lag{fmpy.sharedLibraryExtension}"
    subprocess.run(
        ["gcc", "-w", "-O2", "-shared", "-fPIC", FILES / "lag.c", "-o", library],
        check=True,
    )
    path = folder / "lag.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(FILES / "modelDescription.xml", "modelDescription.xml")
        archive.write(library, f"binaries/{fmpy.platform}/{library.name}")
    return path

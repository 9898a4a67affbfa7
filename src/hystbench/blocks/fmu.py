"""Block ``fmu``: a Functional Mock-up Unit for co-simulation."""

import atexit
import shutil
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.parameter import text
from hystbench.blocks.simulator import CallError, FileSimulator, same_file
from hystbench.errors import InputError, in_line, refuse_unknown
from hystbench.libraries import library
from hystbench.record import FloatArray

EXPECTED = "a Functional Mock-up Unit (.fmu)"


class Fmu(FileSimulator, name="fmu"):
    """A Functional Mock-up Unit (FMI 1 to 3) in co-simulation, run by FMPy.

    One step of communication is one sampling interval. The input is set at the
    beginning of a step and stands through it; the first output is that of time zero.

    References
    ----------
    .. [1] Functional Mock-up Interface Specification, version 3.0, Section 4
       (co-simulation).
    """

    expected = EXPECTED

    file: str = text(EXPECTED)
    input: str = text("variable that is the input; its only input by default", "")
    output: str = text("variable that is the output; its only output by default", "")

    @property
    def label(self) -> str:
        """The file, with the variables that are named."""
        named = ":".join(filter(None, (self.input, self.output)))
        return f"{self.file}:{named}" if named else self.file

    def run(self, z: FloatArray, dt: float) -> np.ndarray:
        """Run the unit once, from its start."""
        path = self.path
        fmpy = library("fmpy", self.label, "simulators")
        folder, description = _unpacked(fmpy, self.label, *same_file(path))
        given = _variable(description, self.label, "input", self.input)
        gives = _variable(description, self.label, "output", self.output)
        table = np.zeros(len(z), dtype=[("time", float), (given, float)])
        table["time"], table[given] = np.arange(len(z)) * dt, z
        try:
            found = fmpy.simulate_fmu(
                folder,
                model_description=description,
                fmi_type="CoSimulation",
                start_time=0.0,
                stop_time=(len(z) - 1) * dt,
                output_interval=dt,
                input=table,
                output=[gives],
                validate=False,
            )
        except Exception as error:
            # A unit, and FMPy of it, may raise anything.
            raise CallError(f"failed: {in_line(error)}") from error
        return np.asarray(found[gives])


@lru_cache(maxsize=8)
def _unpacked(
    fmpy: Any, label: str, path: str, changed: int, size: int
) -> tuple[str, Any]:
    """Unpack a unit once into a folder, which goes when the program ends.

    With the folder comes what the unit says of itself.
    """
    try:
        description = fmpy.read_model_description(path, validate=False)
        folder = fmpy.extract(path)
    except Exception as error:
        raise InputError(
            f"{label}: cannot be read ({in_line(error)}); expected {EXPECTED}"
        ) from error
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    if description.coSimulation is None:
        raise InputError(
            f"{label}: a unit for model exchange; expected one for co-simulation"
        )
    platform = (
        fmpy.platform_tuple if description.fmiVersion[0] == "3" else (fmpy.platform)
    )
    if not Path(folder, "binaries", platform).is_dir():
        there = sorted(item.name for item in Path(folder, "binaries").glob("*"))
        raise InputError(
            f"{label}: no binary for {platform}; it has {', '.join(there) or 'none'}"
        )
    return folder, description


def _variable(description: Any, label: str, causality: str, asked: str) -> str:
    """Name the variable that was asked for, or the only one there is."""
    names = [v.name for v in description.modelVariables if v.causality == causality]
    if asked:
        refuse_unknown(asked, names, f"{label}: {causality}: no {causality} {asked!r}")
        return asked
    if len(names) != 1:
        raise InputError(
            f"{label}: {len(names)} variables are {causality}s "
            f"({', '.join(names[:6]) or 'none'}); expected the name of one, "
            f"'{causality}: NAME', in a model file"
        )
    return str(names[0])

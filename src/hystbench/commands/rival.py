"""``hystbench rival``: a rival of the gap's solver, on a dataset."""

from pathlib import Path
from typing import Annotated

from hystbench import options
from hystbench.command_files import writes
from hystbench.entrants.rivals import rivals
from hystbench.entrants.rivals.base import read, write
from hystbench.errors import refuse_unknown
from hystbench.options import DatasetFile, OutFolder, command


@command
def rival(
    name: str,
    dataset: DatasetFile,
    *,
    model: Annotated[Path, options.FILE, "Model file (YAML)."],
    out: OutFolder,
) -> None:
    """Let the rival NAME write a gap.json for DATASET.

    naive fits every effect by itself; random draws a name. Installed packages may have
    added others.
    """
    known = rivals(name)
    refuse_unknown(name, known, f"rival: no {name!r}")
    writes(out / "gap.json")
    given = read(dataset, model)
    write(given, known[name]().answer(given), out)

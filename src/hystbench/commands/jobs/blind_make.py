"""``hystbench job blind-make``: the cases of a chunk, as solvers get them."""

from hystbench.challenge.contest.plan import chunks, plan
from hystbench.challenge.make import make, write_folder
from hystbench.files import whole_folder
from hystbench.options import OutFolder, Settings, command

#: Files of a chunk, as patterns.
WRITTEN = ("*/model.yaml", "*/dataset/*")


@command
def blind_make(*, settings: Settings, out: OutFolder) -> None:
    """Write a folder a case; no truth is written anywhere."""
    entries = chunks(plan(**settings["plan"]), settings["size"])
    with whole_folder(out, WRITTEN) as fresh:
        for entry in entries[settings["chunk"]]:
            write_folder(make(entry.spec), fresh / entry.name)

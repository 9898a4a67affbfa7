"""``hystbench job blind-make``: the cases of a chunk, as solvers get them."""

from hystbench.challenge.contest.chunk import WRITTEN, make_chunk
from hystbench.challenge.contest.plan import chunks, plan
from hystbench.files import whole_folder
from hystbench.signature import OutFolder, Settings, command


@command
def blind_make(*, settings: Settings, out: OutFolder) -> None:
    """Write a folder a case; no truth is written anywhere."""
    entries = chunks(plan(**settings["plan"]), settings["size"])
    with whole_folder(out, WRITTEN) as fresh:
        make_chunk(entries[settings["chunk"]], fresh)

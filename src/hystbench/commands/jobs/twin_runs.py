"""``hystbench job twin-runs``: one filter on several twins."""

from hystbench.files import write_json
from hystbench.options import In, Json, Out, Settings, command
from hystbench.twins.parts import run
from hystbench.twins.runs import read_twins


@command
def twin_runs(
    twins: tuple[In, ...], *, fits: Json, settings: Settings, out: Out
) -> None:
    """Run one filter on TWINS as configured, with what twin-fits found."""
    write_json(out, run(read_twins(twins), settings, fits))

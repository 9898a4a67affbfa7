"""``hystbench job gap-summary``: the verdicts on several datasets as tables."""

from hystbench.gap.computing_time import write_seconds
from hystbench.gap.report.tables import write_adds, write_table
from hystbench.model import load_model
from hystbench.options import In, Json, Out, command


@command
def gap_summary(
    gaps: tuple[Json, ...] = (),
    *,
    effects: Out,
    records: Out,
    sentences: Out,
    took: tuple[In, ...] = (),
    seconds: Out | None = None,
    twin: In | None = None,
    adds: Out | None = None,
    out: Out,
) -> None:
    """Write tables of GAPS, gap.json files: datasets, parameters, records, words.

    ADDS is a table of what the TWIN, a model file, adds to its hysteresis, SECONDS one
    of how long the jobs computed that wrote the tables TOOK.
    """
    write_table("summary", gaps, out)
    write_table("effects", gaps, effects)
    write_table("records", gaps, records)
    write_table("sentences", gaps, sentences)
    if twin is not None and adds is not None:
        write_adds(load_model(twin), adds)
    if seconds is not None:
        write_seconds(took, seconds)

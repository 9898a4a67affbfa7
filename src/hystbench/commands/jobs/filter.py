"""``hystbench job filter``: run one LMS filter on one record."""

from hystbench.adaptive import make_filter, run_filter
from hystbench.options import In, Json, Out, Settings, command
from hystbench.record import load_record
from hystbench.results import save_run


@command
def filter(  # noqa: A001  (the command's name)
    record: In,
    *,
    model: str,
    identified: Json | None = None,
    settings: Settings,
    out: Out,
    arrays: Out,
) -> None:
    """Run the filter MODEL on RECORD: errors as JSON, output and error as arrays."""
    evidence = load_record(record)
    adaptive = make_filter(model, settings, evidence, identified)
    kept, result = run_filter(adaptive, evidence, settings)
    save_run(out, arrays, kept, result.output, result.error)

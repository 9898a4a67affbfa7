"""``hystbench job envelopes``: the GPO filter with either envelope functions."""

from hystbench.adaptive import make_filter, run_filter
from hystbench.files import write_csv
from hystbench.options import In, Json, Out, Settings, command
from hystbench.record import load_record

COLUMNS = ["signal", "envelopes", "mse", "re", "status"]


@command
def envelopes(
    records: tuple[In, ...],
    *,
    identified: Json | None = None,
    settings: Settings,
    out: Out,
) -> None:
    """Run the GPO filter on RECORDS with identified and published envelopes."""
    rows = []
    for record in map(load_record, records):
        # The published envelopes are those of one actuator, in amperes.
        twin = record.origin == "twin"
        for source in ("identified", "published") if twin else ("identified",):
            chosen = settings | {"envelopes": source}
            adaptive = make_filter("gpo", chosen, record, identified)
            kept, _ = run_filter(adaptive, record, chosen)
            told = kept["diverged"]
            status = told["sentence"] if told else "finite"
            rows.append([record.name, source, kept["mse"], kept["re"], status])
    write_csv(out, COLUMNS, rows)

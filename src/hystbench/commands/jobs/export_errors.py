"""``hystbench job export-errors``: how far exported code is from the simulation."""

from hystbench.files import write_csv
from hystbench.job import Out, job


@job
def export_errors(*, out: Out) -> None:
    """Measure exported code on typical cases, as a table (CSV).

    Rms errors as shares of the output's rms, by the options of hystbench export.
    """
    from hystbench.export.errors import table  # late: it runs

    rows = table()
    write_csv(out, list(rows[0]), (list(row.values()) for row in rows))

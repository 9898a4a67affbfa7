"""``hystbench job rdgpi-published``: the RDGPI model with the published values."""

from hystbench.files import write_csv
from hystbench.metrics import mean_square_error, relative_error
from hystbench.options import In, Out, command
from hystbench.rdgpi import PUBLISHED_RDGPI
from hystbench.record import load_record

COLUMNS = ["signal", "error_kind", "mse", "re", "largest_output", "largest_reference"]


@command
def rdgpi_published(records: tuple[In, ...], *, out: Out) -> None:
    """Simulate the published values, under our reading of the model, on RECORDS."""
    rows = []
    for record in map(load_record, records):
        output = PUBLISHED_RDGPI.simulate(record.u, record.dt)
        error = record.y - output
        errors = (mean_square_error(error), relative_error(error, record.y))
        largest = (float(abs(y).max()) for y in (output, record.y))
        rows.append([record.name, "free-run simulation", *errors, *largest])
    write_csv(out, COLUMNS, rows)

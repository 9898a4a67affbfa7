"""``hystbench job step-sweep``: how far each step size can go."""

from hystbench.compare.beside import EDGE_COLUMNS
from hystbench.compare.rows import four_digits, names_of, write_fields
from hystbench.record import load_record
from hystbench.signature import In, Json, Out, Settings, command
from hystbench.twins.edges import Point, sweep


@command
def step_sweep(
    records: tuple[In, ...],
    *,
    identified: Json | None = None,
    settings: Settings,
    edges: Out,
    points: Out,
) -> None:
    """Raise each filter's step sizes on RECORDS up to their edge."""
    read = {record.name: record for record in map(load_record, records)}
    found, run = sweep(read, settings, identified)
    write_fields(edges, EDGE_COLUMNS, found, four_digits)
    write_fields(points, names_of(Point), run, four_digits)

"""``hystbench job step-sweep``: how far each step size can go."""

import math
from dataclasses import astuple, fields

from hystbench.compare.edges import write_edges
from hystbench.files import write_csv
from hystbench.job import In, Json, Out, Settings, job
from hystbench.record import load_record
from hystbench.twins.edges import Point, sweep


@job
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
    write_edges(found, edges)
    rows = (
        [
            ("" if v is None or math.isinf(v) else f"{v:.4g}")
            if not isinstance(v, str)
            else v
            for v in astuple(point)
        ]
        for point in run
    )
    write_csv(points, [field.name for field in fields(Point)], rows)

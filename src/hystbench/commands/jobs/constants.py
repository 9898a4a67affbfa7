"""``hystbench job constants``: the ranking with other constants."""

from hystbench.compare.beside import Ranking
from hystbench.compare.rows import four_digits, names_of, write_fields
from hystbench.published import load_errors
from hystbench.signature import In, Json, Out, Settings, command
from hystbench.twins.constants import vary_constants
from hystbench.twins.read import read_twins


@command
def constants(
    twins: tuple[In, ...],
    *,
    identified: Json | None = None,
    settings: Settings,
    out: Out,
) -> None:
    """Rank the filters on TWINS with other zero errors and with a constant tap."""
    published = {(p.signal, p.model): p.mse.value for p in load_errors()}
    rows = [
        row
        for twin in read_twins(twins)
        for row in vary_constants(twin, settings, identified, published)
    ]
    write_fields(out, names_of(Ranking), rows, four_digits)

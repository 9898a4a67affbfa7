"""``hystbench job random-sum``: the random sum drawn many times."""

from hystbench.compare.beside import Draw
from hystbench.compare.rows import names_of, or_empty, write_fields
from hystbench.files import write_csv
from hystbench.published import load_errors
from hystbench.published.consistency import check
from hystbench.rdgpi import RateDependentGPI
from hystbench.signature import In, Json, Out, Settings, command
from hystbench.twins import draws as drawing
from hystbench.twins.read import read_twins


@command
def random_sum(
    twin: In,
    *,
    identified: Json | None = None,
    rdgpi: Json | None = None,
    settings: Settings,
    draws: Out,
    readings: Out,
) -> None:
    """Run all models on draws of the random sum: each draw, and what they say."""
    fitted = RateDependentGPI(**rdgpi["parameters"]) if rdgpi else None
    found = drawing.run_draws(read_twins([twin])[0], settings, identified, fitted)
    signal = settings["signal"]
    write_fields(draws, names_of(Draw), found, or_empty)
    published = {p.model: p.mse.value for p in load_errors() if p.signal == signal}
    rms = check(load_errors())[signal].implied_rms
    told = drawing.readings(found, published, rms)
    write_csv(readings, drawing.READING_COLUMNS, told)

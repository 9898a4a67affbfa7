"""``hystbench job found``: the values that the calibration found, as a table."""

from hystbench.job import In, Out, job
from hystbench.model import load_model
from hystbench.twins.run import write_found


@job
def found(twin: In, others: tuple[In, ...] = (), *, out: Out) -> None:
    """Write the values found in TWIN, and their spread over the OTHERS as good."""
    write_found(out, load_model(twin), [load_model(path) for path in others])

"""``hystbench job rdgpi-identify``: fit the RDGPI model to records."""

from hystbench.files import write_json
from hystbench.options import In, Out, Settings, command
from hystbench.rdgpi import identify_rdgpi
from hystbench.record import load_record


@command
def rdgpi_identify(records: tuple[In, ...], *, settings: Settings, out: Out) -> None:
    """Fit the RDGPI model to all RECORDS at once, in free run."""
    fit = identify_rdgpi([load_record(path) for path in records], **settings)
    found = {"relative_error": fit.relative_error, "starts": fit.starts}
    write_json(out, {"parameters": fit.model.to_dict(), **found})

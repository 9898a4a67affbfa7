"""``hystbench job twin-fits``: Algorithm 1 and the RDGPI model on several twins."""

from hystbench.files import write_json
from hystbench.options import In, Out, Settings, command
from hystbench.twins.fits import fit
from hystbench.twins.runs import read_twins


@command
def twin_fits(twins: tuple[In, ...], *, settings: Settings, out: Out) -> None:
    """Fit on TWINS what no step size changes."""
    write_json(out, fit(read_twins(twins), settings))

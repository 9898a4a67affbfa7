"""What a search starts from: the base on the fit records, and the noise floor."""

from __future__ import annotations

from hystbench.blocks.held import Hold
from hystbench.gap.compared import Compared
from hystbench.gap.floor import Floor, noise_floor
from hystbench.gap.sample import Sample
from hystbench.gap.scene import Scene
from hystbench.gap.state import State
from hystbench.model import Model
from hystbench.record import Record


def start_state(
    records: tuple[Record, ...],
    base: Model,
    hold: Hold = "band-limited",
    declared: float | None = None,
) -> tuple[State, Floor]:
    """Simulate the base on the fit records and measure the noise floor.

    Parameters
    ----------
    records : tuple of Record
    base : Model
    hold : {"zero-order", "linear", "band-limited"}
        How the input moves between samples.
    declared : float, optional
        RMS noise, where it is known.
    """
    chain = base.with_hold(hold).chain
    state = State(chain, records, Sample.of(records), hold=hold).settled()
    exact = Scene(chain, records, hold).output
    compared = [
        Compared(record, simulated)
        for record, simulated in zip(records, exact, strict=True)
    ]
    return state, noise_floor(compared, declared)

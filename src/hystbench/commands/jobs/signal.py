"""``hystbench job signal``: make an excitation signal."""

from hystbench.job import Out, Settings, job
from hystbench.signals import make_signal


@job
def signal(name: str, *, settings: Settings, out: Out) -> None:
    """Make the signal NAME from its definition in the settings."""
    make_signal(name, settings["definition"], settings["common"]).save(out)

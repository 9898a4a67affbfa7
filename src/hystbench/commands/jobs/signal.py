"""``hystbench job signal``: make an excitation signal."""

from hystbench.signals import make_signal
from hystbench.signature import Out, Settings, command


@command
def signal(name: str, *, settings: Settings, out: Out) -> None:
    """Make the signal NAME from its definition in the settings."""
    make_signal(name, settings["definition"], settings["common"]).save(out)

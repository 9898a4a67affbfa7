"""``hystbench job signal``: make an excitation signal."""

from hystbench.options import Out, Settings, command
from hystbench.signals import make_signal


@command
def signal(name: str, *, settings: Settings, out: Out) -> None:
    """Make the signal NAME from its definition in the settings."""
    make_signal(name, settings["definition"], settings["common"]).save(out)

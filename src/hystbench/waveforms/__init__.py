"""Waveforms: each file beside this one adds its own kind of signal to the registry.

An installed package adds one by an entry point of the group ``hystbench.waveforms``.
"""

from functools import cache

from hystbench.registered import classes_in, with_installed
from hystbench.waveforms.base import Waveform

WAVEFORMS: dict[str, type[Waveform]] = classes_in(__name__, __path__, Waveform)
"""Every waveform of hystbench itself, by its name."""


@cache
def registry() -> dict[str, type[Waveform]]:
    """Give every waveform by its name.

    Raises
    ------
    InputError
        If an installed package offers what is no waveform, or a name that is taken.
    """
    return with_installed(WAVEFORMS, "hystbench.waveforms", Waveform)


def waveforms(name: str) -> dict[str, type[Waveform]]:
    """Give waveforms by name, those of installed packages only if this one needs them.

    To ask what is installed takes longer than to make a signal.
    """
    return WAVEFORMS if name in WAVEFORMS else registry()

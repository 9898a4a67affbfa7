"""What a waveform must say so that config.yaml can define a signal by it."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from hystbench.record import FloatArray


class Waveform(ABC):
    """A kind of signal.

    The keyword parameters of :meth:`samples` are the keys that config.yaml takes; their
    annotations, ``float``, ``int`` or ``Sequence[float]``, are what it checks. A number
    must be above zero, a whole one at least 1, unless a list here says otherwise. A
    key that ends in ``_hz`` must be below half the sampling frequency.
    """

    name: ClassVar[str]
    """Name in config.yaml."""
    example: ClassVar[Mapping[str, Any]]
    """Keys as config.yaml could hold them, those with a common value left out."""
    any_sign: ClassVar[tuple[str, ...]] = ()
    """Keys whose numbers may have any sign."""
    may_be_zero: ClassVar[tuple[str, ...]] = ()
    """Keys whose numbers may be zero."""

    @staticmethod
    @abstractmethod
    def samples(*_: Any, **values: Any) -> FloatArray:
        """Compute the signal.

        Parameters
        ----------
        **values
            A value for each key. The keys ``duration_s``, ``sampling_frequency_hz``,
            ``amplitude`` and ``gain`` have common values in config.yaml.

        Returns
        -------
        ndarray, shape (round(duration_s * sampling_frequency_hz),)
            In the unit of the actuator's input.
        """


def times(duration_s: float, sampling_frequency_hz: float) -> FloatArray:
    """Give the times of the samples of a record, in seconds."""
    count = round(duration_s * sampling_frequency_hz)
    return np.asarray(np.arange(count) / sampling_frequency_hz)

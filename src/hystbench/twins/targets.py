"""What a twin is fitted to: the published errors of the calibration signals."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from hystbench.errors import InputError, nearest
from hystbench.published import FILTERS, load
from hystbench.published.consistency import check_signal
from hystbench.published.split import CALIBRATION_SIGNALS


@dataclass(frozen=True)
class Target:
    """What the tables say of one signal.

    Parameters
    ----------
    signal : str
        Name of the signal.
    mse : dict of str to float
        Published MSE (um^2) by filter.
    rms : float
        Implied RMS displacement (um): the middle of what the consistent rows share.
    consistent : dict of str to bool
        Whether a filter's row agrees with the others.
    """

    signal: str
    mse: dict[str, float]
    rms: float
    consistent: dict[str, bool]


def targets(signals: Iterable[str] = CALIBRATION_SIGNALS) -> tuple[Target, ...]:
    """Read the targets of some calibration signals.

    Raises
    ------
    InputError
        If a signal is not one of the calibration signals.
    """
    found = []
    for signal in signals:
        if signal not in CALIBRATION_SIGNALS:
            raise InputError(
                f"calibration: {signal!r} is held out or unknown; "
                f"{nearest(signal, CALIBRATION_SIGNALS)}"
            )
        rows = [
            pair for pair in load() if pair.signal == signal and pair.model in FILTERS
        ]
        checked = check_signal(rows)
        found.append(
            Target(
                signal=signal,
                mse={pair.model: pair.mse.value for pair in rows},
                rms=checked.implied_rms,
                consistent={
                    pair.model: checked.standing(pair.model) == "yes" for pair in rows
                },
            )
        )
    return tuple(found)

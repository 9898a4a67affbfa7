"""The ranking with other constants, a row of its table each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Ranking:
    """The ranking on a twin with one constant.

    Parameters
    ----------
    twin, family : str
    zero_error_mA : float
        Constant on the recorded input (mA).
    constant_tap : float
        Size of the constant tap beside the RMS of the others; zero for none.
    configured : {"yes", ""}
        Whether both are as in config.yaml.
    gpo_first, signals : int
        Signals on which the GPO filter has the least MSE, and all.
    first_elsewhere : str
        The others, each with the filter that has.
    pairs_calibrated, pairs_held_out : str
        Pairs of filters under one signal in the paper's order, and all: ``40 of 48``.
    diverged : int
        Runs that diverged.
    mean_mse_gpo_um2, ... : float
        Geometric mean of a filter's MSE over the signals; infinite where one diverged.
    """

    twin: str
    family: str
    zero_error_mA: float  # noqa: N815 - the unit
    constant_tap: float
    configured: str
    gpo_first: int
    signals: int
    first_elsewhere: str
    pairs_calibrated: str
    pairs_held_out: str
    diverged: int
    mean_mse_gpo_um2: float
    mean_mse_backlash_um2: float
    mean_mse_volterra_um2: float
    mean_mse_delayed_um2: float

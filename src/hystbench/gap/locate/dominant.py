"""Which modes hold most of the output of one level: a rational fit finds them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hystbench.gap.bases import spectral
from hystbench.gap.bases.spectral import Ratio, Spectra, Stretch, fit_ratio
from hystbench.gap.locate.mode import ENOUGH, excited_lines
from hystbench.record import FloatArray, Record

ORDERS = (2, 4, 6, 8)
"""Orders of the model that finds the modes."""
SLOWEST = 0.5
"""Damping ratio up to which a pair of poles has a peak to speak of."""
LEAST_SHARE = 0.1
"""Of the output's power, that a mode worth a picture holds."""


class Found(NamedTuple):
    """Modes of one level: frequency in Hz and damping ratio, and what they leave."""

    modes: tuple[tuple[float, float], ...]
    left: float


def find_modes(records: Sequence[Record], most: int = 2) -> Found:
    """Find the modes that hold most of the output, by a rational fit.

    Parameters
    ----------
    records : sequence of Record
        Of one level.
    most : int

    Returns
    -------
    Found
        The mode with the largest share first; ``left`` is the share of the output's
        power that the linear model does not explain.
    """
    stretches = [Stretch(*_centred(record), record.dt) for record in records]
    whole = Spectra.of(stretches, "band-limited")
    spectra = replace(whole, lines=tuple(map(_driven, whole.lines)))
    facts = 2 * sum(len(one.s) for one in spectra.lines)
    energy = sum(float(np.sum(np.abs(one.y) ** 2)) for one in spectra.lines)
    fits = [(order, fit_ratio(spectra, order, order)) for order in ORDERS]
    _, ratio = min(
        fits,
        key=lambda item: (
            facts * np.log(max(item[1].cost, 1e-12 * energy))
            + 2 * item[0] * np.log(facts)
        ),
    )
    shares = [
        (_share(spectra, ratio, pole) / energy, pole)
        for pole in np.roots(np.append(ratio.a, 1.0)[::-1])
        if pole.imag > 0 and -pole.real < SLOWEST * abs(pole)
    ]
    kept = sorted(shares, key=lambda item: -item[0])[:most]
    modes = tuple(
        (float(abs(pole)) * spectra.scale / (2 * np.pi), float(-pole.real / abs(pole)))
        for share, pole in kept
        if share >= LEAST_SHARE
    )
    return Found(modes, ratio.cost / energy)


def _driven(lines: spectral.Lines) -> spectral.Lines:
    """Cut off what lies below and above all that the input excites."""
    (there,) = np.nonzero(excited_lines(lines.u))
    cut = slice(int(there[0]), int(there[-1]) + 1)
    return spectral.Lines(lines.s[cut], lines.u[cut], lines.y[cut], lines.constant[cut])


def _centred(record: Record) -> tuple[FloatArray, FloatArray]:
    period = record.period_samples
    repeats = period is not None and len(record) >= 2 * period
    u, y = (x[period:] if repeats else x[-ENOUGH:] for x in (record.u, record.y))
    return u - float(np.mean(u)), y - float(np.mean(y))


def _share(spectra: Spectra, ratio: Ratio, pole: complex) -> float:
    """Give the energy of the output that one pair of poles makes."""
    slope = np.polyval(np.polyder(np.append(ratio.a, 1.0)[::-1]), pole)
    residue = np.polyval(ratio.b[::-1], pole) / slope
    energy = 0.0
    for one in spectra.lines:
        both = residue / (one.s - pole) + np.conj(residue) / (one.s - np.conj(pole))
        energy += float(np.sum(np.abs(both * one.u) ** 2))
    return energy

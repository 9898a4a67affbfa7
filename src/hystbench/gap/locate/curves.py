"""What the pictures of the gap draw: short lists of numbers, ready for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.gap.compared import Compared
from hystbench.gap.floor import Floor
from hystbench.gap.locate.cells import cell_of
from hystbench.gap.locate.coherence import coherence_curve, take_coherence
from hystbench.gap.locate.distortion import KINDS, Distortion, Lines, take_distortion
from hystbench.gap.locate.levels import levels_curve, take_levels
from hystbench.gap.locate.listed import IntArray, in_groups, listed
from hystbench.gap.locate.loops import loop_curve, take_loops
from hystbench.gap.locate.plane import over_plane
from hystbench.gap.locate.record import record_shares
from hystbench.gap.locate.samples import Samples, take_samples
from hystbench.gap.locate.slow_time import block_means
from hystbench.gap.locate.spectra import Spectra, take_spectra
from hystbench.record import FloatArray

BoolArray = NDArray[np.bool_]

# Points of a map over an axis.
CELLS = 40
# The input excites bins with this share of its strongest one's power.
EXCITED = 1e-4
# Lines of a kind in the picture of one record.
LINES = 100


def curves(compared: Sequence[Compared], floor: Floor) -> dict[str, Any]:
    """Work out what the pictures of the gap draw.

    Parameters
    ----------
    compared : sequence of Compared
    floor : Floor

    Returns
    -------
    dict
        Lists of floats of at most 200 points, and these keys only. Y and U are the
        units of output and input.

        - ``units``: ``{"input": U, "output": Y}``.
        - ``response``: best linear approximation of measurement over simulation, on
          excited lines: ``frequency`` (Hz), ``magnitude`` (1 where the model is
          right), ``phase`` (degrees, 0 where it is right), ``coherence`` (0 to 1).
        - ``spectrum``: ``frequency`` (Hz); ``residual``, ``linear`` (the part of it
          that is linear in the simulated output), ``simulated`` and ``floor``, all
          amplitude densities in Y/sqrt(Hz).
        - ``over_input``: residual by the input: ``input`` (U), ``rising`` and
          ``falling`` (Y, mean residual of each branch, null where the cell is empty),
          ``rms`` (Y), ``floor`` (Y, one number).
        - ``over_rate``: residual by the input's rate: ``rate`` (U/s), ``mean`` (Y),
          ``rms`` (Y); cells of equally many samples.
        - ``over_plane``: residual by both, or null where the input never moves; see
          :func:`~hystbench.gap.locate.plane.over_plane`.
        - ``slow``: one mapping a record, in order: ``record`` (name), ``time`` (s),
          ``residual`` (Y, mean over a block of at least one main period), 25 points
          at most.
        - ``records``: ``name``, ``share`` (of the gap's power, adding to 1), ``rms``
          (Y), ``floor`` (Y), ``loop_area`` (U Y a cycle of the residual over the
          input, positive where the measurement lags more), ``frequency`` (Hz, the
          main one).
        - ``harmonics``: ``excited``, ``odd``, ``even``, ``either``, ``other``: shares
          of the gap above the noise in periodic records, or null where there are none.
        - ``distortion``: where these shares lie, or null: ``record``, and the same five
          lists, all of them together adding to one; and of the record that holds most
          beside the input's lines ``lines``: ``record``, ``noise`` (Y, amplitude that
          the floor gives a line) and for ``excited``, ``odd``, ``even`` and ``either``
          ``frequency`` (Hz) and ``amplitude`` (Y) of the first 100.
        - ``loops``: ``frequency`` (Hz) of third-octave bands; ``measured``,
          ``simulated`` (U Y a cycle, positive where the output lags) and ``error`` of
          their difference; or null where the input never moves.
        - ``coherence``: of the residual with the input: ``frequency`` (Hz),
          ``coherence`` (0 to 1), ``chance`` (what an unrelated residual exceeds in one
          of twenty) and ``share`` (of the gap, one number); or null where records are
          short.
        - ``levels``: one mapping a mode under ``modes``, at each level of the input:
          ``kind`` (the class), ``input`` (U, rms), ``frequency`` (Hz), ``width``
          (damping ratio of the fitted pole), ``damping`` (the same by power), ``gain``,
          and of each but the input its ``_error``; or null where fewer than three
          levels of broadband input show a mode.

    Raises
    ------
    InputError
        If there is no record.
    """
    if not compared:
        raise InputError("curves: expected at least one record, got none")
    samples = take_samples(compared, floor)
    spectra = take_spectra(samples)
    channels = compared[0].record
    distortion = take_distortion(samples)
    return {
        "units": {"input": channels.input.unit, "output": channels.output.unit},
        "response": _response(spectra, _driven(samples)),
        "spectrum": _spectrum(samples, spectra),
        "over_input": _over_input(samples, floor),
        "over_rate": _over_rate(samples),
        "over_plane": over_plane(samples),
        "slow": [_slow(item, f) for item, f in _with_frequency(samples)],
        "records": _records(samples, floor),
        "harmonics": None if distortion is None else distortion.shares(),
        "distortion": None if distortion is None else _distortion(samples, distortion),
        "loops": loop_curve(take_loops(samples)),
        "coherence": coherence_curve(take_coherence(samples)),
        "levels": levels_curve(take_levels(samples)),
    }


def _driven(samples: Samples) -> FloatArray:
    """Give the input's power in the bins of the spectra."""
    driven = tuple(Compared(one.record, one.record.u) for one in samples.compared)
    return take_spectra(replace(samples, compared=driven)).simulated


def _response(spectra: Spectra, driven: FloatArray) -> dict[str, list[float]]:
    """Give measurement over simulation where the input has power.

    A harmonic that the simulation makes by itself has no response.
    """
    excited = driven >= EXCITED * float(np.max(driven))
    groups = in_groups(np.cumsum(excited) - 1, int(np.sum(excited)))
    cross = _gather(groups, spectra.cross.real, excited) + 1j * _gather(
        groups, spectra.cross.imag, excited
    )
    simulated = _gather(groups, spectra.simulated, excited)
    residual = _gather(groups, spectra.residual, excited)
    energy = _gather(groups, spectra.simulated * spectra.frequency, excited)
    simulated = np.maximum(simulated, 1e-300)
    ratio = 1 + cross / simulated
    # The measurement's power is that of simulation plus residual.
    measured = simulated + residual + 2 * cross.real
    coherence = np.abs(simulated + cross) ** 2 / np.maximum(
        simulated * measured, 1e-300
    )
    return {
        "frequency": listed(energy / simulated),
        "magnitude": listed(np.abs(ratio)),
        "phase": listed(np.degrees(np.angle(ratio))),
        "coherence": listed(np.clip(coherence, 0.0, 1.0)),
    }


def _spectrum(samples: Samples, spectra: Spectra) -> dict[str, list[float]]:
    """Give amplitude densities of the residual, its linear part and the floor."""
    count = len(spectra.frequency)
    groups = in_groups(np.arange(count), count)
    everywhere = np.ones(count, dtype=np.bool_)
    noise = _gather(groups, spectra.noise, everywhere)
    centre = _gather(groups, spectra.noise * spectra.frequency, everywhere) / noise
    # White noise of variance s^2 at a sampling interval dt has the density 2 s^2 dt.
    dts = [(len(item.record), item.record.dt) for item in samples.compared]
    mean_dt = sum(n * dt for n, dt in dts) / sum(n for n, _ in dts)
    scale = 2 * samples.noise * mean_dt / noise
    linear = np.minimum(spectra.linear, spectra.residual)

    def density(power: FloatArray) -> list[float]:
        return listed(np.sqrt(scale * _gather(groups, power, everywhere)))

    return {
        "frequency": listed(centre),
        "residual": density(spectra.residual),
        "linear": density(linear),
        "simulated": density(spectra.simulated),
        "floor": density(spectra.noise),
    }


def _over_input(samples: Samples, floor: Floor) -> dict[str, Any]:
    """Average the residual over cells of the input, branch by branch."""
    u = samples.input
    edges = np.linspace(float(u.min()), float(u.max()), CELLS + 1)
    cell = cell_of(edges, u)
    branches = {}
    for name, chosen in (
        ("rising", samples.direction > 0),
        ("falling", samples.direction < 0),
    ):
        count = np.bincount(cell[chosen], minlength=CELLS)
        total = np.bincount(cell[chosen], samples.residual[chosen], CELLS)
        branches[name] = [
            float(t / n) if n else None for t, n in zip(total, count, strict=True)
        ]
    count = np.maximum(np.bincount(cell, minlength=CELLS), 1)
    power = np.bincount(cell, samples.residual**2, CELLS) / count
    return {
        "input": listed(0.5 * (edges[1:] + edges[:-1])),
        **branches,
        "rms": listed(np.sqrt(power)),
        "floor": floor.rms,
    }


def _over_rate(samples: Samples) -> dict[str, list[float]]:
    """Average the residual over cells of the rate, of equally many samples."""
    order = np.argsort(samples.speed)
    starts = np.unique(np.linspace(0, len(order), CELLS + 1)[:-1].astype(np.int64))
    count = np.diff(np.append(starts, len(order)))

    def mean(values: FloatArray) -> FloatArray:
        return np.asarray(np.add.reduceat(values[order], starts) / count)

    return {
        "rate": listed(mean(samples.speed)),
        "mean": listed(mean(samples.residual)),
        "rms": listed(np.sqrt(mean(samples.residual**2))),
    }


def _with_frequency(samples: Samples) -> list[tuple[Compared, float]]:
    return list(zip(samples.compared, samples.main_frequencies.tolist(), strict=True))


def _slow(item: Compared, frequency: float) -> dict[str, Any]:
    """Average a record's residual over blocks of at least one main period."""
    n, dt = len(item.record), item.record.dt
    period = item.record.period_samples or round(1 / max(frequency * dt, 1 / n))
    # Whole periods, so that what repeats cancels alike in every block.
    size = max(1, period) * max(1, -(-n // (25 * max(1, period))))
    size = min(size, n)
    means = block_means(item.residual[: n // size * size], size)
    time = (np.arange(len(means)) + 0.5) * size * dt
    return {
        "record": item.record.name,
        "time": listed(time),
        "residual": listed(means),
    }


def _records(samples: Samples, floor: Floor) -> dict[str, list[Any]]:
    """Give share, RMS and loop area record by record."""
    frequencies = samples.main_frequencies
    items = samples.compared
    areas = [
        _loop_area(item, frequency)
        for item, frequency in zip(items, frequencies, strict=True)
    ]
    return {
        "name": [item.record.name for item in items],
        "share": listed(record_shares(samples)),
        "rms": [float(np.sqrt(np.mean(item.residual**2))) for item in items],
        "floor": [floor.per_record[item.record.name] for item in items],
        "loop_area": areas,
        "frequency": listed(frequencies),
    }


def _loop_area(item: Compared, frequency: float) -> float:
    """Give the area of residual over input, a cycle of the main frequency."""
    record = item.record
    area = float(np.sum(item.residual * np.gradient(record.u)))
    return -area / max(len(record) * record.dt * float(frequency), 1e-300)


def _distortion(samples: Samples, distortion: Distortion) -> dict[str, Any]:
    """Give the shares record by record, and the lines of the one that tells most."""
    above = np.array([one.above(samples.noise) for one in distortion.records])
    beside = above[:, 1:4].sum(axis=1)
    # Where nothing lies beside the input's lines, the record with the largest gap.
    most = int(np.argmax(beside if np.any(beside > 0) else above.sum(axis=1)))
    shares = above / max(float(np.sum(above)), 1e-300)
    return {
        "record": [one.record for one in distortion.records],
        **{
            name: listed(column)
            for name, column in zip((*KINDS, "other"), shares.T, strict=True)
        },
        "lines": _lines(distortion.records[most]),
    }


def _lines(lines: Lines) -> dict[str, Any]:
    """Give the first lines of each kind."""
    found: dict[str, Any] = {"record": lines.record, "noise": lines.noise_amplitude}
    for number, name in enumerate(KINDS):
        chosen = np.flatnonzero(lines.kind == number)[:LINES]
        found[name] = {
            "frequency": listed(lines.frequency[chosen]),
            "amplitude": listed(lines.amplitude[chosen]),
        }
    return found


def _gather(groups: IntArray, values: FloatArray, chosen: BoolArray) -> FloatArray:
    return np.bincount(groups[chosen], values[chosen]).astype(np.float64)

"""WAV files: sound, or what a sound card measured."""

import warnings
from pathlib import Path

import numpy as np

from hystbench.formats.table import Column, FloatArray, Table, told


def read(path: Path) -> Table:
    """Read the channels; whole numbers become shares of full scale."""
    with told(path, "WAV file"), warnings.catch_warnings():
        from scipy.io import wavfile  # late: scipy

        warnings.simplefilter("ignore")  # of parts that are no samples
        frequency, samples = wavfile.read(path)
    values = _full_scale(np.atleast_2d(samples.T))
    columns = tuple(
        Column(f"channel {k}", np.ascontiguousarray(row), None, float(frequency))
        for k, row in enumerate(values, start=1)
    )
    note = "whole numbers are taken as shares of full scale, -1 to 1"
    notes = (note,) if samples.dtype.kind in "iu" else ()
    return Table(path, columns, {}, notes)


def _full_scale(samples: np.ndarray) -> FloatArray:
    kind, size = samples.dtype.kind, samples.dtype.itemsize
    if kind == "u":  # eight bits have their zero in the middle
        return (samples.astype(np.float64) - 128.0) / 128.0
    if kind == "i":
        return np.asarray(samples / 2.0 ** (8 * size - 1), dtype=np.float64)
    return samples.astype(np.float64)

"""Whether what looks like noise is larger where signals are: then it is no noise."""

from __future__ import annotations

import numpy as np

from hystbench.gap.fitting.state import ModelState
from hystbench.gap.locate.forms import effective_count, f_test
from hystbench.gap.thresholds import AS_GOOD, BY_CHANCE
from hystbench.record import FloatArray


def size_follows(state: ModelState) -> bool:
    """Tell whether the squares of a residual follow those of known signals.

    Noise of a sensor has its size whatever the device does. A gain that is modulated,
    or a disturbance that a motion makes, is larger where there is more of the motion,
    though it follows none. The squares of the input, of the simulated output and of
    their rates are fitted to those of the residual by least squares, all about their
    means in each record: levels that differ only between records are not seen. An F
    test at 5 % tells chance, for as many samples as are independent; of noise as slow
    as a record it lets more pass. A share that would be nothing of a gap is none here.

    Parameters
    ----------
    state : ModelState
    """
    signals: list[list[FloatArray]] = [[] for _ in range(4)]
    for record, y in zip(state.records, state.exact, strict=True):
        u = record.u - np.mean(record.u)
        z = y - np.mean(y)
        for kind, own in zip(signals, (u, z, _rate(u), _rate(z)), strict=True):
            kind.append(own**2)
    taken = [state.sample.take(kind) for kind in signals]
    design = np.column_stack([state.sample.about_means(x) for x in taken])
    sizes = np.sqrt(np.mean(design**2, axis=0))
    # The square of a square wave does not vary.
    varies = sizes > 1e-6 * np.mean(taken, axis=1)
    design = design[:, varies] / sizes[varies]
    squares = state.sample.about_means(state.residual**2)
    weights, _, rank, _ = np.linalg.lstsq(design, squares, rcond=1e-8)
    fitted = design @ weights
    rest = squares - fitted
    power = float(squares @ squares)
    if rank == 0 or power == 0.0:
        return False
    share = 1.0 - float(rest @ rest) / power
    count = effective_count(state.sample.slices, rest, fitted)
    return share > AS_GOOD and f_test(share, float(rank), count) < BY_CHANCE


def _rate(signal: FloatArray) -> FloatArray:
    return np.gradient(signal) if len(signal) > 1 else np.zeros_like(signal)

"""A plain base for records of which no model is given: a loop of play operators."""

from collections.abc import Sequence

import numpy as np

from hystbench.blocks import block_class
from hystbench.model import Model
from hystbench.operators import play
from hystbench.record import Record

OPERATORS = 10
"""Play operators, the first of threshold zero: the input itself."""


def loop_of_plays(records: Sequence[Record]) -> Model:
    """Fit a gain, an offset and play operators to records, by least squares.

    ``y = g (u + sum_i w_i P_i[u]) + c``: a hysteresis that does not depend on the rate.

    Parameters
    ----------
    records : sequence of Record
        All of one input and output.

    Returns
    -------
    Model
        A ``prandtl-ishlinskii`` block and a ``gain``.
    """
    amplitude = max(float(np.abs(record.u).max()) for record in records)
    thresholds = amplitude * np.arange(OPERATORS) / OPERATORS
    tables, outputs = [], []
    for record in records:
        plays = play(record.u, thresholds)[0]
        weight = 1 / np.sqrt(len(record))  # a record counts once, however long
        tables.append(weight * np.column_stack([np.ones(len(record)), plays]))
        outputs.append(weight * record.y)
    table, y = np.vstack(tables), np.concatenate(outputs)
    size = np.linalg.norm(table, axis=0)
    size[size == 0] = 1.0
    offset, *weights = np.linalg.lstsq(table / size, y, rcond=1e-6)[0] / size
    reach = max(float(np.ptp(r.y)) for r in records) / (2 * amplitude)
    gain = max(abs(sum(weights)), 1e-3 * reach)
    shares = np.array(weights) / gain
    shares[0] -= 1.0  # the block has the input itself beside its operators
    return Model(
        "loop of play operators",
        records[0].input,
        records[0].output,
        (
            block_class("prandtl-ishlinskii").from_mapping(
                {"thresholds": thresholds.tolist(), "weights": shares.tolist()}
            ),
            block_class("gain").from_mapping({"value": gain, "offset": float(offset)}),
        ),
    )

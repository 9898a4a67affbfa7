"""The worked example: a slow-loop model as the simulator, faster records as the data.

This is the paper's own story. The model that Algorithm 1 identifies from the 1 Hz loop
knows no rate; the twin's records from 10 Hz on do. The records are a simulation, never
measured data, and no blind test: twin and effects share their blocks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.files import write_csv, write_text
from hystbench.model import Model
from hystbench.periods import find_period
from hystbench.record import Channel, Record, column_name
from hystbench.yaml_files import yaml_text

NAME = "twin"
WRITTEN = ("base.yaml", "dataset/dataset.yaml", "dataset/*.csv")
"""Files of the example, as names or patterns."""


def write_example(
    fit: Sequence[Record],
    hold_out: Sequence[Record],
    identified: Mapping[str, Any],
    folder: Path,
) -> None:
    """Write the records as a dataset and the identified model as the base.

    Parameters
    ----------
    fit, hold_out : sequence of Record
        Records of the twin.
    identified : mapping
        What ``hystbench job identify`` wrote.
    folder : Path
        Gets ``dataset/`` and ``base.yaml``.
    """
    first = fit[0]
    columns = [
        "time_s",
        *(column_name(item.name, item.unit) for item in (first.input, first.output)),
    ]
    entries = []
    for use, records in (("fit", fit), ("hold-out", hold_out)):
        for record in records:
            file = f"{record.name}.csv"
            table = np.column_stack([record.time, record.u, record.y])
            rows = ([repr(value) for value in row] for row in table.tolist())
            write_csv(folder / "dataset" / file, columns, rows)
            period = find_period(record.u)
            repeated = {} if period is None else {"period_samples": period}
            entries.append({"file": file, "use": use, **repeated})
    about = {
        "name": NAME,
        "description": "Records of the twin, a simulation; not measured.",
        "time": {"column": columns[0], "unit": "s"},
        "input": {"column": columns[1], "unit": first.input.unit},
        "output": {"column": columns[2], "unit": first.output.unit},
        "records": entries,
    }
    write_text(folder / "dataset" / "dataset.yaml", yaml_text(about))
    slow_loop_model(identified, first.input, first.output).save(folder / "base.yaml")


def slow_loop_model(
    identified: Mapping[str, Any], given: Channel, measured: Channel
) -> Model:
    """Give the model that Algorithm 1 identified, as a chain of blocks.

    Parameters
    ----------
    identified : mapping
        What ``hystbench job identify`` wrote.
    given, measured : Channel
        Input and output of the records.
    """
    start = identified["start"]
    chain: list[Block] = [
        GeneralizedPrandtlIshlinskii.from_mapping(
            {key: identified[key] for key in ("envelope", "thresholds", "weights")}
            | ({} if start == "rest" else {"start": start})
        )
    ]
    if identified["offset"]:
        chain.append(Gain(value=1.0, offset=identified["offset"]))
    return Model("gpi-of-the-slow-loop", given, measured, tuple(chain))

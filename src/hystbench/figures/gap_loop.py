"""A loop of a hold-out record: the simulator, and the same with what it lacked."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from hystbench.figures import style
from hystbench.figures.data import last_cycles
from hystbench.files import read_json
from hystbench.metrics import rms
from hystbench.record import load_record


def draw(*, records: Sequence[Path], table: Path) -> Figure:
    """Draw the last cycle of a record, before on the left and after on the right.

    Parameters
    ----------
    records : sequence of Path
        The archive of the record that was held out.
    table : Path
        Its table in the folder ``holdout`` of a gap, beside the gap's ``gap.json``.
    """
    record = load_record(*records)
    before, after = np.loadtxt(
        table, delimiter=",", skiprows=1, usecols=(2, 3), unpack=True, ndmin=2
    )
    gap = read_json(table.parents[1] / "gap.json")
    names = " and ".join(item["name"] for item in gap["effects"]) or "nothing added"
    numbers = gap.get("base_parameters", {}).values()
    if any(number["after"] != number["before"] for number in numbers):
        names += ", re-tuned"
    part = last_cycles(record, 1)
    figure = Figure(figsize=(style.PAGE, 3.0))
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    lines = {"the simulator": before, f"with {names}": after}
    looks: list[dict[str, Any]] = [{"color": style.VERMILION}, {"color": style.BLUE}]
    for axes, (title, output), look in zip(panels, lines.items(), looks, strict=True):
        axes.plot(record.u[part], record.y[part], **style.BEHIND)
        axes.plot(record.u[part], output[part], **look)
        left = rms(record.y - output)
        unit = style.unit_text(record.output.unit)
        axes.set_title(f"{title}: {left:.2g} {unit} rms off")
        axes.set_xlabel(style.axis_label(record.input))
    panels[0].set_ylabel(style.axis_label(record.output))
    title = f"{style.signal_title(record.name)}, {record.origin}"
    style.legend_above(
        figure,
        [
            style.key(title, **style.BEHIND),
            style.key("simulator", **looks[0]),
            style.key(f"simulator with {names}", **looks[1]),
        ],
    )
    return figure

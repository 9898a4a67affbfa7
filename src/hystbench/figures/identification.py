"""Identification: J by iteration, the envelope functions and the slow loop."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hystbench.envelope import PUBLISHED_ENVELOPE, Envelope
from hystbench.figures import style
from hystbench.files import read_json
from hystbench.identification import Identification, fit_weights
from hystbench.record import Record, load_record

_IDENTIFIED: dict[str, Any] = {"color": style.BLUE, "linestyle": "-"}
_PUBLISHED: dict[str, Any] = {"color": style.VERMILION, "linestyle": (0, (4, 2))}


def draw(*, identified: Path, records: Sequence[Path]) -> Figure:
    """Draw what Algorithm 1 found on the slow record.

    The published envelope functions are drawn where they were compared, on the twin:
    they are the paper's actuator's.

    Parameters
    ----------
    identified : Path
        Result of the identification.
    records : sequence of Path
        The slow record.
    """
    record = load_record(*records)
    found = _read(identified)
    models = {"identified": (found, _IDENTIFIED)}
    if found.published_relative_error is not None:
        published = fit_weights(
            record.u,
            record.y,
            PUBLISHED_ENVELOPE,
            len(found.weights) - 1,
            offset=found.offset != 0,
            start=found.start,
        )
        models["published"] = (published, _PUBLISHED)

    figure = Figure(figsize=(style.PAGE, 2.9))
    progress, envelopes, loop = figure.subplots(1, 3)
    _progress(progress, found, record)
    loop.plot(record.u, record.y, **style.BEHIND)
    handles = [style.key(f"{record.origin}, {record.name}", **style.BEHIND)]
    for name, (model, line) in models.items():
        _envelopes(envelopes, model, record, **line)
        loop.plot(record.u, model.simulate(record.u), **line)
        label = f"{name} envelopes (RE {model.relative_error:.2g})"
        handles.append(style.key(label, **line))
    envelopes.set(
        xlabel=style.axis_label(record.input),
        ylabel=r"envelope / $\max\{\gamma_r, \gamma_l\}$ (-)",
    )
    loop.set(
        xlabel=style.axis_label(record.input), ylabel=style.axis_label(record.output)
    )
    style.letter([progress, envelopes, loop])
    style.legend_above(figure, handles)
    return figure


def _progress(axes: Axes, found: Identification, record: Record) -> None:
    """Draw J and the J that Algorithm 1 is asked for."""
    steps = np.arange(1, len(found.cost_history) + 1)
    axes.semilogy(steps, found.cost_history, marker=".", **_IDENTIFIED)
    axes.axhline(found.epsilon, color=style.BLACK, linestyle=":", linewidth=0.8)
    axes.annotate(
        r"tolerable $\varepsilon$",
        (0.03, found.epsilon),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        fontsize="small",
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    unit = style.unit_text(f"{record.output.unit}^2")
    axes.set(xlabel="iteration (-)", ylabel=f"$J$ ({unit})")


def _envelopes(axes: Axes, model: Identification, record: Record, **line: Any) -> None:
    """Draw both envelopes in units of the factor max{...} of Eq. 10.

    Envelopes and thresholds times a constant, with weights over it, are the same
    model: only their shape can be compared.
    """
    count = len(model.thresholds)
    # Eq. 10: the last threshold is N / (N + 1) of that factor.
    largest = model.thresholds[-1] * count / (count - 1)
    v = np.linspace(record.u.min(), record.u.max(), 201)
    axes.plot(v, model.envelope.left(v) / largest, **line)
    axes.plot(v, model.envelope.right(v) / largest, **line)


def _read(path: Path) -> Identification:
    about = read_json(path)
    return Identification(
        envelope=Envelope(**about["envelope"]),
        thresholds=np.array(about["thresholds"]),
        weights=np.array(about["weights"]),
        offset=about["offset"],
        amplitude=about["amplitude"],
        start=about["start"],
        cost=about["J_final"],
        cost_history=tuple(about["J"]),
        epsilon=about["epsilon"],
        relative_error=about["relative_error"],
        starts=about["starts"],
        published_relative_error=about["published_relative_error"],
    )

"""Panels that several figures share: a record with a model's output over it."""

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from hystbench.figures import style
from hystbench.figures.data import Output
from hystbench.record import FloatArray, Record


def loop(axes: Axes, record: Record, output: Output, part: slice) -> None:
    """Draw output against input."""
    axes.plot(record.u[part], record.y[part], **style.BEHIND)
    if _reaches(axes, record, output, part):
        axes.plot(record.u[part], output.y[part], **style.look(output.run.model).line)


def in_time(axes: Axes, record: Record, output: Output, part: slice) -> None:
    """Draw both outputs over time."""
    axes.plot(*style.thin(record.time[part], record.y[part]), **style.BEHIND)
    if _reaches(axes, record, output, part):
        line = style.look(output.run.model).line
        axes.plot(*style.thin(record.time[part], output.y[part]), linewidth=1.0, **line)


def error_in_time(axes: Axes, record: Record, output: Output, part: slice) -> None:
    """Draw the error, the record's output minus the model's, over time."""
    if _reaches(axes, record, output, part):
        _error(axes, output, *style.thin(record.time[part], output.error[part]))


def error_over_input(axes: Axes, record: Record, output: Output, part: slice) -> None:
    """Draw the error, the record's output minus the model's, over the input."""
    if _reaches(axes, record, output, part):
        _error(axes, output, record.u[part], output.error[part])


def _error(axes: Axes, output: Output, x: FloatArray, y: FloatArray) -> None:
    axes.plot(x, y, color=style.look(output.run.model).color, linewidth=0.6)


def _reaches(axes: Axes, record: Record, output: Output, part: slice) -> bool:
    """Tell whether a run reached the end of a part; where not, the panel says so."""
    reached: bool = len(output.y) >= part.stop
    if not reached:
        say_diverged(axes, record, output)
    return reached


def say_diverged(axes: Axes, record: Record, output: Output) -> None:
    """Mark a panel whose run ended before the part that is shown."""
    axes.text(
        0.5,
        0.5,
        f"\N{MULTIPLICATION SIGN} diverged\nafter {len(output.y) * record.dt:.3g} s",
        color=style.look(output.run.model).color,
        fontsize="small",
        transform=axes.transAxes,
        horizontalalignment="center",
        verticalalignment="center",
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
        in_layout=False,
    )


def handles(record: Record, models: Iterable[str]) -> list[Line2D]:
    """Legend of a record, named by its origin, and of models."""
    return [
        style.key(record.origin, **style.BEHIND),
        *style.handles(models),
    ]

"""Figure 3: input and output of the play operator (Eqs. 1 and 2)."""

from __future__ import annotations

from matplotlib.figure import Figure

from hystbench.figures import style
from hystbench.figures.arrows import arrows, sweep
from hystbench.operators import play

# Amplitudes of the two loops, in thresholds.
_LARGE, _SMALL = 3.0, 1.9


def draw() -> Figure:
    """Draw a large and a small loop, input and output given in thresholds r."""
    figure = Figure(figsize=(style.COLUMN, 2.9))
    axes = figure.subplots()
    for amplitude, color, dashes in (
        (_LARGE, style.BLUE, "-"),
        (_SMALL, style.VERMILION, (0, (4, 2))),
    ):
        # From rest at the lower end, so that the loop is closed.
        v = sweep([-amplitude, amplitude, -amplitude])
        outputs, _ = play(v, [1.0], state=[1.0 - amplitude])
        w = outputs[:, 0]
        label = f"amplitude {amplitude:g} $r$"
        axes.plot(v, w, color=color, linestyle=dashes, linewidth=1.4, label=label)
        arrows(axes, v, w, (0.09, 0.36, 0.59, 0.86), color)
    for sign, name, align in ((-1, "$w = v - r$", "left"), (1, "$w = v + r$", "right")):
        axes.annotate(
            name,
            (-0.55 * sign, -0.55 * sign + sign),
            xytext=(-8 * sign, 0),
            textcoords="offset points",
            horizontalalignment=align,
            verticalalignment="center",
        )
    axes.set(
        xlabel="input $v / r$ (-)",
        ylabel="output $w / r$ (-)",
        xticks=range(-3, 4),
        yticks=range(-2, 3),
    )
    style.legend_above(figure, axes.get_lines())
    return figure

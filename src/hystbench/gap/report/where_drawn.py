"""Which pictures of where the gap is can be drawn, and which cannot and why."""

from __future__ import annotations

from collections.abc import Callable

from hystbench.gap.locate.view import percent
from hystbench.gap.report import pictures, where
from hystbench.gap.report.pictures import Picture, draw
from hystbench.gap.report.read import Content

#: Why a curve is null.
WHY = {
    "distortion": "distortion, as no record repeats with a gap above the noise",
    "over_plane": "the input and its rate together, as the input never moves",
    "loops": "areas of loops, as the input never moves",
    "levels": "modes by level, as no three levels of a broadband input show one",
    "coherence": "coherence, as records are too short or the input never moves",
}


def _rows(names: list[str]) -> float:
    """Give the height in inches that as many bars need, that of a curve at least."""
    return max(2.4, 0.8 + 0.16 * min(len(names), pictures.BARS))


def pictures_of(content: Content) -> tuple[list[Picture], list[str]]:
    """Draw the curves that are there, and name those that are not."""
    curves = content.curves
    if curves is None:
        return [], ["curves.json: no pictures of where the gap is"]
    units = curves.get("units") or {"input": "", "output": content.gap["unit"]}
    plans: list[tuple[tuple[str, ...], Callable[[], Picture]]] = [
        (
            ("spectrum",),
            lambda: draw(
                where.spectrum,
                curves["spectrum"],
                units["output"],
                words="Spectrum of the residual beside the simulation and the floor",
            ),
        ),
        (
            ("response",),
            lambda: draw(
                where.response,
                curves["response"],
                words="Best linear approximation of measurement over simulation; "
                "dashed where the simulation is right",
                height=2.0,
                panels=(1, 3),
            ),
        ),
        (
            ("over_input", "over_rate"),
            lambda: draw(
                where.maps,
                curves.get("over_input"),
                curves.get("over_rate"),
                units,
                words="Residual over the input, by branch, and over the input's rate; "
                "noise floor grey",
                panels=(1, 2),
            ),
        ),
        (
            ("over_plane",),
            lambda: draw(
                where.plane,
                curves["over_plane"],
                units,
                words="How to read it: a cell shows by how much the measurement lies "
                "above (red) or below (blue) the simulation, in the mean, where the "
                "input had that value and moved at that rate; above zero it rises, "
                "below it falls; grey cells have few samples. These cells hold "
                f"{percent(curves['over_plane']['share'])} of the gap",
                height=3.2,
            ),
        ),
        (
            ("loops", "coherence"),
            lambda: draw(
                where.loops,
                curves.get("loops"),
                curves.get("coherence"),
                units,
                words="Area of the loop, output over input, at each frequency (bars: "
                "two standard errors), and coherence of the gap with the input",
                panels=(1, 2),
            ),
        ),
        (
            ("levels",),
            lambda: draw(
                where.levels,
                curves["levels"]["modes"],
                units["input"],
                words="How modes move when the input grows; a linear device's stay. "
                "Damping is told by power: what the input puts in, over the mean "
                "square velocity; a curved spring widens the peak and leaves this "
                "alone. Bars: standard errors",
                height=2.4,
                panels=(1, 3),
            ),
        ),
        (
            ("distortion",),
            lambda: draw(
                where.distortion,
                curves["distortion"],
                units["output"],
                words="Distortion: lines of the residual of one periodic record, and "
                "what lies on them in each; above the noise floor",
                height=_rows(curves["distortion"]["record"]),
                panels=(1, 2),
            ),
        ),
        (
            ("slow",),
            lambda: draw(
                where.slow,
                curves["slow"],
                units["output"],
                words="Mean of the residual over slow time, record behind record",
                height=2.6,
            ),
        ),
        (
            ("records",),
            lambda: draw(
                pictures.bars,
                curves["records"]["name"],
                [100 * share for share in curves["records"]["share"]],
                "share of the gap's power (%)",
                words="Share of the gap's power in each fit record",
                height=0.6 + 0.2 * len(curves["records"]["name"]),
            ),
        ),
    ]
    drawn, missing = [], []
    for keys, make in plans:
        missing += [
            WHY[key] if key in WHY and key in curves else f"curves.json: no {key}"
            for key in keys
            if not curves.get(key)
        ]
        if any(curves.get(key) for key in keys):
            drawn.append(make())
    return drawn, missing

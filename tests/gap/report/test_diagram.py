"""The block diagram as it is drawn."""

import io
import itertools
from dataclasses import replace

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import FancyBboxPatch
from matplotlib.text import Text

from hystbench.figures.style import PAGE, in_style
from hystbench.gap.report.diagram import figure_of, words_of
from tests.gap.report.test_parts import (
    FELT,
    FRICTION,
    IMPEDANCE,
    MECHANISM,
    OTHERS,
    PLAYS,
    effect,
    gap,
    model,
)

LAG = {"sensor-lag": {"time_constant_s": 0.0008441}}
LAGGING = effect("sensor-lag", "sensor", time_constant_s=(0.0008441, "s"))
MODE = {
    "resonance": {"frequency_hz": 63.0, "damping_ratio": 0.01, "participation": -0.2}
}
STORES = [
    {
        "store": {
            "gain": 1.0,
            "rate": 0.1,
            "exponent": 1.5,
            "height": 801.0,
            "caught": 0.28,
            "output": "outflow",
        }
    },
    {"store": {"gain": 1.0, "rate": 0.2, "exponent": 0.3}},
]
CASES = {
    "a chain in series": (model(PLAYS, MODE, LAG), gap(LAGGING)),
    "friction inside, a delay before": (
        model({"input-delay": {"delay_s": 0.00286}}, MECHANISM, FRICTION),
        gap(FELT, effect("input-delay", "before", delay_s=(0.00286, "s"))),
    ),
    "an impedance with a force and a lag": (
        model({"drive-lag": {"time_constant_s": 0.025}}, IMPEDANCE, FRICTION),
        gap(FELT, effect("drive-lag", "before", time_constant_s=(0.025, "s"))),
    ),
    "a mode with others beside it and friction inside": (
        model(MECHANISM, FRICTION, OTHERS),
        gap(FELT),
    ),
    "two stores": (
        model(*STORES),
        gap(
            effect("outflow", blocks=["store", "store#2"], exponent=(1.5, "-")),
            effect("overflow", blocks=["store"], height=(801.0, "V s")),
        ),
    ),
    "many blocks": (
        model(PLAYS, *[LAG, MODE] * 6, {"external": {"function": "a_rig.of_ours:run"}}),
        gap(LAGGING, put_in=[effect("resonance", frequency_hz=(63.0, "Hz"))]),
    ),
}


@pytest.fixture(params=CASES)
def figure(request):
    with in_style():
        drawn = figure_of(*CASES[request.param])
        FigureCanvasAgg(drawn).draw()
    return drawn


def texts(figure):
    return [text for text in figure.findobj(Text) if text.get_text()]


def test_texts_are_legible_apart_and_inside(figure):
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
    assert all(text.get_fontsize() >= 6 for text in texts(figure))
    for (one, box), (other, place) in itertools.combinations(boxes, 2):
        assert not box.padded(-1).overlaps(place.padded(-1)), f"{one!r} over {other!r}"
    for text, box in boxes:
        assert figure.bbox.contains(*box.min), text
        assert figure.bbox.contains(*box.max), text


def test_every_text_of_a_box_fits_in_it(figure):
    """The layout only guesses how wide letters are."""
    patches = figure.findobj(FancyBboxPatch)
    edges = [patch.get_window_extent() for patch in patches]
    for text in texts(figure):
        words = text.get_window_extent()
        middle = (words.min + words.max) / 2
        holding = [edge for edge in edges if edge.contains(*middle)]
        if holding:  # what stands beside a box is no name of one
            smallest = min(holding, key=lambda edge: edge.width * edge.height)
            assert smallest.x0 < words.x0
            assert words.x1 < smallest.x1


def test_it_is_as_wide_as_a_page(figure):
    assert figure.get_figwidth() == PAGE


def test_the_key_names_what_is_there():
    with in_style():
        plain = figure_of(model(PLAYS, LAG), gap())
        whole = figure_of(*CASES["many blocks"])
    key = {"the simulator", "added by the search", "put in by you"}
    assert key & {text.get_text() for text in texts(plain)} == {"the simulator"}
    assert key <= {text.get_text() for text in texts(whole)}


def test_names_are_no_formulas():
    """Matplotlib would take what stands between two dollars for one."""
    rig = model(PLAYS)
    named = replace(rig, input=replace(rig.input, name="$u_1$"))
    with in_style():
        figure = figure_of(named, gap())
    (label,) = [text for text in texts(figure) if "u_1" in text.get_text()]
    assert label.get_text() == "$u_1$ (N)"
    assert not label.get_parse_math()


def test_the_same_bytes_each_time():
    def written():
        stream = io.BytesIO()
        with in_style():
            about = {"Date": None, "Creator": None}
            figure_of(*CASES["two stores"]).savefig(
                stream, format="svg", metadata=about
            )
        return stream.getvalue()

    assert written() == written()


def test_it_is_told_in_words():
    assert words_of(*CASES["two stores"]) == (
        "Block diagram: force, then store with outflow in it and overflow above it, "
        "then store with outflow in it, then position"
    )

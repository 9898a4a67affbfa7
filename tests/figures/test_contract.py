"""What every figure keeps to; a new figure is tested by being in the registry."""

import inspect
import itertools
import re
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.text import Text
from matplotlib.transforms import Bbox

import hystbench.figures
from hystbench.errors import InputError
from hystbench.figures import FIGURES, drawer, style
from tests.figures.palette import PALETTE

#: Axes that name categories, not a quantity.
CATEGORIES = {"model", "signal", "effect", "hidden effect", "first answer"}
#: Smallest type that is legible in print (points).
LEGIBLE = 6.0
REPORT = Path(__file__).parents[2] / "workflow" / "report"


@pytest.fixture(params=FIGURES, scope="module")
def name(request):
    return request.param


@pytest.fixture(scope="module")
def made(name, inputs, tmp_path_factory):
    """A figure, laid out and drawn; the bytes of its file; and the texts in it."""
    path = tmp_path_factory.mktemp("figure") / "figure.svg"
    with style.in_style():
        figure = drawer(name)(**inputs.of(name))
        style.save(figure, path)
    return figure, path.read_bytes(), texts_of(figure)


@pytest.fixture
def drawn(made):
    return made[0]


def texts_of(figure):
    """Draw; give all texts that are drawn, ticks beyond the limits left out."""
    found = []
    draw = Text.draw

    def record(self, renderer):
        if self.get_visible() and self.get_text().strip():
            found.append(self)
        return draw(self, renderer)

    with pytest.MonkeyPatch.context() as patch, style.in_style():
        patch.setattr(Text, "draw", record)
        FigureCanvasAgg(figure).draw()
    return found


def test_a_file_is_small(made):
    assert len(made[1]) < 500_000


def quantity(axes, of):
    """Label of an axis: its own, that of an axis it is shared with, or the figure's."""
    shared = getattr(axes, f"get_shared_{of}_axes")().get_siblings(axes)
    own = [getattr(each, f"get_{of}label")() for each in shared]
    whole = getattr(axes.figure, f"get_sup{of}label")()
    return next(filter(None, own), whole)


def test_every_axis_has_a_label_with_a_unit(drawn):
    for axes in drawn.axes:
        if axes.get_label() == "<colorbar>":
            labels = [axes.get_ylabel()]
        else:
            labels = [quantity(axes, "x"), quantity(axes, "y")]
        for label in labels:
            assert label in CATEGORIES or label.endswith(")"), label


def test_legend_names_something_and_hides_no_data(drawn):
    (legend,) = drawn.legends
    assert legend.get_texts()
    for axes in drawn.axes:
        assert axes.get_legend() is None
        assert not legend.get_window_extent().overlaps(axes.get_window_extent())


def test_texts_are_legible_apart_and_inside(made):
    drawn, _, texts = made
    assert len(texts) > 5
    # A pixel of three hundred an inch may touch.
    boxes = [(text.get_text(), text.get_window_extent().padded(-1)) for text in texts]
    for text in texts:
        assert text.get_fontsize() >= LEGIBLE, text
    for (one, box), (other, other_box) in itertools.combinations(boxes, 2):
        assert not box.overlaps(other_box), f"{one!r} over {other!r}"
    page = drawn.bbox
    for text, box in boxes:
        assert page.containsx(box.x0), text
        assert page.containsx(box.x1), text
        assert page.containsy(box.y0), text
        assert page.containsy(box.y1), text


def test_the_check_for_overlap_sees_one():
    figure = mpl.figure.Figure()
    figure.text(0.5, 0.5, "one")
    figure.text(0.51, 0.5, "other")
    one, other = (t.get_window_extent() for t in texts_of(figure))
    assert Bbox.overlaps(one, other)


def test_colours_are_those_of_the_palette(drawn):
    lines = [line for axes in drawn.axes for line in axes.get_lines()]
    for line in lines:
        assert to_hex(line.get_color()).upper() in PALETTE, line


def test_width_fits_a_page(drawn):
    assert drawn.get_figwidth() <= style.PAGE


def test_takes_only_keywords_that_the_command_has(name):
    parameters = inspect.signature(drawer(name)).parameters
    assert {p.kind for p in parameters.values()} <= {inspect.Parameter.KEYWORD_ONLY}
    assert set(parameters) <= {"records", "runs", "table", "identified"}


def test_has_a_caption(name):
    assert (REPORT / f"{name}.rst").read_text(encoding="utf-8").strip()


def test_every_function_that_draws_is_registered():
    folder = Path(hystbench.figures.__file__).parent
    drawing = {
        (path.stem, function)
        for path in folder.glob("*.py")
        for function in re.findall(
            r"^def (draw(?:_\w+)?)\(", path.read_text(encoding="utf-8"), re.MULTILINE
        )
    }
    assert drawing == {(module, function) for module, function, *_ in FIGURES.values()}


def test_unknown_figure_gets_the_nearest_name():
    with pytest.raises(InputError, match="did you mean 'figure-03-play'"):
        drawer("figure-3-play")

"""Units, names and colours of figures, and that the reader's own style stays."""

import subprocess
import sys

import matplotlib as mpl
import pytest

from hystbench.errors import InputError
from hystbench.figures import style
from tests.figures.palette import PALETTE


@pytest.mark.parametrize(
    ("unit", "printed"),
    [
        ("um", "µm"),
        ("um^2", "µm²"),
        ("uC/cm2", "µC/cm²"),
        ("uA", "µA"),
        ("m^3/s", "m³/s"),
        ("mm", "mm"),
        ("N", "N"),
        ("unit", "unit"),
        ("1/s", "1/s"),
        ("-", "-"),
    ],
)
def test_units_are_printed_as_in_a_paper(unit, printed):
    assert style.unit_text(unit) == printed


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("sine-001hz", "1 Hz sine"),
        ("sine-200hz", "200 Hz sine"),
        ("chirp-1-100hz", "1 to 100 Hz chirp"),
        ("multisine-10-30-50hz", "sum of 10, 30, 50 Hz"),
        ("multisine-random-0-100hz", "random sum, 0 to 100 Hz"),
        ("run-b1", "run-b1"),
    ],
)
def test_signals_of_the_paper_are_put_in_words(name, title):
    assert style.signal_title(name) == title


def test_models_differ_in_colour_line_and_marker():
    looks = style.PAPER.values()
    for part in ("label", "color", "dashes", "marker"):
        assert len({getattr(look, part) for look in looks}) == len(looks)
    assert {look.color for look in looks} <= PALETTE


def test_a_users_own_style_changes_nothing_and_comes_back():
    with mpl.rc_context({"font.size": 30, "lines.linewidth": 9}):
        with style.in_style():
            assert mpl.rcParams["font.size"] == 8
            assert mpl.rcParams["lines.linewidth"] == 1
        assert mpl.rcParams["font.size"] == 30


def test_only_png_and_svg_are_written(tmp_path):
    with pytest.raises(InputError, match=r"'\.gif' is no format"):
        style.save(mpl.figure.Figure(), tmp_path / "a.gif")
    assert not list(tmp_path.iterdir())


def test_unknown_model_gets_the_nearest():
    with pytest.raises(InputError, match="did you mean 'volterra'"):
        style.look("voltera")


def test_drawing_needs_no_pyplot():
    code = (
        "import sys\n"
        "from hystbench.figures import drawer, style\n"
        "drawer('figure-04-generalized-play')()\n"
        "assert not {'matplotlib.pyplot', 'pandas'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)

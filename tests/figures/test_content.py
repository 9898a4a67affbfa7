"""What figures show, against what they were given."""

import numpy as np
import pytest

from hystbench.envelope import PUBLISHED_ENVELOPE
from hystbench.figures import drawer, style
from hystbench.published import load_text
from tests.figures.inputs import (
    DIVERGED,
    HALVES,
    MODELS,
    SAMPLES,
    SIGNALS,
    Inputs,
    a_record,
    save_a_run,
)


def draw(name, **given):
    with style.in_style():
        return drawer(name)(**given)


def words(figure):
    return [text.get_text() for axes in figure.axes for text in axes.texts]


def legend(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_play_operator_ends_a_threshold_short_of_the_input():
    figure = draw("figure-03-play")
    for line in figure.axes[0].get_lines():
        v, w = line.get_data()
        assert w.max() == pytest.approx(v.max() - 1)
        assert w.min() == pytest.approx(v.min() + 1)
        assert np.abs(v - w).max() <= 1 + 1e-12
        assert w[0] == pytest.approx(w[-1])


def test_generalized_play_runs_between_its_envelopes_and_closes():
    left, _, loop = draw("figure-04-generalized-play").axes[0].get_lines()
    v, w = loop.get_data()
    r = left.get_ydata()[0] - PUBLISHED_ENVELOPE.left(left.get_xdata()[0])
    assert r > 0
    assert (w <= PUBLISHED_ENVELOPE.left(v) + r + 1e-12).all()
    assert (w >= PUBLISHED_ENVELOPE.right(v) - r - 1e-12).all()
    assert (v[0], w[0]) == pytest.approx((v[-1], w[-1]))
    # It reaches the right envelope at the upper end and the left one at the lower.
    assert w.max() == pytest.approx(PUBLISHED_ENVELOPE.right(v.max()) - r)
    assert w.min() == pytest.approx(PUBLISHED_ENVELOPE.left(v.min()) + r)


def test_order_sweep_draws_each_finite_error_and_marks_the_other(inputs):
    figure = draw("figure-07-order", **inputs.of("figure-07-order"))
    (axes,) = figure.axes
    curves = [line for line in axes.get_lines() if line.get_linestyle() != "None"]
    assert [len(line.get_xdata()) for line in curves] == [4, 4, 4, 3]
    np.testing.assert_allclose(curves[0].get_ydata(), 1 / np.array([1, 2, 5, 10]))
    crosses = [line for line in axes.get_lines() if line.get_marker() == "x"]
    assert [x for line in crosses for x in line.get_xdata()] == [10]
    assert axes.get_yscale() == "log"
    assert "µm²" in axes.get_ylabel()
    assert "diverged" in legend(figure)


def test_loops_show_one_full_cycle_of_record_and_model(inputs):
    figure = draw("figure-08-loops", **inputs.of("figure-08-loops"))
    loops, errors = figure.axes[::2], figure.axes[1::2]
    titles = [axes.get_title(loc="left") for axes in loops]
    assert titles == ["10 Hz sine", "20 Hz sine", "40 Hz sine"]
    for axes, below, period in zip(loops, errors, (100, 50, 25), strict=True):
        record, model = axes.get_lines()
        (error,) = below.get_lines()
        np.testing.assert_allclose(
            error.get_ydata(), record.get_ydata() - model.get_ydata(), atol=1e-12
        )
        np.testing.assert_array_equal(error.get_xdata(), model.get_xdata())
        assert len(record.get_xdata()) == len(model.get_xdata()) == period + 1
        # The cycle closes: the output comes back to where it was.
        assert record.get_ydata()[0] == pytest.approx(record.get_ydata()[-1])
        np.testing.assert_array_equal(record.get_xdata(), model.get_xdata())


def test_chirp_marks_the_moments_of_the_paper(inputs):
    figure = draw("figure-09-chirp", **inputs.of("figure-09-chirp"))
    text = load_text()
    for moment in (text.chirp_minimum, text.chirp_resonance):
        assert any(f"{moment.time_s} s in the paper" in word for word in words(figure))
    _, _, ranges, error = figure.axes
    for axes, drawn in ((ranges, 2), (error, 1)):
        moments = {line.get_xdata()[0] for line in axes.get_lines()[drawn:]}
        assert moments == {1.28, 1.41}


def test_chirp_is_zoomed_where_the_paper_has_its_resonance(inputs):
    _, zoom, ranges, error = draw(
        "figure-09-chirp", **inputs.of("figure-09-chirp")
    ).axes
    record, model, moment = zoom.get_lines()
    assert moment.get_xdata()[0] == load_text().chirp_resonance.time_s
    for line in (record, model):
        assert line.get_xdata()[0] == pytest.approx(1.408, abs=1e-3)
        assert line.get_xdata()[-1] == pytest.approx(1.411, abs=1e-3)
        assert np.ptp(line.get_xdata()) == pytest.approx(0.003, abs=1e-3)
    # The others show the whole record.
    assert np.ptp(error.get_lines()[0].get_xdata()) == pytest.approx(3.999)
    # A sine of 9 um has the same range in every cycle.
    np.testing.assert_allclose(ranges.get_lines()[0].get_ydata(), 18, rtol=5e-3)


def test_dense_records_make_small_files(tmp_path):
    record = a_record("sine-200hz", 200.0, 20_000)
    noisy = record.y + np.random.default_rng(1).normal(0, 0.1, len(record))
    record = type(record)(**{**vars(record), "y": noisy})
    record.save(tmp_path / "record.npz")
    run, _ = save_a_run(tmp_path, record, "gpo")
    for name in ("figure-09-chirp", "figure-11-sum", "figure-12-random-sum"):
        with style.in_style():
            figure = drawer(name)(records=[tmp_path / "record.npz"], runs=[run])
            style.save(figure, tmp_path / "figure.svg")
        assert (tmp_path / "figure.svg").stat().st_size < 500_000


def test_outputs_are_the_last_of_record_and_run(inputs):
    for name, seconds in (("figure-10-sum", 0.2), ("figure-11-sum", 0.4)):
        time, curves = draw(name, **inputs.of(name)).axes
        record = inputs.records[SIGNALS[0]]
        for axes, x in ((time, record.time), (curves, record.u)):
            line = axes.get_lines()[0]
            count = round(seconds / record.dt) + 1
            np.testing.assert_array_equal(line.get_xdata(), x[-count:])
            np.testing.assert_array_equal(line.get_ydata(), record.y[-count:])


@pytest.mark.parametrize("origin", ["twin", "measured"])
def test_a_record_is_called_what_it_is(tmp_path, origin):
    inputs = Inputs(tmp_path, origin)
    for name in ("figure-08-loops", "figure-09-chirp", "figure-10-sum", "loops"):
        assert legend(draw(name, **inputs.of(name)))[0] == origin
    assert legend(draw("identification", **inputs.of("identification")))[0] == (
        f"{origin}, {SIGNALS[0]}"
    )


def test_identification_shows_j_the_tolerable_one_and_both_models(inputs):
    given = inputs.of("identification")
    figure = draw("identification", **given)
    progress, envelopes, loop = figure.axes
    curve, tolerable = progress.get_lines()
    assert (np.diff(curve.get_ydata()) <= 0).all()
    assert len(set(tolerable.get_ydata())) == 1
    # Identified and published, a left and a right envelope each: at the amplitude the
    # larger one is the factor of Eq. 10, hence 1.
    lines = envelopes.get_lines()
    assert len(lines) == 4
    for left, right in (lines[:2], lines[2:]):
        amplitude = np.abs(inputs.records[SIGNALS[0]].u).max()
        assert left.get_xdata()[-1] == pytest.approx(amplitude, rel=1e-2)
        ends = left.get_ydata()[-1], right.get_ydata()[-1]
        assert max(ends) == pytest.approx(1, abs=0.02)
    assert len(loop.get_lines()) == 3
    assert [word.split(" (RE")[0] for word in legend(figure)[1:]] == [
        "identified envelopes",
        "published envelopes",
    ]


def test_learning_curves_leave_out_what_does_not_learn(inputs):
    figure = draw("learning-curves", **inputs.of("learning-curves"))
    assert "RDGPI model" not in legend(figure)
    for axes, signal in zip(figure.axes, SIGNALS, strict=True):
        lost = sum((signal, model) == DIVERGED for model in MODELS)
        crosses = [line for line in axes.get_lines() if line.get_marker() == "x"]
        assert len(crosses) == lost
        assert len(axes.get_lines()) == 4 + lost
        assert axes.get_yscale() == "log"


def test_learning_curves_keep_the_scale_of_the_finite_runs(inputs):
    both = draw("learning-curves", runs=inputs.runs(SIGNALS, MODELS[:4]))
    finite = draw("learning-curves", runs=inputs.runs(SIGNALS, ("gpo", "backlash")))
    assert both.axes[0].get_ylim()[1] < 100 * finite.axes[0].get_ylim()[1]


def test_heat_map_writes_each_ratio_and_frames_what_is_inconsistent(inputs):
    figure = draw("errors-heat-map", **inputs.of("errors-heat-map"))
    axes = figure.axes[0]
    said = words(figure)
    assert len(said) == len(SIGNALS) * len(MODELS)
    assert said[0] == "\N{MINUS SIGN}0.50"
    assert said[-1] == "+0.10"
    assert said[2] == "diverged"
    assert said[3] == "not run"
    assert [patch.get_linestyle() for patch in axes.patches] == ["-", ":"]
    marked = [
        title.get_text().endswith("\N{BLACK DIAMOND}")
        for title in axes.get_yticklabels()
    ]
    assert marked == [half == "held-out" for half in HALVES]
    assert "held out of the calibration" in legend(figure)
    colours = axes.collections[0]
    low, high = colours.get_clim()
    assert low == -high


def test_loops_say_which_run_diverged_and_when(inputs):
    figure = draw("loops", **inputs.of("loops"))
    (word,) = words(figure)
    assert f"after {SAMPLES * 1e-3:g} s" in word
    assert len(figure.axes) == len(SIGNALS) * len(MODELS)
    lines = [len(axes.get_lines()) for axes in figure.axes]
    assert sorted(lines) == [1, *[2] * (len(lines) - 1)]


def test_errors_stand_where_they_are(inputs):
    figure = draw("errors-by-record", **inputs.of("errors-by-record"))
    marks = [m for m in figure.axes[0].get_lines() if m.get_linestyle() == "None"]
    assert len(marks) == len(SIGNALS) * len(MODELS)
    crosses = [mark for mark in marks if mark.get_marker() == "x"]
    assert len(crosses) == 1
    # A model's mark lies in its record's row.
    rows = [round(float(mark.get_ydata()[0])) for mark in marks]
    assert rows == [n for n in range(len(SIGNALS)) for _ in MODELS]


def test_step_edges_stand_beside_both_bounds(inputs):
    figure = draw("step-edges", **inputs.of("step-edges"))
    assert len(figure.axes) == 4
    gpo, *_, delayed = figure.axes
    marks = sorted(
        (line.get_ydata()[0], line.get_xdata()[0])
        for line in gpo.lines
        if line.get_marker() != "None"
    )
    # As written: 1/max|H|^2, the edge and 1/tr R; the edge of the second moves.
    assert marks == [
        (0, pytest.approx(0.25)),
        (0, pytest.approx(0.3)),
        (0, pytest.approx(0.4)),
        (1, pytest.approx(0.25)),
        (1, pytest.approx(0.4)),
        (1, pytest.approx(0.4)),
    ]
    marked = [line for line in delayed.lines if line.get_marker() != "None"]
    assert len(marked) == 5  # an edge that was not reached has no mark


def test_a_gap_is_drawn_before_and_after_with_the_name(inputs):
    """The table's simulator lies 1 um above the record; nothing is left after."""
    before, after = draw("gap-loop", **inputs.of("gap-loop")).axes
    offs = [
        np.unique(np.round(axes.lines[1].get_ydata() - axes.lines[0].get_ydata(), 9))
        for axes in (before, after)
    ]
    assert [off.tolist() for off in offs] == [[1.0], [0.0]]
    assert "1 µm rms off" in before.get_title(loc="left") + before.get_title()
    assert "sensor-lag, re-tuned" in after.get_title(loc="left") + after.get_title()

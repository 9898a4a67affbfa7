"""What is said of a model file that is wrong in a way that is known."""

import numpy as np
import pytest
import yaml

from tests.gap.made import record, write_folder
from tests.gap.small import block
from tests.inspection.stage import STAGE, looked, saved, through, wave


def told(found, topic):
    return [item for item in found.findings if item.topic.startswith(topic)]


def of_stage(folder, **changes):
    model = saved(folder, block("mechanism", **STAGE | changes))
    return looked(folder, "stage", model, effects=False)


def write_one(folder, y):
    """Write one input with this output, and what is held out."""
    u = wave(0)
    made = [record(u, y, name="a"), record(u, y[::-1], name="b", use="hold-out")]
    write_folder(folder / "stage", made)


def test_nothing_is_said_of_a_model_that_fits(stage):
    assert not [item for item in of_stage(stage).findings if item.kind == "model"]


def test_units_that_are_a_thousand_off_are_told(stage):
    (one,) = told(of_stage(stage, gain=1e-3), "misfit")
    assert one.topic == "misfit header"
    gain = float(one.text.partition("Times ")[2].partition(",")[0])
    assert gain == pytest.approx(1000, rel=0.02)
    # Numbers a thousand times too large for um are in nm.
    (line,) = one.paste
    assert yaml.safe_load(line)["output"]["unit"] == "nm"
    assert yaml.safe_load(line)["output"]["meant"] is True


def test_another_sign_is_told_and_no_other_unit(stage):
    (one,) = told(of_stage(stage, gain=-1.0), "misfit")
    assert one.topic == "misfit units"
    assert "or its sign" in one.text
    assert not one.paste


def test_units_that_are_forty_off_are_no_other_prefix(stage):
    (one,) = told(of_stage(stage, gain=1 / 40), "misfit")
    assert one.topic == "misfit units"
    assert "Times 40, it would leave" in one.text
    assert not one.paste


def test_of_other_units_the_offset_is_told_where_one_is_needed(tmp_path):
    write_one(tmp_path, through(wave(0), block("mechanism", **STAGE)) + 0.3)
    (one,) = told(of_stage(tmp_path, gain=1e-3), "misfit")
    assert one.topic == "misfit header"
    assert "Times 1e+03, with 0.3 um added, it would leave" in one.text


def test_another_zero_is_told(tmp_path):
    write_one(tmp_path, through(wave(0), block("mechanism", **STAGE)) + 40.0)
    (one,) = told(of_stage(tmp_path), "misfit")
    assert one.topic == "misfit offset"
    assert "With 40 um added" in one.text


def test_a_position_for_a_velocity_is_told(tmp_path):
    moving = block("mechanism", **STAGE, output="velocity")
    write_one(tmp_path, through(wave(0), moving))
    (one,) = told(of_stage(tmp_path), "misfit")
    assert one.topic == "misfit rate"
    assert "Its rate of change, times 1," in one.text


def test_what_nothing_plain_would_mend_has_its_likely_reasons(stage):
    (one,) = told(of_stage(stage, stiffness=30.0), "misfit")
    assert one.topic == "misfit"
    assert "its units, the quantity that it gives" in one.text


def test_other_units_that_leave_half_of_it_are_no_likely_reason(tmp_path):
    """A missing effect is: a weight on an arm looks like another gain in part."""
    moves = through(wave(0), block("mechanism", **STAGE))
    rest = np.std(moves) * np.random.default_rng(1).standard_normal(len(moves))
    write_one(tmp_path, 0.6 * moves + 0.3 * rest)
    (one,) = told(of_stage(tmp_path), "misfit")
    assert one.topic == "misfit"
    assert "it lacks a strong effect" in one.text


def test_of_an_identified_base_neither_units_nor_start_are_doubted(tmp_path):
    """They are those of the records."""
    u = wave(0)
    rest = 0.3 * np.random.default_rng(1).standard_normal(len(u))
    made = [record(u, 0.3 * u + rest, name="a")]
    made.append(record(u[::-1], u, name="b", use="hold-out"))
    write_folder(tmp_path / "stage", made)
    found = looked(tmp_path, "stage", "linear", effects=False)
    (one,) = told(found, "misfit")
    assert (one.topic, one.kind) == ("misfit identified", "note")
    assert "units" not in one.text


def test_a_model_that_leaves_as_much_as_the_output_moves_explains_nothing(stage):
    """A thousandth of the gain leaves all but a thousandth; a stiff one a part."""
    (one,) = told(of_stage(stage, gain=1e-3), "misfit")
    assert "explains nothing: it leaves" in one.text
    (one,) = told(of_stage(stage, damping=0.5), "misfit")
    assert "leaves" in one.text
    assert "explains nothing" not in one.text


@pytest.mark.parametrize(
    ("blocks", "wanted"),
    [
        ([("mechanism", {**STAGE, "output": "velocity"})], "position"),
        (
            [
                ("mechanism", {**STAGE, "output": "acceleration"}),
                ("stiffness", {"quadratic": 0.0, "cubic": 1e-3}),
                ("sensor-lag", {"time_constant_s": 1e-3}),
            ],
            "position",
        ),
        ([("mechanism", STAGE)], ""),
        (
            [("mechanism", {**STAGE, "output": "velocity"}), ("gain", {"value": 2.0})],
            "",
        ),
        ([("gain", {"value": 2.0})], ""),
    ],
    ids=["velocity", "behind-it-a-sensor", "position", "behind-it-a-gain", "none"],
)
def test_an_output_of_another_quantity_than_the_records_is_told(stage, blocks, wanted):
    model = saved(stage, *(block(name, **about) for name, about in blocks))
    found = told(looked(stage, "stage", model, effects=False), "quantity")
    assert [item.paste for item in found] == [(f"output: {wanted}",)] * bool(wanted)


def test_a_force_for_a_motion_is_told(stage):
    """An impedance gives nothing else."""
    model = saved(stage, block("impedance", mass=0.0, damping=0.1, stiffness=1.0))
    (one,) = told(looked(stage, "stage", model, effects=False), "only force")
    assert "gives the force, but the records hold the position" in one.text


PERIOD = 400


def in_steady_state(folder, begun):
    """Check a model that begins so on records that hold two periods of ten."""
    made = []
    for seed, use in enumerate(("fit", "hold-out")):
        angle = 2 * np.pi * np.arange(10 * PERIOD) / PERIOD
        u = np.sin(2 * angle + seed) + 0.5 * np.sin(3 * angle)
        y = through(u, block("mechanism", **STAGE))
        noise = 1e-3 * np.random.default_rng(seed).standard_normal(2 * PERIOD)
        last = slice(-2 * PERIOD, None)
        about = {"use": use, "period_samples": PERIOD}
        made.append(record(u[last], y[last] + noise, name=f"r{seed}", **about))
    write_folder(folder / "stage", made)
    return of_stage(folder, start=begun)


def test_a_transient_that_the_records_do_not_have_is_told(tmp_path):
    (one,) = told(in_steady_state(tmp_path, "rest"), "start")
    assert one.paste == ("start: repeating",)
    assert "in mechanism of the model file" in one.text
    left = one.text.partition("It leaves ")[2].partition(" um rms")[0]
    assert float(left) == pytest.approx(1e-3, rel=0.2)  # the noise


def test_a_model_in_the_steady_state_is_not_told_so(tmp_path):
    assert not told(in_steady_state(tmp_path, "repeating"), "start")


def test_without_periods_no_start_is_asked_for(stage):
    assert not told(of_stage(stage, gain=0.7), "start")

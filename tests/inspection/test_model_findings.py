"""What is said of a model file that is wrong in a way that is known."""

import pytest

from tests.gap.made import record, write_folder
from tests.gap.small import block
from tests.inspection.stage import STAGE, looked, saved, through, wave


def told(found, topic):
    return [item for item in found.findings if item.topic.startswith(topic)]


def of_stage(folder, **changes):
    model = saved(folder, block("mechanism", **STAGE | changes))
    return looked(folder, "stage", model, effects=False)


def test_nothing_is_said_of_a_model_that_fits(stage):
    assert not [item for item in of_stage(stage).findings if item.kind == "model"]


def test_units_that_are_a_thousand_off_are_told(stage):
    (one,) = told(of_stage(stage, gain=1e-3), "misfit")
    assert one.topic == "misfit units"
    gain = float(one.text.partition("Times ")[2].partition(",")[0])
    assert gain == pytest.approx(1000, rel=0.02)


def test_another_zero_is_told(tmp_path):
    u = wave(0)
    y = through(u, block("mechanism", **STAGE)) + 40.0
    made = [record(u, y, name="a"), record(u, y[::-1], name="b", use="hold-out")]
    write_folder(tmp_path / "stage", made)
    (one,) = told(of_stage(tmp_path), "misfit")
    assert one.topic == "misfit offset"
    assert "With 40 um added" in one.text


def test_a_position_for_a_velocity_is_told(tmp_path):
    u = wave(0)
    y = through(u, block("mechanism", **STAGE, output="velocity"))
    made = [record(u, y, name="a"), record(u, y[::-1], name="b", use="hold-out")]
    write_folder(tmp_path / "stage", made)
    (one,) = told(of_stage(tmp_path), "misfit")
    assert one.topic == "misfit rate"
    assert "Its rate of change, times 1," in one.text


def test_what_nothing_plain_would_mend_has_its_likely_reasons(stage):
    (one,) = told(of_stage(stage, stiffness=30.0), "misfit")
    assert one.topic == "misfit"
    assert "Its units, the quantity that it gives" in one.text

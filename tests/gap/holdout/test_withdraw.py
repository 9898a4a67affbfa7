"""What the hold-out records add to a verdict in words."""

import pytest

from hystbench.gap.holdout.withdraw import more_than_on_fit_records


@pytest.mark.parametrize(
    ("verdict", "left", "told"),
    [("no-gap", 0.35, True), ("no-gap", 0.14, False)],
)
def test_a_gap_of_hold_out_records_alone_is_told(verdict, left, told):
    content = {
        "verdict": verdict,
        "unit": "deg",
        "gap": {"before": left, "noise_floor": 0.133},
        "fit": {"after": 0.134},
    }
    sentences = more_than_on_fit_records(content)
    assert bool(sentences) == told
    if told:
        assert "leaves 0.35 deg rms" in sentences[0]
        assert "floor is 0.133 deg" in sentences[0]


@pytest.mark.parametrize(
    ("left", "withdrawn", "told"),
    [(0.3, None, True), (0.25, None, False), (0.3, {"names": []}, False)],
)
def test_hold_out_records_that_leave_twice_as_much_are_told(left, withdrawn, told):
    content = {
        "verdict": "unnamed",
        "unit": "V",
        "gap": {"before": 0.5, "after": left, "noise_floor": 0.01},
        "fit": {"before": 0.2, "after": 0.134},
        "withdrawn": withdrawn,
    }
    sentences = more_than_on_fit_records(content)
    assert bool(sentences) == told
    if told:
        assert "model leaves 0.3 V rms, of the fit records 0.134 V" in sentences[0]

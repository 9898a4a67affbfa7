"""What the hold-out records add to a verdict in words."""

import pytest

from hystbench.gap.holdout.withdraw import more_than_on_fit_records


@pytest.mark.parametrize(
    ("verdict", "left", "told"),
    [("no-gap", 0.35, True), ("no-gap", 0.14, False), ("named", 0.35, False)],
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

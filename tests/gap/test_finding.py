"""What is said of a verdict beside the word."""

from hystbench.gap.finding import _whole
from hystbench.gap.verdict import Left


def test_a_reason_tells_what_a_wrong_shape_could_leave_as_well():
    """5 % of what no shape explains stays, and 40 % of the whole residual."""
    said = _whole(Left(before=100.0, after=5.0, all_before=1000.0, all_after=400.0))
    assert "40 %" in said
    assert "wrong shape" in said


def test_a_reason_that_holds_for_the_whole_is_left_alone():
    assert not _whole(Left(100.0, 5.0, 1000.0, 60.0))
    # The whole may be the lesser share: then the reason has it already.
    assert not _whole(Left(100.0, 50.0, 1000.0, 60.0))

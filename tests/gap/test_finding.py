"""What is said of a verdict beside the word."""

from hystbench.gap.finding import _whole, find
from hystbench.gap.verdict import Left
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.small import block, measured


def test_a_reason_tells_what_a_wrong_shape_could_leave_as_well():
    """5 % of what no shape explains stays, and 40 % of the whole residual."""
    said = _whole(Left(before=100.0, after=5.0, all_before=1000.0, all_after=400.0))
    assert "40 %" in said
    assert "wrong shape" in said


def test_a_reason_that_holds_for_the_whole_is_left_alone():
    assert not _whole(Left(100.0, 5.0, 1000.0, 60.0))
    # The whole may be the lesser share: then the reason has it already.
    assert not _whole(Left(100.0, 50.0, 1000.0, 60.0))


def test_noise_alone_is_no_gap_only_where_the_noise_is_known():
    """The same records, a base that is right: the floor declared, and as a bound."""
    noise = 0.05
    chain = (block("gain", value=12.0),)
    base = Model("base", CURRENT, DISPLACEMENT, chain)
    given = measured(chain, noise)
    content = find("made", given, base, declared=noise).content
    assert content["verdict"] == "no-gap"
    content = find("made", given, base).content
    assert content["verdict"] == "unnamed"
    assert "only an upper bound" in content["reason"]

"""The word of the verdict and the confidence of a name, at and around their limits."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.judging.leftover import Leftover, what_is_left
from hystbench.gap.judging.unowned import Unowned
from hystbench.gap.judging.verdict import (
    GIVE,
    confidence,
    error_of,
    likelier_wrong,
    what_mends,
)
from hystbench.gap.naming.rounds import Candidate, near
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import (
    ABOVE_NOISE,
    FOREIGN,
    LOOSE,
    SCALE,
    SLIGHT,
    UNNAMED_SHARE,
    WIDE,
)
from hystbench.record import Channel, Record
from tests.gap.judged import judge
from tests.gap.small import block, measured, state_of

SIZES = st.floats(-1.0, 1e6)
SHARES = st.floats(0.0, 1.0)


def left(after, before=100.0):
    return Leftover(before, after, before, after)


@given(SIZES, SIZES, SIZES, SIZES, st.booleans(), st.none() | SHARES)
def test_every_finding_has_a_word_and_a_reason(before, after, one, other, named, box):
    found = Leftover(before, after, one, other)
    word, reason = judge(found, named, box)
    assert word in ("named", "no-gap", "unnamed")
    assert (word == "no-gap") <= (not named)
    assert reason
    assert "\n" not in reason
    assert 0 <= found.share_left <= 1


@given(st.floats(-1, ABOVE_NOISE), st.none() | SHARES)
def test_noise_is_no_gap_whatever_the_black_box_says(after, box):
    assert judge(left(after), False, box)[0] == "no-gap"


@given(st.floats(-1, ABOVE_NOISE), SHARES)
def test_noise_that_stands_in_lone_samples_is_none(after, lone):
    found = Leftover(after, after, after, after, lone=lone)
    word, reason = judge(found, False, 0.0)
    told = lone * (1 + after) > FOREIGN
    assert word == ("unnamed" if told else "no-gap")
    assert ("lone samples" in reason) == told


@given(st.floats(0, 40), st.floats(-1, 10))
def test_what_differs_between_periods_is_no_wrong_shape(after, differs):
    # As slight as only a wrong shape of the hysteresis leaves it.
    found = Leftover(0.0, 0.0, 100.0, after, 1e6, unrepeated=differs)
    word, reason = judge(found, False, 0.0)
    repeats = after - differs > max(ABOVE_NOISE, 0.25 * differs)
    told = differs > (max(ABOVE_NOISE, FOREIGN * after) if repeats else ABOVE_NOISE)
    assert word == ("unnamed" if told else "no-gap")
    assert ("one period" in reason) == told


@given(st.floats(0, 0.49), st.floats(0.51, 1e5))
def test_a_wide_gap_is_one_though_reshaping_could_do_all_of_it(beyond, whole):
    output = 1e5
    found = Leftover(beyond, beyond, whole, whole, output)
    word, reason = judge(found, False, 0.0)
    assert word == ("no-gap" if whole < (WIDE * SLIGHT) ** 2 * output else "unnamed")
    assert (word == "no-gap") == ("% of the output" in reason)


def test_names_that_leave_most_of_a_slightly_wrong_shape_go():
    assert Leftover(2.0, 2.0, 100.0, 60.0, 1e6).little_named
    # What they leave is 40 % of the gap, nearly all of it what reshaping could do.
    assert not Leftover(20.0, 2.0, 100.0, 40.0, 1e6).little_named


@given(SIZES, SIZES, SIZES, SIZES, st.floats(0, 1e6), st.booleans())
def test_beside_an_upper_bound_of_the_noise_what_follows_signals_may_be_a_gap(
    before, after, one, other, output, retuned
):
    """A floor that may hold the whole gap: all else is judged as with a known one."""
    found = Leftover(before, after, one, other, output)
    some = Unowned(1.1 * UNNAMED_SHARE)
    known = judge(found, False, 0.0, retuned=retuned, unowned=some)
    bound = judge(
        found, False, 0.0, retuned=retuned, unowned=some, floor_is_upper_bound=True
    )
    if known[0] != "no-gap":
        assert bound == known
        return
    assert bound[0] == "unnamed"
    assert "only an upper bound" in bound[1]
    for key in ("period_samples", "noise_rms"):
        assert key in bound[1]


@pytest.mark.parametrize(
    ("share", "structured", "word"),
    [(0.04, 0.0, "no-gap"), (0.05, 0.0, "unnamed"), (0.04, 0.02, "unnamed")],
)
def test_noise_whose_size_nobody_told_is_no_gap_if_it_is_little_and_follows_nothing(
    share, structured, word
):
    """Else white noise would be a gap, and noise of another colour none."""
    found = Leftover(0.0, 0.0, 0.0, 0.0, 1.0 / share**2)
    given = {"unowned": Unowned(structured), "floor_is_upper_bound": True}
    assert judge(found, False, **given)[0] == word
    # Noise of a sensor has one size.
    assert judge(found, False, size_follows=True, **given)[0] == "unnamed"


@pytest.mark.parametrize(("share", "word"), [(0.2, "named"), (0.3, "unnamed")])
def test_a_name_that_leaves_more_than_a_quarter_does_not_stand(share, word):
    """Windows of a free mass own paths: nearly all of it counted as owned."""
    some = Unowned(0.001, unrelated=0.001)
    found = Leftover(1000.0, 1000.0 * share, 1000.0, 1000.0 * share, 1e4)
    assert judge(found, True, unowned=some)[0] == word
    # A wrong base leaves much of the whole; of the part beyond it little stays.
    beyond = Leftover(1000.0, 100.0, 5000.0, 5000.0 * share, 1e4)
    assert judge(beyond, True, unowned=some)[0] == "named"


def test_a_reason_tells_harm_and_the_unknown_of_the_black_box_as_they_are():
    reasons = [judge(left(90.0), False, box)[1] for box in (-0.3, None, 0.3, 0.0)]
    assert "a black box makes it worse on folds of the fit records" in reasons[0]
    assert "is not known" in reasons[1]
    assert "takes 30 % of its power away on folds" in reasons[2]
    assert "takes 0 % of its power away on folds" in reasons[3]


@given(st.floats(1.01 * ABOVE_NOISE, 1e6), st.none() | SHARES)
def test_a_gap_that_nothing_takes_away_is_unnamed(after, box):
    assert judge(left(after), False, box)[0] == "unnamed"


def test_a_percent_of_the_output_that_reshaping_explains_is_no_gap():
    """A gap of 3 floors beyond a wrong shape, of 30 in all, at 1 % of the output."""
    output = 3.0 / (0.9 * SLIGHT) ** 2
    slight = Leftover(3.0, 3.0, 30.0, 30.0, output)
    assert judge(slight, False, 0.9)[0] == "no-gap"
    # more of the output, or a gap that no reshaping explains, is one to be named
    large = Leftover(3.0, 3.0, 30.0, 30.0, 0.5 * output)
    alien = Leftover(3.0, 3.0, 4.0, 4.0, output)
    for other in (large, alien):
        assert judge(other, False, 0.9)[0] == "unnamed"


@given(SHARES, SHARES, SHARES, st.floats(1e-3, 0.5))
def test_what_stays_unnamed_decides_whether_a_name_holds(follows, changes, rest, share):
    found = Unowned(follows, share, changes, rest)
    word, reason = judge(left(1.0), True, unowned=found)
    known = follows > share
    assert word == ("unnamed" if known or follows + rest > LOOSE else "named")
    assert ("too much stays" in reason) == (not known and follows + rest > LOOSE)
    assert judge(left(1.0), True, unowned=Unowned(0.0))[0] == "named"


@pytest.mark.parametrize(("stays", "less"), [(0.05, False), (0.3, True)])
def test_a_withdrawal_is_less_sure_beside_a_base_that_may_be_wrong(stays, less):
    found = Leftover(100.0, 2.0, 100.0, 100.0 * stays, 1e3)
    word, reason = judge(found, True, unowned=Unowned(0.02))
    assert word == "unnamed"
    assert ("less sure" in reason) == less
    # What is structured is none of that.
    assert "less sure" not in judge(found, True, unowned=Unowned(0.28))[1]


def test_what_would_be_no_gap_does_not_speak_against_a_name():
    """Of a gap of 100 floors 15 stay, most of it what reshaping the base could do."""
    output = 8.0 / (0.9 * SLIGHT) ** 2
    found = Leftover(100.0, 8.0, 100.0, 15.0, output)
    assert judge(replace(found, before=8.0, all_before=15.0), False)[0] == "no-gap"
    structure = Unowned(0.03)
    word, reason = judge(found, True, unowned=structure)
    assert word == "named"
    assert "less sure" in reason
    # more of the output, what no reshaping could do, lone samples, and other periods
    large = replace(found, output=0.5 * output)
    alien = replace(found, after=14.0)
    lone, differing = replace(found, lone=0.9), replace(found, unrepeated=10.0)
    for other in (large, alien, lone, differing):
        assert judge(other, True, unowned=structure)[0] == "unnamed"
    # Nor does a name stand where most of the gap is left.
    assert judge(found, True, unowned=Unowned(0.03, unrelated=0.3))[0] == "unnamed"
    for much, word in ((0.039, "named"), (0.041, "unnamed")):
        assert judge(found, True, unowned=Unowned(much))[0] == word
    word, reason = judge(found, True, unowned=Unowned(0.3))
    assert word == "unnamed"
    assert "follows known signals" in reason
    assert structure.trust() < structure.trust(of_base=True) < 1
    assert Unowned(0.005).trust(of_base=True) == 1


@given(st.lists(st.floats(0, 200), min_size=1, max_size=6), st.floats(0, 100))
def test_confidence_is_a_probability_that_rivals_and_rest_take_from(gaps, after):
    first = Candidate("creep", "mechanics", score=-500.0)
    state = state_of((block("gain", value=12.0),))
    others = [
        Candidate(f"other {k}", "drive", score=-500.0 + g, state=state)
        for k, g in enumerate(gaps)
    ]
    sure = confidence(first, [first, *others], left(after))
    assert 0 <= sure <= 1
    assert sure <= confidence(first, [first, *others[1:]], left(after))
    assert sure <= confidence(first, [first, *others], left(after / 2))
    refused = Candidate("slew-limit", "drive", declined="too short")
    assert confidence(first, [first, *others, refused], left(after)) == sure
    # What was not put to folds has no score that the others' can be held against.
    no_finalist = Candidate("backlash", "mechanics", score=-600.0)
    assert confidence(first, [first, *others, no_finalist], left(after)) == sure


def test_no_name_is_surer_than_that_its_numbers_are_anything():
    """Two thirds of a normal distribution lie within one standard error."""
    one = Candidate("creep", "mechanics", score=-500.0)
    sure = [confidence(one, [one], left(0.0), e) for e in (0.0, 0.1, 1.0, 3.0, 1e9)]
    assert sure[:2] == [0.98, 0.98]
    assert sure[2] == pytest.approx(0.6827, abs=1e-4)
    assert sure[3] == pytest.approx(0.2611, abs=1e-4)
    assert sure[4] < 1e-6


def number(value, error):
    return {"value": value, "standard_error": error, "unit": "s"}


def test_the_error_of_an_effect_is_that_of_its_size_or_of_its_best_known_number():
    loose = {"level": number(2.0, 6.0), "sharpness": number(4.0, 8.0)}
    assert error_of(0.1, loose) == 2.0
    assert error_of(None, loose) == 2.0
    # A mode may be told by its frequency; that it is there at all, its size tells.
    mode = {"frequency_hz": number(60.0, 0.6), "participation": number(0.1, 0.4)}
    assert error_of(4.0, mode) == 4.0
    assert error_of(None, mode) == pytest.approx(0.01)
    many = {"times": number([1.0, -2.0], [3.0, 1.0]), "shape": number("slab", None)}
    assert error_of(0.2, many) == 0.5
    assert error_of(None, {"times": number([1.0, 2.0], [None, None])}) == 0.0
    assert error_of(0.1, {"slope": number(0.0, 1.0)}) == np.inf


def test_two_that_score_alike_share_the_confidence():
    state = state_of((block("gain", value=12.0),))
    one, other = (
        Candidate(name, "drive", score=-10.0, state=state) for name in ("a", "b")
    )
    both = [confidence(item, [one, other], left(0.0)) for item in (one, other)]
    assert both[0] == both[1] <= 0.5


@pytest.mark.parametrize(
    ("told", "stands"),
    [
        ([("sensor-lag", 0.49, ["drive-lag"])], True),
        ([("sensor-lag", 0.1, [])], True),
        ([("drive-lag", 0.1, []), ("sensor-lag", 0.1, [])], False),
        ([("drive-lag", 0.3, ["creep"]), ("sensor-lag", 0.1, [])], True),
        ([("creep", 0.9, []), ("drift", 0.3, [])], True),
        ([("creep", 0.9, []), ("drift", 0.01, [])], False),
        ([("creep", 0.06, [])], True),
        ([("creep", 0.01, [])], False),
        ([("drive-lag", 0.03, ["sensor-lag"])], True),
        ([("creep", 0.4, []), ("hysteresis-shape", 0.98, [])], False),
        ([("creep", 0.6, []), ("hysteresis-shape", 0.3, [])], True),
        ([("hysteresis-shape", 0.3, [])], True),
        ([], True),
    ],
)
def test_several_names_stand_where_one_is_likely_and_none_excluded(told, stands):
    keys = ("name", "confidence", "cannot_be_told_from")
    effects = [dict(zip(keys, item, strict=True)) for item in told]
    doubt = likelier_wrong(effects)
    assert (doubt == "") == stands
    assert all(item[0] in doubt for item in told) or stands


def test_the_set_of_those_that_cannot_be_told_apart():
    state = state_of((block("gain", value=12.0),))
    scores = {"a": 0.0, "b": 0.9 * SCALE, "c": 1.1 * SCALE}
    ranking = [Candidate(k, "drive", score=v, state=state) for k, v in scores.items()]
    ranking.append(Candidate("d", "drive", score=0.1))  # not refitted: no finalist
    assert near(ranking[0], ranking) == ("b",)
    assert near(ranking[2], ranking) == ("a", "b")


def test_what_is_left_of_a_gap_is_counted_in_floors():
    noise = 0.05
    records = measured((block("gain", value=12.0),), noise)
    there = state_of((block("gain", value=12.0),), records, count=600)
    wrong = state_of(
        (block("gain", value=12.0), block("sensor-lag", time_constant_s=0.01)),
        records,
        count=600,
    )
    found = what_is_left(wrong, there, Floor(noise, "declared"))
    plain = np.mean(
        [np.mean(wrong.residual[part] ** 2) for part in wrong.sample.slices]
    )
    assert found.all_before == pytest.approx(plain / noise**2 - 1)
    # A mean of 1200 squares scatters by sqrt(2 / 1200), about 4 %.
    assert abs(found.all_after) < 0.2
    assert abs(found.after) < 0.2
    assert found.before <= found.all_before
    assert found.share_left < 0.05


def test_periods_that_are_found_are_what_mends_an_upper_bound():
    time = np.arange(1000)
    rng = np.random.default_rng(0)

    def made(name, u):
        channel = Channel("x", "V")
        return Record(name, 1e-3, u, u + 1.0, channel, channel, "measured")

    repeats = made("r", np.sin(2 * np.pi * time / 125))
    noise = made("n", rng.standard_normal(1000))
    told = what_mends([repeats, noise])
    assert "'period_samples: 125' of record r" in told
    assert "record n" not in told
    assert what_mends([noise]) == GIVE
    _, reason = judge(
        Leftover(0, 0, 0, 0, 1), False, 0.0, floor_is_upper_bound=True, mends=told
    )
    assert reason.endswith(told)


def test_what_is_new_in_each_period_is_told_as_that():
    found = Leftover(30.0, 30.0, 30.0, 30.0, 1e3, unrepeated=28.0)
    word, reason = judge(found, False, 0.0)
    assert word == "unnamed"
    assert "differs from one period of the same input to the next" in reason
    assert "noise of another colour" in reason
    word, reason = judge(found, False, 0.0, size_follows=True)
    assert word == "unnamed"
    assert "its size follows signals" in reason
    # A third that repeats is no noise, whatever differs beside it.
    _, reason = judge(replace(found, unrepeated=20.0), False, 0.3)
    assert "one period" not in reason
    assert "a black box takes 30 %" in reason


def test_noise_that_follows_nothing_is_no_gap_but_where_the_noise_is_known():
    """As surrogates tell it where no record repeats."""
    found = replace(left(30.0), output=2e4)
    chance = Unowned(0.0, unrelated=0.3, by_chance=0.3)
    for bound, expected in ((True, "no-gap"), (False, "unnamed")):
        word, reason = judge(
            found, False, -0.1, unowned=chance, floor_is_upper_bound=bound
        )
        assert word == expected
        assert "moved in time" in reason
    # Nothing that seems to follow a signal needs no surrogate.
    nothing = Unowned(1e-4, unrelated=0.9)
    word, reason = judge(
        found, False, -1e-5, unowned=nothing, floor_is_upper_bound=True
    )
    assert word == "no-gap"
    assert "follows no known signal" in reason
    # A black box that explains some of it sees what the surrogates do not.
    word, reason = judge(found, False, 0.1, unowned=chance, floor_is_upper_bound=True)
    assert word == "unnamed"
    # And noise has one size.
    word, reason = judge(
        found, False, -0.1, size_follows=True, unowned=chance, floor_is_upper_bound=True
    )
    assert word == "unnamed"
    assert "its size follows signals" in reason


@pytest.mark.parametrize(("share", "word"), [(0.04, "no-gap"), (0.05, "unnamed")])
def test_what_follows_nothing_is_noise_only_if_it_is_little(share, word):
    """A torque of cogging follows no known signal either, at a tenth of the output."""
    found = replace(left(2300.0), output=2300.0 / share**2)
    nothing = Unowned(1e-4, unrelated=0.9)
    given = {"unowned": nothing, "floor_is_upper_bound": True}
    assert judge(found, False, -0.1, **given)[0] == word

"""A reader is told when hold-out records show less than the fit records promised."""

import pytest

from hystbench.gap.holdout.confidence_cap import no_surer_than_even
from hystbench.gap.holdout.shortfall import shortfall


def content(
    fit=0.9, held=0.5, new=0.0, outside=(), names=("eddy-diffusion", "drift"), ladder=()
):
    return {
        "effects": [{"name": name} for name in names],
        "fit": {"explained": fit, "new_in_every_record": new},
        "gap": {"explained": held},
        "unit": "um",
        "ladder": [{"name": "base", "rms": 2.0}, *ladder],
        "black_box": {
            "records": [
                {"name": "slow", "outside": []},
                {"name": "fast", "outside": list(outside)},
            ]
        },
    }


def test_what_is_kept_is_not_worth_a_word():
    assert shortfall(content(fit=0.9, held=0.88)) is None
    assert shortfall(content(fit=0.5, held=0.9)) is None


def test_little_that_is_lost_of_much_is_not_worth_a_word():
    """0.999 against 0.99: ten times as much is left, and still next to nothing."""
    assert shortfall(content(fit=0.999, held=0.99)) is None


def test_an_effect_that_widens_the_gap_is_told_though_all_together_shrink_it():
    steps = [{"name": "eddy-diffusion", "rms": 1.0}, {"name": "creep", "rms": 1.2}]
    found = shortfall(content(fit=0.5, held=0.9, ladder=steps))
    assert found["sentence"] == (
        "On the hold-out records creep widens the gap, from 1 to 1.2 um."
    )
    found = shortfall(content(fit=0.5, held=None, ladder=steps))
    assert found["hold_out"] is None  # of a base at the floor nothing can go
    assert "creep widens the gap" in found["sentence"]
    steps[1]["rms"] = 1.001  # no more than rounding is worth
    assert shortfall(content(fit=0.5, held=0.9, ladder=steps)) is None
    steps[1]["rms"] = None  # one that runs away is told elsewhere
    assert shortfall(content(fit=0.5, held=0.9, ladder=steps)) is None


def test_a_shortfall_is_told_with_both_shares():
    found = shortfall(content(fit=0.9, held=0.5))
    assert found["fit"] == 0.9
    assert found["hold_out"] == 0.5
    assert "90 %" in found["sentence"]
    assert "50 %" in found["sentence"]


def test_a_range_keeps_the_promise_where_it_may():
    found = shortfall(content(fit=0.9, held=[0.4, 0.6]))
    assert found["hold_out"] == pytest.approx(0.6)
    assert shortfall(content(fit=0.9, held=[0.4, 0.9])) is None


def test_reasons_are_told_where_they_are_known():
    sentence = shortfall(content(new=0.3, outside=["rate"]))["sentence"]
    assert "30 %" in sentence
    assert "drift" in sentence
    assert "fast" in sentence
    assert "rate" in sentence
    plain = shortfall(content())["sentence"]
    assert "fast" not in plain
    assert "drift" not in plain


@pytest.mark.parametrize("missing", [None, "fit", "gap"])
def test_without_a_gap_or_an_effect_nothing_was_promised(missing):
    given = content(names=()) if missing is None else content()
    if missing is not None:
        given[missing]["explained"] = None
    assert shortfall(given) is None


def test_records_that_a_model_runs_away_on_and_those_that_refuse_it_are_told_apart():
    away = [
        {"record": name, "from_s": 0.0, "refused": why, "sentence": ""}
        for name, why in (("a", None), ("b", "rig:run: raised"), ("c", None))
    ]
    found = shortfall(content(fit=0.9, held=0.0) | {"runs_away": away})
    assert (
        "the model diverges on a and c; the model cannot be run on b"
        in (found["sentence"])
    )


@pytest.mark.parametrize(
    ("count", "told"),
    [
        (1, "pulse-0 lies outside the fit records in rate"),
        (2, "pulse-0 and pulse-1 lie outside the fit records in rate"),
        (8, "8 records lie outside the fit records in rate"),
    ],
)
def test_records_that_lie_outside_alike_are_told_in_one_clause(count, told):
    given = content()
    given["black_box"]["records"] = [
        {"name": f"pulse-{k}", "outside": ["rate"]} for k in range(count)
    ]
    assert told in shortfall(given)["sentence"]
    assert shortfall(given)["sentence"].count("outside") == 1


def test_a_name_that_widens_the_gap_is_no_surer_than_even():
    names = ("eddy-diffusion", "creep", "drift", "friction")
    found = content(held=0.88) | {
        "effects": [{"name": name, "confidence": 0.9} for name in names[:3]]
        + [{"name": "friction", "confidence": 0.2}],
        "ladder": [
            {"name": "base", "rms": 2.0},
            {"name": "eddy-diffusion", "rms": 1.0},
            {"name": "creep + friction", "rms": 1.2},
            {"name": "drift", "rms": 1.205},
        ],
    }
    less = {x["name"]: x["confidence"] for x in no_surer_than_even(found)}
    assert less == dict(zip(names, (0.9, 0.5, 0.9, 0.2), strict=True))


@pytest.mark.parametrize(
    ("fit", "held", "expected"),
    [
        (0.98, 0.042, 0.5),
        (0.98, (-0.1, 0.3), 0.5),
        (0.98, (0.3, 0.6), 0.97),  # it may be more than half of what was promised
        (0.98, 0.5, 0.97),
        (0.98, None, 0.97),  # there was no gap there
    ],
)
def test_laws_that_keep_less_than_half_of_their_promise_are_no_surer_than_even(
    fit, held, expected
):
    """A drift is new in every record and promised nothing of others."""
    found = content(fit=fit, held=held)
    for item in found["effects"]:
        item["confidence"] = 0.97
    less = {item["name"]: item["confidence"] for item in no_surer_than_even(found)}
    assert less == {"eddy-diffusion": expected, "drift": 0.97}

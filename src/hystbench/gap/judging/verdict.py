"""The verdict, and how sure the names are."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from hystbench.gap.judging.leftover import Leftover
from hystbench.gap.judging.unowned import Unowned
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.thresholds import (
    ABOVE_NOISE,
    AS_GOOD,
    BY_CHANCE,
    DOUBT,
    LOOSE,
    MOST,
    SCALE,
    SHAPE,
    WORTH_A_WORD,
)
from hystbench.periods import find_period
from hystbench.record import Record
from hystbench.sentences import finely, shortly

Verdict = Literal["named", "parameters", "no-gap", "unnamed"]

SURE = 100.0
"""Odds beyond e to this are all the same."""


GIVE = "give period_samples or noise_rms"
"""What to write in dataset.yaml where nothing tells the noise."""


def what_mends(records: Sequence[Record]) -> str:
    """Say what to write so that the noise is measured: the periods that are found."""
    found = [(record.name, find_period(record.u)) for record in records]
    told = [
        f"'period_samples: {period}' of record {name}"
        for name, period in found
        if period is not None
    ]
    if not told:
        return GIVE
    return f"the input repeats itself: write {', '.join(told)} in dataset.yaml"


def judge_none(
    left: Leftover,
    unowned: Unowned,
    explained_by_box: float | None,
    retuned: bool,
    floor_is_upper_bound: bool,
    size_follows: bool,
    mends: str,
) -> tuple[Verdict, str]:
    """Choose the word where no effect was added, and say why.

    Comments number the cases as docs/design.md does; the first that holds decides.

    Parameters
    ----------
    left : Leftover
    unowned : Unowned
        What stays, and what of it follows known signals.
    explained_by_box : float or None
        Share of what the base leaves, above the floor, that a black box takes away on
        folds of the fit records.
    retuned : bool
        Whether the base had numbers of its own to re-tune.
    floor_is_upper_bound : bool
        Whether the noise floor is only an upper bound: it may hold the whole gap. There
        is none then only if little is left with it, and that follows no known signal.
    size_follows : bool
        Whether what is left is larger where signals are: it is no noise then.
    mends : str
        What to write so that the noise is measured.
    """
    alone = unowned.follows_nothing and (explained_by_box or 0.0) < AS_GOOD
    in_no_record = _why_in_no_record(left, unowned if alone else None, explained_by_box)
    # 1a. Little is left; a part of it is nothing that an effect or a hysteresis does.
    if left.slight and left.foreign and not in_no_record:
        return "unnamed", left.foreign
    # 1b. The base only has wrong numbers.
    if retuned and left.all_before > ABOVE_NOISE and left.share_left < LOOSE:
        return "parameters", (
            "re-tuning the base within what is free is enough, and no effect pays "
            f"beside it: {left.sentence}"
        )
    # 1c. What is left follows nothing that is recorded.
    if in_no_record and size_follows:
        return "unnamed", (
            f"{in_no_record}, but its size follows signals, as no noise does"
        )
    if in_no_record:
        # Only where the noise is not known may all of it be noise, and little.
        noise = floor_is_upper_bound and left.may_be_noise
        return "no-gap" if noise else "unnamed", (
            f"{in_no_record}: it is noise of another colour, or has a cause that is in "
            "no record"
        )
    # 1d. Little is left beside a noise that may hold the whole gap.
    if left.slight and floor_is_upper_bound:
        if left.may_be_noise and not (unowned.too_much or size_follows):
            rms = finely(float(np.sqrt((1.0 + left.all_after) / left.output)))
            return "no-gap", (
                f"no effect pays, and what is left, {rms} of the output's rms, "
                "follows no known signal: it is noise, or a slightly wrong shape "
                "of the base"
            )
        return "unnamed", (
            "no effect pays; the floor is only an upper bound, so that there is "
            f"no gap cannot be claimed: {mends}"
        )
    # 1e. Little is left beside a known noise.
    if left.slight and left.all_after <= ABOVE_NOISE:
        return "no-gap", "what is left is noise"
    if left.slight:
        share = float(np.sqrt(left.all_after / left.output))
        return "no-gap", (
            f"what is left on the fit records, {100 * share:.2g} % of the output's "
            "rms, is no more than a slightly wrong shape of the base could leave"
        )
    # 1f. Much is left.
    beyond = "" if left.after >= left.all_after else _beyond_shapes(left.after)
    return "unnamed", (
        f"on the fit records a gap of {shortly(left.all_after, 2)} times the noise "
        "power is "
        f"there{beyond} and no effect of the vocabulary pays; "
        f"{_box_words(explained_by_box)}"
    )


def _beyond_shapes(power: float) -> str:
    """Say what no wrong shape of the base's hysteresis could leave."""
    times = f"{shortly(max(power, 0.0), 2)} times"
    return f" ({times} are more than a wrong shape of the loop could leave)"


def judge_names(left: Leftover, unowned: Unowned) -> tuple[Verdict, str]:
    """Choose the word where effects were added, and say why.

    Parameters
    ----------
    left : Leftover
    unowned : Unowned
        What stays that the named effects cannot own.
    """
    much = unowned.too_much
    if much and not left.may_be_of_base:
        why = unowned.reason
        if left.whole - unowned.structured > WORTH_A_WORD:
            why += (
                "; this is less sure, as a third of the gap's rms or more may be the "
                "base's own error, which can look like that"
            )
        return "unnamed", why
    if much and unowned.trust(of_base=True) < MOST:
        return "unnamed", unowned.reason  # likelier wrong than right
    too_much = f"too much stays for a name: {left.sentence}"
    if left.share_left > LOOSE and not left.slight:
        return "unnamed", too_much
    if unowned.stays > LOOSE:
        return "unnamed", f"{too_much}, and most of it follows no known signal"
    if much:
        return "named", (
            f"{left.sentence}; this is less sure, as {unowned.reason}, "
            "but so little may as well be the error of a slightly wrong base"
        )
    return "named", left.sentence


def _why_in_no_record(
    left: Leftover, unrelated: Unowned | None, explained: float | None
) -> str:
    """Say why the cause of what is left is in no record; or nothing.

    ``unrelated`` is what stays where that follows nothing, and none where it does.
    """
    if left.is_new:
        return (
            f"what is left on the fit records, {shortly(left.all_after, 2)} times the "
            "power of "
            "the noise floor, differs from one period of the same input to the next"
        )
    if unrelated is None or left.slight or left.foreign:
        return ""
    follows = "no known signal"
    if unrelated.by_chance:
        follows = "the input no more than when it is moved in time against it"
    return (
        f"what is left on the fit records, {shortly(left.after, 2)} times the power "
        "of the "
        f"noise floor, follows {follows}; {_box_words(explained)}"
    )


def confidence(
    first: Candidate, ranking: Sequence[Candidate], left: Leftover, errors: float = 0.0
) -> float:
    """Give the probability that an effect is the one, among those that were tried.

    Each finalist counts by how much worse it scores; what stays unexplained speaks
    against any name. And no effect is surer than that it is there at all: that its
    number, normally distributed with that error, is above zero and below twice itself.

    Parameters
    ----------
    first : Candidate
    ranking : sequence of Candidate
    left : Leftover
    errors : float
        Standard error of the effect, in times of it: :func:`error_of`.
    """
    odds = sum(
        float(np.exp(min((first.score - item.score) / SCALE, SURE)))
        for item in ranking
        if item.effect != first.effect and item.state is not None
    )
    explained = 1.0 - left.share_left
    # 2 Phi(1 / e) - 1, Phi the standard normal distribution: the level of the widest
    # interval about the number that does not hold zero.
    is_anything = math.erf(1.0 / (errors * math.sqrt(2.0))) if errors > 0 else 1.0
    return min((1.0 - DOUBT) * explained / (1.0 + odds), is_anything)


def likelier_wrong(effects: Sequence[Mapping[str, Any]]) -> str:
    """Say that names are likelier wrong than right; or nothing.

    If none of several is likelier right than wrong, they stand in for each other, and
    for what they are together. If one is next to excluded, so are the others, which
    were found beside it. One name alone is what explains the gap best, however little
    its numbers are known, unless it is next to excluded. A name counts with those that
    it cannot be told from: one of them is right. A wrong shape of the base's own
    hysteresis makes no other name likelier.

    Parameters
    ----------
    effects : sequence of mapping
        As gap.json holds them.
    """
    sure = [x["confidence"] * (1 + len(x["cannot_be_told_from"])) for x in effects]
    missing = [
        value
        for item, value in zip(effects, sure, strict=True)
        if item["name"] != SHAPE
    ]
    alone = len(sure) < 2
    if min(sure, default=1.0) >= BY_CHANCE and (alone or max(missing) >= MOST):
        return ""
    told = " and ".join(f"{x['name']} {x['confidence']:.2f}" for x in effects)
    if alone:
        return f"the name is next to excluded: {told}"
    if max(missing) < MOST:
        of_base = "" if len(missing) == len(sure) else "but for the base's own shape "
        return f"{of_base}no name is likelier right than wrong: {told}"
    least = effects[int(np.argmin(sure))]["name"]
    return f"{least} is next to excluded, and the others were found beside it: {told}"


def error_of(
    size_error: float | None, parameters: Mapping[str, Mapping[str, Any]]
) -> float:
    """Give the standard error of an effect, in times of it.

    The larger of two: that of its size, which is what all its numbers together add to
    the output, and that of the number of it that is known best. The first says nothing
    of numbers that stand in for each other; the second nothing of a number that is not
    zero where there is no effect, as a frequency or the gain of a sensor.

    Parameters
    ----------
    size_error : float or None
        None where it cannot be told.
    parameters : mapping
        As gap.json holds them.

    Returns
    -------
    float
        Zero where nothing can be told.
    """
    each = [
        abs(error / value) if value else math.inf
        for item in parameters.values()
        for value, error in zip(
            _listed(item["value"]), _listed(item["standard_error"]), strict=False
        )
        if error is not None and not isinstance(value, str)
    ]
    return max(size_error or 0.0, min(each, default=0.0))


def _listed(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list | tuple) else (value,)


def _box_words(explained: float | None) -> str:
    if explained is None:
        return "how much of it a black box takes away on folds is not known"
    if explained < 0:
        return "a black box makes it worse on folds of the fit records"
    return (
        f"a black box takes {100 * explained:.0f} % of its power away on "
        "folds of the fit records"
    )

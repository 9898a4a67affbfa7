"""Cross-validation of an effect, beside a plain one and where folds must disagree."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize

from hystbench.gap.effects import effects
from hystbench.gap.fitting import cross_validation
from hystbench.gap.fitting import score as scores
from hystbench.gap.fitting.cross_validation import gain_on_folds
from hystbench.gap.fitting.model_score import make_score, score_of
from hystbench.gap.fitting.refit import refit
from hystbench.gap.fitting.state import Free
from hystbench.gap.naming import rank as ranked
from hystbench.gap.naming.rank import rank
from hystbench.gap.naming.rivals import on_folds
from hystbench.gap.naming.rounds import Candidate
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.folds import make_folds
from hystbench.gap.thresholds import CERTAIN, PARAMETER, PAYS, SCALE
from tests.gap.made import multisine, record, steady
from tests.gap.small import block, plain_score, state_of

NOISE = 0.05
FLOOR = Floor(NOISE, "declared")
SPREAD = [1.09, 1.11, 1.1, 1.12, 1.08, 1.1]
UNSURE = [1.02, 1.06, 0.99, 1.05, 0.99, 1.07]


def lines(count, seed=0, length=1500):
    """Records of the same kind of input: sines of random phases."""
    return [
        steady(
            multisine(seed + k, highest_hz=60.0, lines=12, count=length), count=length
        )
        for k in range(count)
    ]


def measured(inputs, gains, noise=NOISE, bend=0.0):
    rng = np.random.default_rng(5)
    return tuple(
        record(
            u, g * u + bend * u**2 + noise * rng.standard_normal(len(u)), name=f"r{k}"
        )
        for k, (u, g) in enumerate(zip(inputs, gains, strict=True))
    )


def with_gain(state, value, count=1):
    """A model with a gain behind it, free: one number, linear; or with several."""
    gains = (block("gain", value=value),) * count
    return replace(
        state, chain=(*state.chain, *gains), free=(*state.free, Free(1, "value"))
    )


@pytest.mark.parametrize("gains", [[1.1] * 6, SPREAD])
def test_the_gain_on_folds_is_that_of_a_plain_cross_validation(gains):
    """Every record is judged by the gain that scores least on the other folds'."""
    given = measured(lines(6), gains)
    before = state_of((block("gain", value=1.0),), given)
    floor = (NOISE / 2) ** 2  # below the noise: the terms are smooth
    score = plain_score(before, floor)
    after, _ = refit(with_gain(before, 1.0), score)
    weight = max(scores.RECORD_WEIGHT, scores.LEAST_WEIGHT / 6)
    pairs = [
        (one.u[at], one.y[at])
        for one, at in zip(given, before.sample.positions, strict=True)
    ]

    def terms(gain, which):
        left = [np.mean((y - gain * u) ** 2) for u, y in (pairs[k] for k in which)]
        return weight * float(np.sum(np.log(left)))

    wanted = 0.0
    for fold in make_folds(before.records):
        held = [k for k, mask in enumerate(fold.validation) if mask.any()]
        others = [k for k in range(6) if k not in held]
        best = optimize.minimize_scalar(
            lambda gain, others=others: terms(gain, others), bounds=(0.5, 2.0)
        ).x
        wanted += terms(1.0, held) - terms(best, held)
    assert gain_on_folds(before, after, score) == pytest.approx(wanted, rel=2e-3)


def candidate(gains):
    """A model with a gain, fitted, as a finalist that is told to gain 50 in all."""
    given = measured(lines(6), gains)
    before = state_of((block("gain", value=1.0),), given)
    score = plain_score(before, NOISE**2)
    after, value = refit(with_gain(before, 1.0), score)
    item = Candidate("any", "sensor", "", value, 50.0, after)
    return item, before, score


def test_what_the_records_do_not_agree_on_gains_less_on_the_others():
    item, before, score = candidate(UNSURE)
    assert score.of(before.residual) - item.score > 5.0
    told = gain_on_folds(before, item.state, score)
    assert told < 0.0
    judged = on_folds(item, before, score)
    assert judged.gain_on_folds == judged.gain == pytest.approx(told)
    assert judged.score == pytest.approx(item.score + 50.0 - told)


def test_folds_lower_a_gain_and_never_raise_it():
    item, before, score = candidate([1.1] * 6)
    judged = on_folds(item, before, score)
    assert judged.gain_on_folds > 50.0
    assert judged.gain == 50.0
    assert judged.score == item.score


def limited(sizes, clipped):
    """Records of sizes of their own, and a model with their limit.

    The device limits a share of the samples of each record, from its beginning on.
    """
    inputs = [k * u for k, u in zip(sizes, lines(4), strict=True)]
    limit = 1.2 * max(np.abs(u).max() for u in lines(4))
    rng = np.random.default_rng(5)
    given = []
    for k, u in enumerate(inputs):
        y, end = u.copy(), round(clipped * len(u))
        y[:end] = np.clip(u[:end], -limit, limit)
        y += NOISE * rng.standard_normal(len(u))
        given.append(record(u, y, name=f"r{k}"))
    gain = block("gain", value=1.0)
    before = state_of((gain,), tuple(given))
    score = plain_score(before, NOISE**2)
    stop = block("drive-saturation", limit=limit)
    after = replace(before, chain=(stop, gain), free=(Free(0, "limit"),))
    return before, after, score


@pytest.mark.parametrize("sizes", [(1, 1, 1, 3), (1, 3, 1, 1), (1, 3, 1, 3)])
def test_a_limit_is_foretold_whichever_records_come_to_it(sizes):
    before, after, score = limited(sizes, clipped=1.0)
    gained = score_of(before, score) - score_of(after, score)
    assert gained > CERTAIN
    assert gain_on_folds(before, after, score) > gained / 2


def test_what_shows_in_the_farthest_record_alone_has_to_show_throughout_it():
    """No other record shows it: these would leave its number as it was fitted."""
    before, after, score = limited((1, 1, 1, 1.7), clipped=0.8)
    gained = score_of(before, score) - score_of(after, score)
    assert gained > SCALE
    assert gain_on_folds(before, after, score) < gained / 2


def test_the_first_of_a_ranking_was_simulated_exactly(monkeypatch):
    """Folds may put one first that was too far behind to be simulated exactly."""
    given = measured(lines(6), [1.0] * 6, bend=0.03)
    before = state_of((block("gain", value=1.0),), given)
    score = make_score(before, FLOOR)
    plain, finished = rank(before, score), []
    last = [item for item in plain if item.gain_on_folds is not None][-1]

    exactly = ranked.finished

    def noted(state, score):
        finished.append(state.added[-1].effect)
        return exactly(state, score)

    def told(before, after, score):
        return 1e3 if after.added[-1].effect == last.effect else -1e3

    monkeypatch.setattr("hystbench.gap.naming.rivals.gain_on_folds", told)
    monkeypatch.setattr(ranked, "finished", noted)
    monkeypatch.setattr(ranked, "EXACT", 1)
    ranking = rank(before, score)
    assert last.effect != plain[0].effect
    assert ranking[0].effect == last.effect
    assert finished == [plain[0].effect, last.effect]


def test_a_ranking_of_effects_that_all_decline_is_no_ranking_of_folds():
    given = measured(lines(6), [1.0] * 6)
    before = state_of((block("gain", value=1.0),), given)
    score = make_score(before, FLOOR)
    (only,) = rank(before, score, [effects()["hysteresis-shape"]])
    assert only.declined


@pytest.mark.parametrize("gains", [2, 7, 10])
def test_a_model_that_runs_away_on_a_fold_is_told_in_finite_numbers(monkeypatch, gains):
    """Its output may be beyond all numbers, or its square alone."""
    item, before, score = candidate([1.1] * 6)

    def run_away(*_):
        return with_gain(before, 1e30, gains), np.inf

    monkeypatch.setattr(cross_validation, "refit", run_away)
    judged = on_folds(item, before, score)
    assert np.isfinite([judged.gain, judged.score, judged.gain_on_folds]).all()
    assert judged.gain < 0


def test_what_does_not_pay_or_was_not_refitted_is_not_put_to_folds():
    item, before, score = candidate([1.1] * 6)
    for other in (replace(item, gain=PAYS - 0.1), replace(item, state=None)):
        assert on_folds(other, before, score) is other


def test_finalists_are_ranked_by_their_gain_on_folds():
    given = measured(lines(6), [1.0] * 6, bend=0.08)
    before = state_of((block("gain", value=1.0),), given)
    score = make_score(before, FLOOR)
    ranking = rank(before, score)
    judged = [item for item in ranking if item.gain_on_folds is not None]
    assert judged[0] is ranking[0]
    for item in judged:
        told = gain_on_folds(before, item.state, score)
        assert item.gain_on_folds == pytest.approx(told)
        on_all = score_of(before, score) - score_of(item.state, score)
        # Of several laws and places one alone may fit: then it pays for the others.
        paid = min(on_all, told - PARAMETER * item.state.freedom) - item.gain
        assert -1e-6 <= paid <= SCALE * np.log(len(item.variants)) + 1e-6
        assert item.score + item.gain == pytest.approx(score_of(before, score))
    rest = [item for item in ranking if item.state is not None and item not in judged]
    # Folds only take gain away, so none of these could have come first.
    assert rest
    behind = ranking[0].score + CERTAIN
    assert all(item.gain < PAYS or item.score >= behind for item in rest)

"""An effect looked at again: what is kept of the second look."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect, without_effect
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.refit import added, finished
from hystbench.gap.fitting.tried import trials_of
from hystbench.gap.judging.effect_rows import ranking_rows
from hystbench.gap.naming import second_looks as reconsider
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import WIDER, Candidate, Round
from hystbench.gap.naming.second_looks import reconsidered
from hystbench.gap.progress import silent
from hystbench.gap.records.floor import Floor
from hystbench.gap.thresholds import PAYS, SCALE
from tests.gap.small import block, measured, state_of

NOISE = 0.02
FLOOR = Floor(NOISE, "declared")
FORMS = "generalized plays", "plays"


@pytest.fixture(scope="module")
def two():
    """A model with two effects, and the round in which the first was taken."""
    gain = block("gain", value=12.0)
    lag = block("drive-lag", time_constant_s=0.004)
    before = state_of((gain,), measured((lag, gain), NOISE))
    after = before
    values = {"drive-lag": {"time_constant_s": 0.004}, "asymmetry": {"coefficient": 0}}
    for name, own in values.items():
        variant = next(iter(effects()[name].variants(after.simulation)))
        after = with_effect(after, variant, own)
    first = Candidate("drive-lag", "drive", score=-100.0, gain=90.0, state=after)
    return after, (Round(before, -10.0, (first,), True),)


@pytest.mark.parametrize("declined", [False, True])
def test_a_second_look_counts_only_where_the_effect_itself_could_be_judged(
    two, declined, monkeypatch
):
    """Its own candidate may decline there: at an end of its range, for example."""
    state, rounds = two

    def looked(short, score, known, folds):
        (name,) = (item.name for item in known)
        if declined and name == "drive-lag":
            return (Candidate(name, "drive", declined="fits best at the end"),)
        return (Candidate(name, "drive", score=0.0, gain=1.0, state=state),)

    monkeypatch.setattr(reconsider, "rank", looked)
    kept, looks = reconsidered(state, rounds, FLOOR, silent)
    assert kept is state
    # Every look is kept; where it could not judge, the effect stays by an earlier one.
    assert [(look.instead_of, look.beside) for look in looks] == [
        ("drive-lag", ("asymmetry",)),
        ("asymmetry", ("drive-lag",)),
    ]
    assert [look.taken for look in looks] == [
        None if declined else "drive-lag",
        "asymmetry",
    ]
    again = replace(rounds[0], taken=False, looks=looks)
    by_effect = Named(state, (*rounds, again)).reasons
    last = rounds[0].ranking if declined else looks[0].ranking
    assert by_effect["drive-lag"] is last
    # The model that is there scores better than what the second look came to.
    (own,) = by_effect["asymmetry"]
    kept, now = finished(state, make_score(without_effect(state, 1), FLOOR))
    assert own.state.chain == kept.chain
    assert own.score == pytest.approx(now)
    assert own.score < 0.0
    assert own.score + own.gain == pytest.approx(1.0)


def test_an_effect_whose_refit_lost_its_way_is_looked_at_again(two, monkeypatch):
    """Beside the second effect a wrong shape may no longer hide what it does."""
    state, (first,) = two
    lost = Candidate("eddy-diffusion", "drive", declined=WIDER)
    never = Candidate("creep", "mechanics", declined="added already")
    rounds = (replace(first, ranking=(*first.ranking, lost, never)),)
    asked = {}

    def looked(short, score, known, folds):
        names = [item.name for item in known]
        asked[next(x for x in ("drive-lag", "asymmetry") if x in names)] = names
        return tuple(Candidate(name, "drive", state=state) for name in names)

    monkeypatch.setattr(reconsider, "rank", looked)
    reconsidered(state, rounds, FLOOR, silent)
    assert set(asked["drive-lag"]) == {"drive-lag", "eddy-diffusion"}
    # It was declined in the round of the other effect.
    assert asked["asymmetry"] == ["asymmetry"]


def test_a_rival_that_takes_a_place_is_seen_with_what_it_scored(two, monkeypatch):
    """The sensor's lag does better in the place of the drive's: it takes it."""
    state, rounds = two
    # Any model in which the rival was added last: the search is replaced.
    lag = state.added[0]._replace(effect="sensor-lag")
    other = replace(state, added=(state.added[1], lag))

    def looked(short, score, known, folds):
        assert {item.name for item in known} >= {"drive-lag", "sensor-lag"}
        assert [item.effect for item in short.added] == ["asymmetry"]
        best = Candidate("sensor-lag", "sensor", score=-1e6, gain=9.0, state=other)
        old = Candidate("drive-lag", "drive", score=50.0, gain=1.0, state=state)
        return (best, old)

    monkeypatch.setattr(reconsider, "rank", looked)
    monkeypatch.setattr(reconsider, "gain_on_folds", lambda *_: PAYS + 50.0)
    after, (look,) = reconsidered(state, rounds, FLOOR, silent, {"sensor-lag"})
    assert after.chain is other.chain
    assert [item.effect for item in after.added] == ["sensor-lag", "asymmetry"]
    assert look.ranking[0].gain_on_folds == PAYS + 50.0
    assert (look.instead_of, look.taken) == ("drive-lag", "sensor-lag")
    rows = ranking_rows(Named(after, (replace(rounds[0], looks=(look,)),)))
    assert [
        (row["look"], row["instead_of"], row["beside"], row["name"], row["taken"])
        for row in rows
    ] == [
        (0, None, [], "drive-lag", True),
        (1, "drive-lag", ["asymmetry"], "sensor-lag", True),
        (1, "drive-lag", ["asymmetry"], "drive-lag", False),
    ]
    assert [row["score"] for row in rows] == [-100.0, -1e6, 50.0]


@pytest.mark.parametrize(("numbers", "taken"), [(0.0, True), (1.0, False)])
def test_of_a_tie_a_rival_of_fewer_numbers_takes_the_place(
    numbers, taken, two, monkeypatch
):
    state, rounds = two
    lag = state.added[0]._replace(effect="sensor-lag", charge=numbers)
    other = replace(state, added=(state.added[1], lag))

    def looked(short, score, known, folds):
        if [item.effect for item in short.added] != ["asymmetry"]:
            return (Candidate("asymmetry", "material", score=0.0, state=state),)
        _, now = finished(state, score)
        best = Candidate("sensor-lag", "sensor", score=now - SCALE / 2, state=other)
        return best, Candidate("drive-lag", "drive", score=now, state=state)

    monkeypatch.setattr(reconsider, "rank", looked)
    monkeypatch.setattr(reconsider, "gain_on_folds", lambda *_: PAYS + 50.0)
    after, _ = reconsidered(state, rounds, FLOOR, silent, {"sensor-lag"})
    assert state.added[0].charge == 1.0
    assert ("sensor-lag" in {item.effect for item in after.added}) == taken


def test_a_rival_that_does_not_pay_on_records_held_back_takes_no_place(
    two, monkeypatch
):
    state, rounds = two

    def looked(short, score, known, folds):
        assert not folds
        rival = Candidate("creep", "mechanics", score=-1e6, gain=900.0, state=state)
        own = [Candidate(x.name, "", score=50.0, gain=1.0, state=state) for x in known]
        return rival, *own

    monkeypatch.setattr(reconsider, "rank", looked)
    monkeypatch.setattr(reconsider, "gain_on_folds", lambda *_: PAYS - 1.0)
    after, looks = reconsidered(state, rounds, FLOOR, silent)
    assert after is state
    assert [look.taken for look in looks] == ["drive-lag", "asymmetry"]
    for look in looks:
        told = {item.effect: item.gain_on_folds for item in look.ranking}
        assert told["creep"] == PAYS - 1.0


def test_the_model_that_is_there_stands_where_its_score_puts_it(two, monkeypatch):
    """A search from anew may end behind a rival that the model itself is ahead of."""
    state, rounds = two
    scores = []

    def looked(short, score, known, folds):
        _, now = finished(state, score)
        scores.append(now)
        rival = Candidate("creep", "mechanics", score=now + 1, gain=2.0, state=state)
        return rival, *(
            Candidate(x.name, x.place, score=now + 2, gain=1.0, state=state)
            for x in known
            if x.name in ("drive-lag", "asymmetry")
        )

    monkeypatch.setattr(reconsider, "rank", looked)
    _, looks = reconsidered(state, rounds, FLOOR, silent)
    assert len(looks) == len(scores) == 2
    for look, now in zip(looks, scores, strict=True):
        assert [item.effect for item in look.ranking] == [look.instead_of, "creep"]
        assert [item.score for item in look.ranking] == [now, now + 1]


def test_what_an_effect_does_is_not_free_for_its_rivals(two, monkeypatch):
    """Its own other forms span what it does: a rival need not do it under them."""
    state, rounds = two
    free = {}

    def looked(short, score, known, folds):
        (gone,) = {x.effect for x in state.added} - {x.effect for x in short.added}
        does = short.residual - state.residual
        rest, _ = score.split(does)
        size = np.linalg.norm(does)
        free[gone] = 1 - np.linalg.norm(rest) / size if size else 0.0
        return (Candidate(gone, "", score=0.0, gain=1.0, state=state),)

    monkeypatch.setattr(reconsider, "rank", looked)
    reconsidered(state, rounds, FLOOR, silent)
    assert set(free) == {"drive-lag", "asymmetry"}
    assert free["drive-lag"] < 0.5


@pytest.mark.parametrize(
    ("own", "rival", "form", "score"),
    [
        (-10.0, -1.0, "another", -10.0),
        (-2.0, -1.0, "", 0.0),  # not enough to be taken: the model is as it was
        (-10.0, -12.0, "another", -10.0),  # a rival has to beat the better form
        (5.0, 6.0, "", 0.0),
    ],
)
def test_another_form_of_an_effect_is_taken_where_it_does_better(
    own, rival, form, score, two, monkeypatch
):
    """The rows then tell of the form that is in the model, and of no other."""
    state, rounds = two
    anew = replace(state, added=state.added[::-1])  # as it was added last

    def looked(short, score, known, folds):
        (gone,) = {x.effect for x in state.added} - {x.effect for x in short.added}
        if gone == "asymmetry":
            return (Candidate(gone, "", "", score=0.0, gain=1.0, state=state),)
        rows = (
            Candidate(gone, "", "another", score=own, gain=30.0 - own, state=anew),
            Candidate("creep", "", score=rival, gain=30.0 - rival, state=state),
        )
        return tuple(sorted(rows, key=lambda row: row.score))

    def fitted(one, score):
        return one, own if one is anew else 0.0

    monkeypatch.setattr(reconsider, "rank", looked)
    monkeypatch.setattr(reconsider, "finished", fitted)
    found, looks = reconsidered(state, rounds, FLOOR, silent)
    assert (found is state) is not bool(form)
    assert found.added == state.added  # in the order in which they came
    assert [look.taken for look in looks] == ["drive-lag", "asymmetry"]
    row = next(x for x in looks[0].ranking if x.effect == "drive-lag")
    assert (row.form, row.score, row.gain) == (form, score, 30.0 - score)


@pytest.mark.parametrize("loop", [False, True])
def test_a_hysteresis_without_a_loop_gives_way_to_a_curve(loop):
    """Plays that bend much fit a saturation too; all of them then do nothing."""
    gain = block("gain", value=12.0)
    device = (
        block("prandtl-ishlinskii", thresholds=(0.0, 0.2), weights=(0.0, -0.3))
        if loop
        else block("saturation", level=0.6)
    )
    before = state_of((gain,), measured((device, gain), NOISE), count=600)
    score = make_score(before, FLOOR)
    every, _ = trials_of(effects()["hysteresis"], before, score)
    plays = next(trial for trial in every if trial.variant.form == FORMS[loop])
    state, _ = added(before, plays, score)
    kept, _ = reconsidered(state, (), FLOOR, silent)
    names = [item.effect for item in kept.added]
    assert names == (["hysteresis"] if loop else ["saturation"])

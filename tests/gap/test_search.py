"""What is said of a verdict beside the word."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.curve import finer
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.errors import InputError
from hystbench.gap import gap_search
from hystbench.gap.asked import Asked
from hystbench.gap.bases.linear import CURVE, IdentifiedModel
from hystbench.gap.beside_base import BesideBase
from hystbench.gap.effects import effects
from hystbench.gap.experiment import tell_apart
from hystbench.gap.experiment.candidates import Limits
from hystbench.gap.experiment.separation import RivalPair
from hystbench.gap.experiment.tell_apart import next_experiment
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.fitting.own_values import NONE
from hystbench.gap.fitting.score import Score
from hystbench.gap.inside.choose import most_inside
from hystbench.gap.judge_and_tell import judge_and_tell
from hystbench.gap.judging.leftover import Leftover
from hystbench.gap.naming.add_effects import Named
from hystbench.gap.naming.rounds import Candidate, Round, SecondLook
from hystbench.gap.thresholds import FURTHER, PAYS
from hystbench.model import Model
from hystbench.quantities import Quantities
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.searched import among, search
from tests.gap.small import block, hysteresis, measured


def test_what_stays_says_of_what_it_is_a_share():
    """5 % of what no shape explains stays, and 40 % of the whole residual."""
    said = Leftover(
        before=100.0, after=5.0, all_before=1000.0, all_after=400.0
    ).sentence
    assert "on the fit records 40 % of the gap's power above the noise floor" in said
    assert "part that no wrong shape of the hysteresis could leave, 5 %" in said


def test_one_figure_is_told_where_both_are_alike():
    assert Leftover(100.0, 5.0, 1000.0, 60.0).sentence.count("%") == 1
    # The whole may be the lesser share: then it is the one that decides.
    said = Leftover(100.0, 50.0, 1000.0, 60.0).sentence
    assert "6 %" in said
    assert "50 %" not in said


@pytest.mark.parametrize(("noise", "word"), [(0.05, "no-gap"), (1.0, "unnamed")])
def test_much_noise_is_no_gap_only_where_it_is_known(noise, word):
    """The same records, a base that is right: the floor declared, and as a bound."""
    chain = (block("gain", value=12.0),)
    base = Model("base", CURRENT, DISPLACEMENT, chain)
    given = measured(chain, noise)
    content = search("made", given, base, declared=noise).content
    assert content["verdict"] == "no-gap"
    content = search("made", given, base).content
    assert content["verdict"] == word
    assert ("only an upper bound" in content["reason"]) == (word == "unnamed")


def with_named(state, effect, **values):
    variant = next(iter(effects()[effect].variants(state.simulation)))
    return with_effect(state, variant, values)


@pytest.fixture(scope="module")
def alike():
    """A lag before or behind a plain gain: no record can tell."""
    chain = (block("gain", value=12.0),)
    base = Model("base", CURRENT, DISPLACEMENT, chain)
    lagged = (*chain, block("sensor-lag", time_constant_s=0.004))
    start, floor = start_state(measured(lagged, 0.02), base, declared=0.02)
    found = {
        name: with_named(start, name, time_constant_s=0.004)
        for name in ("drive-lag", "sensor-lag")
    }
    found["input-delay"] = with_named(start, "input-delay", delay_s=0.004)
    found["mains-pickup"] = with_named(start, "mains-pickup", frequency_hz=50.0)
    return base, start, floor, found


def test_what_is_new_in_every_record_is_not_free_in_the_model(alike):
    """Its numbers are of these records; another has its own."""
    base, _, _, found = alike
    assert augmented(base, found["mains-pickup"]).free == ()
    assert augmented(base, found["sensor-lag"]).free == ("sensor-lag.time_constant_s",)


def candidates_of(found, *names):
    return tuple(
        Candidate(name, "drive", score=-100.0 + k, gain=90.0, state=found[name])
        for k, name in enumerate(names)
    )


def rounds_of(start, found, *names):
    """One round, that took the first."""
    ranking = candidates_of(found, *names)
    return Named(found[names[0]], (Round(start, 0.0, ranking, True),))


def in_a_chain(base, start, floor, named):
    return BesideBase(base, start, floor, named, None, NONE)


def decided(alike, *names, base=None, limits=None):
    plain, start, floor, found = alike
    named = rounds_of(start, found, *names)
    base = plain if base is None else base
    return judge_and_tell(
        "made", in_a_chain(base, start, floor, named), Asked(), limits
    )


def test_the_next_experiment_keeps_within_the_limits_that_were_asked(alike):
    _, start, _, _ = alike
    asked = {"low": 0.1, "high": 0.25, "rate": 20.0}
    limits = Limits.of(start.records, asked)
    own = Limits.of(start.records)
    assert (limits.dt, limits.bandwidth_hz) == (own.dt, own.bandwidth_hz)
    names = ("drive-lag", "input-delay")
    inputs = []
    for given in (None, limits):
        decision = decided(alike, *names, limits=given)
        assert "no_experiment" not in decision.content
        made = decision.experiment.excitation
        inputs.append((made.u, np.abs(np.diff(made.u)).max() / made.dt))
    (u, rate), (within, slow) = inputs
    assert within.min() > 0.1 - 1e-6
    assert within.max() < 0.25 + 1e-6
    assert slow < 20.0 * (1 + 1e-5)
    # The records go beyond all of that, and so does what is taken from them.
    assert u.min() < 0.1
    assert u.max() > 0.25
    assert rate > 20.0


def test_limits_that_no_input_fits_are_refused_before_the_search(alike, monkeypatch):
    base, start, _, _ = alike
    searched = lambda *given: pytest.fail("searched")  # noqa: E731
    monkeypatch.setattr(gap_search, "add_effects", searched)
    with pytest.raises(InputError, match="expected low < high"):
        search("made", start.records, base, limits={"low": 1.0, "high": 0.5})


def too_narrow(alike, names, monkeypatch):
    """No excitation keeps within the limits."""

    def refuse(*given):
        return next_experiment(*given[:-1], ())

    with monkeypatch.context() as patched:
        patched.setattr(tell_apart, "next_experiment", refuse)
        return decided(alike, *names)


def test_why_there_is_no_experiment_is_told(alike, monkeypatch):
    base, start, _, _ = alike
    names = ("drive-lag", "sensor-lag")
    column = SimulatedColumn(column="y_um", records=start.records)
    elsewhere = replace(base, chain=(column,))

    for decision, word in (
        (decided(alike, *names, base=elsewhere), "ran elsewhere"),
        (decided(alike, "drive-lag", "mains-pickup"), "new in every record"),
        (too_narrow(alike, names, monkeypatch), "expected wider limits"),
    ):
        assert decision.content["effects"][0]["cannot_be_told_from"]
        assert decision.content["next_experiment"] is None
        assert word in decision.content["no_experiment"]
    alone = decided(alike, "drive-lag").content
    assert alone["next_experiment"] is None
    assert "no_experiment" not in alone


def test_what_is_new_in_every_record_is_left_out_by_name(alike):
    content = decided(alike, "drive-lag", "mains-pickup", "sensor-lag").content
    found = content["next_experiment"]
    (pair,) = found["pairs"]
    assert (pair["of"], pair["names"]) == ("drive-lag", ["drive-lag", "sensor-lag"])
    assert found["left_out"] == [{"of": "drive-lag", "name": "mains-pickup"}]
    assert "mains-pickup is new in every record" in found["sentence"]
    assert "no_experiment" not in content
    # Where none is left for another reason too, both are told.
    words = decided(alike, "drive-lag", "mains-pickup").content["no_experiment"]
    assert words.startswith("mains-pickup is new in every record")


def test_rivals_beside_what_is_new_in_every_record_are_told_apart_without_it(alike):
    """The mains are in both models; of another record nobody knows their phase."""
    base, start, floor, found = alike
    lags = {
        name: with_named(found["mains-pickup"], name, time_constant_s=0.004)
        for name in ("drive-lag", "sensor-lag")
    }
    named = rounds_of(start, lags, "drive-lag", "sensor-lag")
    beside = judge_and_tell(
        "made", in_a_chain(base, start, floor, named), Asked(), None
    ).experiment
    plain = decided(alike, "drive-lag", "sensor-lag").experiment
    assert beside.left_out == ()
    assert beside.excitation.words == plain.excitation.words
    assert beside.pairs == pytest.approx(plain.pairs, abs=1e-6)


def test_all_members_of_all_sets_are_told_apart_by_one_excitation(alike, monkeypatch):
    """A second look at the lag: the model that is there is then in both sets."""
    base, start, floor, found = alike
    lag = found["drive-lag"]
    whole = with_named(lag, "asymmetry", coefficient=1e-3)
    other = with_named(found["sensor-lag"], "asymmetry", coefficient=1e-3)
    curves = {
        "asymmetry": whole,
        "saturation": with_named(lag, "saturation", level=40.0, sharpness=2.0),
        "calibration-error": with_named(lag, "calibration-error", gain=1.01),
    }
    lags = {"drive-lag": whole, "sensor-lag": other}
    look = SecondLook(
        "drive-lag", ("asymmetry",), candidates_of(lags, *lags), "drive-lag"
    )
    rounds = (
        Round(start, 0.0, candidates_of(found, *lags), True),
        Round(lag, 0.0, candidates_of(curves, *curves), True, (look,)),
    )
    model = augmented(base, whole)
    runs = []
    simulate = Model.simulate

    def counted(self, u, dt):
        if self == model:
            runs.append(id(u))
        return simulate(self, u, dt)

    monkeypatch.setattr(Model, "simulate", counted)
    experiment, why = tell_apart.tell_apart(
        base, Named(whole, rounds), start.records, floor, None
    )
    assert not why
    assert list(experiment.pairs) == [
        RivalPair("drive-lag", ("drive-lag", "sensor-lag")),
        RivalPair("asymmetry", ("asymmetry", "saturation")),
        RivalPair("asymmetry", ("asymmetry", "calibration-error")),
        RivalPair("asymmetry", ("saturation", "calibration-error")),
    ]


def test_what_the_simulation_misses_by_its_steps_is_measured():
    """Far more steps of the loop than ours tell it independently."""
    chain = (hysteresis(),)
    base = Model("rig", CURRENT, DISPLACEMENT, chain)
    start, floor = start_state(measured(chain, 0.02), base, "band-limited", 0.02)
    beside = in_a_chain(base, start, floor, Named(start))
    found = judge_and_tell("made", beside, Asked(), None).content["fit"]
    missed = []
    for one in start.records:
        fine = finer(one.u, 64)
        exact = chain[0].simulate(fine, fine, one.dt / 64)[::64]
        missed.append(chain[0].simulate(one.u, one.u, one.dt) - exact)
    size = float(np.sqrt(np.mean(np.concatenate(missed) ** 2)))
    assert found["step_error"] == pytest.approx(size, rel=0.2)
    gain = (block("gain", value=12.0),)
    base = Model("rig", CURRENT, DISPLACEMENT, gain)
    start, floor = start_state(measured(gain, 0.02), base, "band-limited", 0.02)
    beside = in_a_chain(base, start, floor, Named(start))
    found = judge_and_tell("made", beside, Asked(), None).content["fit"]
    assert found["step_error"] == pytest.approx(0.0, abs=1e-9)


def test_the_ranking_tells_of_every_place_and_form():
    lag = block("sensor-lag", time_constant_s=4e-3)
    chain = (hysteresis(), lag)
    base = Model("rig", CURRENT, DISPLACEMENT, chain)
    curve = block("sensor-nonlinearity", quadratic=0.03, cubic=0.0)
    given = measured((hysteresis(), curve, lag), 0.02)
    content = search("made", given, base, declared=0.02).content
    rows = {row["name"]: row for row in content["ranking"] if row["round"] == 1}
    tried = rows["sensor-nonlinearity"]["variants"]
    # The square, the cube and both, behind the lag and before it.
    ways = {(one["form"], one["position"]) for one in tried}
    assert ways == {(f, k) for f in ("square", "cube", "both") for k in (1, 2)}
    scores = [one["score"] for one in tried]
    assert scores == sorted(scores)
    beside = rows["mains-pickup"].get("variants", [])
    assert all(one["position"] is None for one in beside)


@pytest.mark.parametrize(("effects", "most"), [(1, 0), (2, 1)])
def test_forces_have_to_be_fewer_than_what_leaves_nothing(alike, effects, most):
    """They could gain no more than noise allows, whatever they are."""
    _, _, floor, found = alike
    state = found["sensor-lag"]
    named = Named(replace(state, added=state.added * effects), ())
    assert most_inside(named, floor) == most
    # Where a gap is left as many may be more as could pay for themselves.
    base = replace(named, state=alike[1])
    score = Score.plain(base.state.sample, floor.rms**2)
    left = score_of(base.state, score) - score.least(base.state.freedom)
    there = len(base.state.added)
    assert most_inside(base, floor) == there + (left - PAYS) // FURTHER > there
    # A path bends to whatever is there, and leaves nothing to any law. So do plays.
    path = state.added[0]._replace(effect="drift", form="winding path")
    plays = state.added[0]._replace(effect="hysteresis", charge=16.0)
    for bends in (path, plays):
        free = replace(named, state=replace(state, added=(bends,)))
        assert most_inside(free, floor) == np.inf


def test_a_path_that_leaves_nothing_is_no_reason_to_try_no_forces(monkeypatch):
    """Beside a base that was found behind a curve a chain is tried first."""
    curved = (block("sensor-nonlinearity", quadratic=0.2, cubic=0.0),)
    gain = (block("gain", value=12.0),)
    made = [
        replace(one, y=one.y + 0.5 * np.linspace(0.0, 1.0, len(one)) ** 2)
        for one in measured(gain, 0.02)
    ]
    asked, tried = [], ("drift", "sensor-nonlinearity")

    def forces(*args, **more):
        asked.append(args)

    monkeypatch.setattr(gap_search, "named_inside", forces)
    base = IdentifiedModel("base", CURRENT, DISPLACEMENT, gain, found_with=CURVE)
    takes = Quantities("force", "position")
    about = {"quantities": takes, "vocabulary": among(*tried), "declared": 0.02}
    search("made", made, base, **about)
    assert asked
    # A law that leaves nothing is a reason.
    asked.clear()
    search("made", measured((*gain, *curved), 0.02), base, **about)
    assert not asked


def test_a_base_found_with_an_effect_that_is_not_named_is_the_plain_one():
    """Without the limit that it was found with, it is no model of the records."""
    gain = (block("gain", value=12.0, offset=0.0),)
    wrong = (block("gain", value=7.0, offset=0.0),)
    base = IdentifiedModel(
        *("base", CURRENT, DISPLACEMENT, wrong),
        free=("gain.value", "gain.offset"),
        found_with="slew-limit",
    )
    found = search("made", measured(gain, 0.02), base, vocabulary=among("slew-limit"))
    assert found.base.chain[0].value == pytest.approx(12.0, rel=1e-2)
    assert "without slew limit, which is not named" in found.content["reason"]

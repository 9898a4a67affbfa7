"""In which order effects inside are told, and against what each is held."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from hystbench.gap import gap_search
from hystbench.gap import search as search_module
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.bases.load import load_base
from hystbench.gap.effects import effects
from hystbench.gap.effects.law import Passed
from hystbench.gap.fitting.least_squares import Fitted
from hystbench.gap.fitting.state import Added
from hystbench.gap.inside import combine_forces
from hystbench.gap.inside import named_inside as named_inside_module
from hystbench.gap.inside.choose import as_rounds, chosen
from hystbench.gap.inside.combine_forces import ForceSearch
from hystbench.gap.inside.named_inside import Inside, beats_chain
from hystbench.gap.inside.other_names import of_one_name
from hystbench.gap.naming.add_effects import Named, add_effects
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.free_mass import windows
from hystbench.model import Model
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.searched import among, search
from tests.gap.small import block


def added(names):
    return [SimpleNamespace(effect=x, place="inside", form="") for x in names]


def tried(score, *effects):
    state = SimpleNamespace(added=added(effects))
    return Fitted(state, score)


def test_an_effect_that_does_little_alone_comes_behind_the_one_that_it_needs():
    best = tried(-500.0, "outflow", "overflow")
    found = [
        tried(0.0),
        tried(-200.0, "overflow"),
        tried(-10.0, "outflow"),
        best,
        tried(-250.0, "overflow", "stop"),
        tried(-30.0, "outflow", "stop"),
    ]
    first, second = as_rounds(found[0].state, best, found)
    assert [x.effect for x in first.ranking] == ["overflow", "outflow"]
    assert [x.effect for x in second.ranking] == ["outflow", "stop"]
    assert [x.gain for x in second.ranking] == [300.0, 50.0]
    # In the place of the first one: what was tried beside the second, not alone.
    (look,) = second.looks
    assert (look.instead_of, look.beside) == ("overflow", ("outflow",))
    assert look.taken == "overflow"
    assert [x.effect for x in look.ranking] == ["overflow", "stop"]
    assert [x.gain for x in look.ranking] == [490.0, 20.0]


def test_where_one_order_of_three_was_tried_it_is_the_one_that_is_told():
    best = tried(-900.0, "drag", "stop", "friction")
    found = [
        tried(0.0),
        tried(-100.0, "friction"),
        tried(-50.0, "drag"),
        tried(-300.0, "drag", "stop"),
        best,
    ]
    told = as_rounds(found[0].state, best, found)
    assert [one.ranking[0].effect for one in told] == ["drag", "stop", "friction"]


def test_without_an_effect_there_is_no_round():
    alone = tried(0.0)
    assert as_rounds(alone.state, alone, [alone]) == []


class Told(SimpleNamespace):
    """A state of which only the power of its residual is known."""

    def power(self, floor):
        return self.left - floor

    gap = power

    def share(self, other, floor, gap):
        return (other.power(floor) - self.power(floor)) / gap


def measured(score, left, *effects):
    state = Told(left=left, freedom=len(effects), added=added(effects))
    return Fitted(state, score)


@pytest.mark.parametrize(
    ("left", "share", "count"), [(0.02, 0.01, 2), (0.095, 0.01, 1), (0.02, 0.1, 1)]
)
def test_a_further_effect_that_takes_no_share_of_the_gap_must_be_beyond_doubt(
    left, share, count
):
    """What matters is what the user says may stay unnamed."""
    found = [
        measured(0.0, 1.0),
        measured(-900.0, 0.1, "friction"),
        measured(-1050.0, left, "friction", "input-delay"),
    ]
    assert len(chosen(found, 0.0, share).effects) == count


@pytest.mark.parametrize(
    ("behind", "name"), [(3.0, "gravity"), (5.0, "stiffness-hardening")]
)
def test_of_a_tie_a_weight_that_turns_is_likelier_than_a_softer_spring(behind, name):
    found = [
        measured(0.0, 1.0),
        measured(-900.0, 0.1, "stiffness-hardening"),
        measured(-900.0 + behind, 0.1, "gravity"),
    ]
    assert chosen(found, 0.0).effects == (name,)


@pytest.mark.parametrize(
    ("single", "pair", "levels"),
    [(-900.0, -950.0, 1), (-900.0, -1050.0, 2), (-30.0, -50.0, 2)],
)
def test_threes_are_tried_where_a_pair_pays_or_no_single_does(
    single, pair, levels, monkeypatch
):
    """Forces that gain little alone may gain much together."""
    tried_levels = []

    def one_more(self, carried, *_):
        tried_levels.append(len(carried[0].effects) + 1)
        return [chained(pair, *carried[0].effects, "drag")]

    def chained(score, *effects):
        state = SimpleNamespace(chain=(), added=added(effects), freedom=0.0)
        return Fitted(state, score)

    monkeypatch.setattr(ForceSearch, "one_more", one_more)
    monkeypatch.setattr(combine_forces, "with_one_fewer", lambda *_, **__: [])
    monkeypatch.setattr(ForceSearch, "with_another", lambda *_: [])
    monkeypatch.setattr(combine_forces, "by_other_laws", lambda *_: [])
    score = SimpleNamespace(least=lambda freedom: -5000.0)
    found = [chained(0.0), chained(single, "friction")]
    ForceSearch(lambda _: {}, score).together(found)
    assert tried_levels == [2, 3][:levels]


def test_another_effect_is_put_where_the_search_has_not_gone_on(monkeypatch):
    """It went on from friction; of drag beside nothing nobody has asked."""
    begun = []

    def of(*effects):
        state = SimpleNamespace(chain=(), added=added(effects), freedom=0.0, sample=[0])
        return Fitted(state, 0.0)

    def without(state, place):
        left = [x.effect for k, x in enumerate(state.added) if k != place]
        return of(*left).state

    monkeypatch.setattr(combine_forces, "without_effect", without)
    monkeypatch.setattr(combine_forces, "fitted", lambda state, _: Fitted(state, 0.0))
    monkeypatch.setattr(
        ForceSearch, "one_more", lambda self, found, *_: begun.extend(found)
    )
    best = of("friction", "drag")
    ForceSearch(None, None).with_another(best, [of("friction")], 0.0)
    assert [item.effects for item in begun] == [("drag",)]


@pytest.fixture(scope="module")
def sliding():
    """Records of friction whose law has another form, and a linear base of them."""
    t = 0.005 * np.arange(600)
    given = []
    for size in (2.0, 5.0):
        x = size * (np.sin(4.0 * t) + 0.2 * np.sin(9.1 * t))
        v = np.gradient(x, 0.005)
        y = 0.03 * v + 0.4 * x + 8.0 / np.pi * np.arctan(v / 1.5)
        channels = Channel("way", "mm"), Channel("force", "N")
        given.append(Record(f"{size}", 0.005, x, y, *channels, "measured", "fit"))
    kinds = Quantities("position", "force")
    evidence = Evidence("made", tuple(given), (), quantities=kinds)
    return evidence, load_base("linear", evidence)[0]


@pytest.mark.parametrize(("share", "chain"), [(0.01, False), (1e-6, True)])
def test_where_no_more_is_left_than_may_stay_no_chain_is_tried(
    share, chain, sliding, monkeypatch
):
    """The friction leaves far more than the noise."""
    evidence, base = sliding
    calls = []

    def counted(*args, **kwargs):
        calls.append(args)
        return add_effects(*args, **kwargs)

    monkeypatch.setattr(gap_search, "add_effects", counted)
    found = search(
        "made",
        evidence.fit,
        base,
        declared=1e-4,
        unnamed_share=share,
        vocabulary=among("friction"),
        quantities=evidence.quantities,
    )
    assert bool(calls) == chain
    assert found.content["fit"]["after"] > 1e-4
    assert [item["name"] for item in found.content["effects"]] == ["friction"]


class FarEnoughError(Exception):
    """The search has come to what is tested."""


def spring_found_once(host, spring, key):
    """What records are when forces are looked for, and a look that finds a spring."""
    seen = []

    def look(base, start, *_, kinds, **__):
        seen.append([getattr(record, key) for record in start.records])
        if len(seen) > 1:
            assert kinds == ("given",)
            raise FarEnoughError
        assert kinds == ()
        added = Added("stiffness-hardening", "inside", "", (1,), {}, 1.0)
        state = replace(start, chain=(host, spring), added=(added,)).settled()
        return Inside(base, start, Named(state), "", host="given")

    return seen, look


def test_forces_are_looked_for_again_without_the_starts_that_they_show(monkeypatch):
    """A linear base is too far off to show that a record begins in a motion."""
    host = block("mechanism", mass=1.0, damping=6.0, stiffness=100.0)
    spring = block("stiffness", quadratic=0.0, cubic=70.0)
    channels, t = (Channel("f", "N"), Channel("x", "mm")), 0.01 * np.arange(2500)
    u = 30 * np.sin(2.0 * t) + 30 * np.sin(7.3 * t + 0.5)
    y = Model("plant", *channels, (host, spring)).simulate(u, 0.01)
    given = tuple(
        Record(f"{k}", 0.01, u[k:], y[k:], *channels, "measured", "fit")
        for k in (0, 530)
    )
    base = IdentifiedModel("linear", *channels, (host,), ("mechanism.mass",))
    seen, look = spring_found_once(host, spring, "lead")
    monkeypatch.setattr(gap_search, "named_inside", look)
    about = {"declared": 1e-3, "quantities": Quantities("force", "position")}
    with pytest.raises(FarEnoughError):
        search("made", given, base, **about, vocabulary=among("stiffness-hardening"))
    assert seen == [[0, 0], [0, 197]]


@pytest.mark.parametrize(("form", "chain"), [("", False), ("winding path", True)])
def test_beside_a_path_that_bends_to_all_a_chain_is_tried_too(form, chain, monkeypatch):
    """The spring leaves nothing, and so may any force with a path of every record."""
    host = block("mechanism", mass=1.0, damping=6.0, stiffness=100.0)
    spring = block("stiffness", quadratic=0.0, cubic=70.0)
    channels, t = (Channel("f", "N"), Channel("x", "mm")), 0.01 * np.arange(1000)
    u = 30 * np.sin(2.0 * t) + 30 * np.sin(7.3 * t)
    y = Model("plant", *channels, (host, spring)).simulate(u, 0.01)
    y += 1e-3 * np.random.default_rng(1).standard_normal(len(y))
    given = (Record("r", 0.01, u, y, *channels, "measured", "fit"),)
    base = IdentifiedModel("linear", *channels, (host,), ("mechanism.mass",))
    tried = []

    def look(base, start, *_, **__):
        added = Added("drift" if form else "stop", "inside", form, (1,), {}, 1.0)
        state = replace(start, chain=(host, spring), added=(added,)).settled()
        return Inside(base, start, Named(state), "")

    def in_a_chain(start, *_):
        tried.append(start)
        raise FarEnoughError

    def stop(*_):
        raise FarEnoughError

    monkeypatch.setattr(gap_search, "named_inside", look)
    monkeypatch.setattr(gap_search, "beside_forces", lambda named, *_: named)
    monkeypatch.setattr(gap_search, "add_effects", in_a_chain)
    monkeypatch.setattr(search_module, "judge_and_tell", stop)
    about = {"declared": 1e-3, "quantities": Quantities("force", "position")}
    with pytest.raises(FarEnoughError):
        search("made", given, base, **about)
    assert bool(tried) == chain


def test_forces_are_looked_for_again_without_the_offsets_of_records(monkeypatch):
    """Beside the spring that was found, one record is moved by 3 mm and no other is."""
    host = block("mechanism", mass=1.0, damping=6.0, stiffness=100.0)
    spring = block("stiffness", quadratic=0.0, cubic=70.0)
    channels, t = (Channel("f", "N"), Channel("x", "mm")), 0.01 * np.arange(1000)
    true, given = [], []
    for k, offset in enumerate((0.0, 3.0, 0.0)):
        u = 30 * np.sin((2.0 + 0.3 * k) * t) + 30 * np.sin(7.3 * t)
        y = Model("plant", *channels, (host, spring)).simulate(u, 0.01)
        record = Record(f"{k}", 0.01, u, y, *channels, "measured", "fit")
        true.append(y)
        given.append(replace(record, y=y + offset))
    base = Model("made", *channels, (host,))
    seen, look = spring_found_once(host, spring, "y")
    monkeypatch.setattr(gap_search, "named_inside", look)
    about = {"declared": 1e-3, "quantities": Quantities("force", "position")}
    with pytest.raises(FarEnoughError):
        search("made", given, base, **about, vocabulary=among("stiffness-hardening"))
    np.testing.assert_allclose(seen[0][1] - true[1], 3.0)
    for found, y in zip(seen[1], true, strict=True):
        np.testing.assert_allclose(found, y, atol=1e-6)


@pytest.mark.parametrize("linear", [True, False])
def test_what_drives_a_free_mass_may_be_bent(linear, monkeypatch):
    """No curve over its place has a meaning in a window, but one before it has."""
    mass = block("mechanism", mass=1.0, damping=6.0, stiffness=0.0)
    u = 30 * np.sin(3.1 * 0.01 * np.arange(2000))
    channels = Channel("valve", "V"), Channel("x", "mm")
    record = Record("r", 0.01, u, mass.simulate(u, u, 0.01), *channels, "measured")
    base = IdentifiedModel("linear", *channels, (mass,), ("mechanism.mass",))
    seen = []

    def start_state(records, base, hold, declared, offered):
        seen.extend(offered)
        raise FarEnoughError

    monkeypatch.setattr(gap_search, "start_state", start_state)
    kinds = Quantities("voltage", "position") if linear else None
    with pytest.raises(FarEnoughError):
        search("made", windows(record, 0.2), base, quantities=kinds)
    assert ("asymmetry" in seen) == linear
    assert "dead-zone" in seen
    assert "sensor-nonlinearity" not in seen


def test_nothing_is_put_into_a_model_that_runs_away():
    """It tells no sizes that a law could start from."""
    away = Fitted(SimpleNamespace(added=(), freedom=0.0), np.inf)

    def offer(before):
        raise AssertionError("asked what may be put in")

    assert ForceSearch(offer, None).one_more([away], 1, 0.0) == []


def test_of_two_names_for_a_curve_behind_a_mass_the_sensor_is_tried():
    passed = Passed(1.0, 3.0, 0.01, 0.0)
    laws = {
        name: tuple(effects()[name].around(passed))
        for name in ("drive-saturation", "saturation", "sensor-nonlinearity")
    }
    assert {law.form for law in laws["saturation"]} == {"", "algebraic"}
    kept = of_one_name(laws)
    assert set(kept) == {"drive-saturation", "sensor-nonlinearity"}
    assert kept["drive-saturation"] == laws["drive-saturation"]
    alone = {"saturation": laws["saturation"]}
    assert of_one_name(alone) == alone


def test_where_one_record_shows_a_force_both_answers_are_judged_on_blocks(monkeypatch):
    """A path changes all records, and says nothing of where the force shows."""
    chain, state, start = (
        SimpleNamespace(sample=None, added=(), moved_charge=0.0, name=name)
        for name in ("chain", "state", "start")
    )
    asked = []

    def shows(before, after, score):
        asked.append((before.name, after.name))
        return True

    def gain(before, after, score, in_blocks):
        asked.append((before.name, after.name, in_blocks))
        return 100.0 * (after is state)

    plain = SimpleNamespace(plain=lambda *_: None)
    monkeypatch.setattr(named_inside_module, "Score", plain)
    monkeypatch.setattr(named_inside_module, "shows_in_one_record", shows)
    monkeypatch.setattr(named_inside_module, "gain_on_folds", gain)
    inside = Inside(None, start, Named(state), "")
    assert beats_chain(inside, Named(chain), Floor(1e-3, "declared"))
    assert asked == [
        ("start", "state"),
        ("chain", "state", True),
        ("chain", "chain", True),
    ]


@pytest.mark.parametrize(
    ("inside", "counts", "chain", "left", "better"),
    [
        ((1, 1), 0, (1, 16), 0.104, True),  # a few thousandths of the gap of 1 more
        ((1, 1), 0, (1, 16), 0.2, False),  # a tenth
        ((1, 1, 1), 0, (1, 16), 0.1, True),  # many numbers are those of two effects
        ((1, 1), 1, (1, 16), 0.1, True),  # and numbers of a host that nobody set free
        ((1, 1, 1), 1, (1, 16), 0.1, False),  # by more effects
        ((1, 1), 0, (1, 2), 0.1, False),  # of no fewer numbers
        ((1, 16), 0, (1, 16), 0.1, False),
        ((1, "path"), 0, (1, 16), 0.1, False),
    ],
)
def test_a_law_of_many_numbers_is_no_rival_of_few_that_leave_as_little(
    inside, counts, chain, left, better
):
    """The chain leaves a power of .1, of a gap of 1."""

    def effect(charge):
        path = charge == "path"
        about = ("drift", "winding path") if path else ("creep", "one element")
        many = not path and charge > 4
        return SimpleNamespace(effect=about[0], form=about[1], is_of_many_numbers=many)

    def state(charges, power):
        return SimpleNamespace(
            added=tuple(map(effect, charges)),
            power=lambda floor: power,
            gap=lambda floor: power,
            share=lambda other, floor, gap: (other.power(floor) - power) / gap,
        )

    before = SimpleNamespace(before=state((), 1.0))
    named = Named(state(chain, 0.1), (before,))
    there = Inside(None, None, Named(state(inside, left)), "", counts)
    assert named_inside_module._inside_is_simpler(there, named, 1e-6) == better

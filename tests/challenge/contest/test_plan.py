"""Seeds of the contest are never used twice, and its sets are stratified as told."""

import itertools
import re
from collections import Counter
from functools import cache

import pytest

from hystbench.challenge.contest.plan import (
    DEVELOPMENT_SEEDS,
    RETIRED_SEEDS,
    SETS,
    TRANSFER,
    chunks,
    numbers,
    plan,
    strata,
)
from hystbench.challenge.make import make
from hystbench.challenge.plant.effects import IN_ACTUATOR, IN_MACHINE, MACHINES
from hystbench.challenge.spec import (
    ACTUATORS,
    GROUPS,
    LEFT_OUT_GROUP,
    CaseSpec,
    effects_of,
)
from hystbench.errors import InputError
from tests.conftest import ROOT

#: Sets whose seeds serve a score alone.
PUBLISHED = ("published", "transfer", "mechanisms", "mechanisms-transfer", "left-out")


@cache
def planned(name, scale=1.0, group=LEFT_OUT_GROUP):
    """Cases of a set: the same each time that they are listed."""
    return plan(name, scale, group=group)


def seeds(name, scale=1.0):
    return [entry.spec.seed for entry in planned(name, scale)]


def test_no_seed_is_used_twice_in_a_contest_or_in_another():
    """Smaller contests are parts of this one."""
    every = [seed for name in SETS for seed in seeds(name, 4.0)]
    assert len(set(every)) == len(every)


def test_published_and_transfer_seeds_are_above_all_that_was_mended_on():
    for name in ("development", "small", "mechanisms-development"):
        assert set(seeds(name)) <= set(DEVELOPMENT_SEEDS)
    assert min(seeds("published", 4.0)) >= RETIRED_SEEDS.stop
    assert RETIRED_SEEDS.start > DEVELOPMENT_SEEDS.stop
    assert max(seeds("published", 4.0)) < min(seeds("transfer", 4.0))


def test_no_test_uses_a_seed_of_the_published_score():
    """Whatever a solver was mended on, it was not the cases that it is judged on."""
    kept = {seed for name in PUBLISHED for seed in seeds(name)}
    for file in (ROOT / "tests").rglob("*.py"):
        numbers = re.findall(r"\b\d{1,3}_?\d{3}_?\d{3}\b", file.read_text())
        used = {int(text.replace("_", "")) for text in numbers}
        assert not used & kept, file


def count(name, **wanted):
    return sum(
        all(getattr(entry.spec, key) == value for key, value in wanted.items())
        for entry in planned(name)
    )


def test_the_published_set_is_stratified_as_asked():
    for ratio, gpi, other in ((20.0, 200, 100), (10.0, 100, 50)):
        for family in set(ACTUATORS) - set(GROUPS[LEFT_OUT_GROUP].families):
            expected = gpi if family == "gpi" else other
            about = {"kind": "single", "ratio_db": ratio, "family": family}
            assert count("published", **about) == expected
    assert count("published", kind="none") == 200
    assert count("published", kind="pair") == 100
    assert count("published", kind="triple") == 50
    assert count("published", kind="unlisted") == 100
    assert len(planned("development")) == 400
    assert len(planned("small", group=1)) == 12


SETS_OF_ALL = [
    (name, stratum.family)
    for name in ("development", "published", "transfer")
    for stratum in strata(name)
    if (stratum.kind, stratum.ratio_db) == ("single", 20.0)
]


@pytest.mark.parametrize(("name", "family"), SETS_OF_ALL)
def test_single_effects_are_balanced(name, family):
    chosen = [
        entry.spec.effects[0]
        for entry in planned(name)
        if (entry.spec.kind, entry.spec.family, entry.spec.ratio_db)
        == ("single", family, 20.0)
    ]
    counts = Counter(chosen)
    # beside a foreign plant the shape is wrong in any case
    expected = {name for name, kind in IN_ACTUATOR.items() if kind.listed}
    expected -= set() if family == "gpi" else {"hysteresis-shape"}
    assert set(counts) == expected
    assert max(counts.values()) - min(counts.values()) <= 1


def test_the_transfer_set_is_shifted():
    transfer = [entry.spec for entry in planned("transfer")]
    assert {(spec.spread, spec.campaign) for spec in transfer} == {(3.0, "other")}
    # of machines there is one set of records, and shares do not shift
    inside = [entry.spec for entry in planned("mechanisms-transfer")]
    assert {(spec.spread, spec.campaign) for spec in inside} == {(1.0, "standard")}


def kinds_of(spec):
    known = IN_MACHINE if spec.family in MACHINES else IN_ACTUATOR
    return [known[name] for name in spec.effects]


def met(group, *names):
    """Families, unlisted effects and forms that sets may draw."""
    specs = [entry.spec for name in names for entry in planned(name, group=group)]
    families = {spec.family for spec in specs}
    unlisted = {x for s in specs if s.kind == "unlisted" for x in s.effects}
    forms = {
        f"{kind.name}: {form}"
        for spec in specs
        for kind in kinds_of(spec)
        for form in spec.forms(kind)
    }
    return families, unlisted, forms


@pytest.mark.parametrize("group", GROUPS)
def test_no_set_but_those_of_transfer_holds_the_group_that_is_left_out(group):
    out = GROUPS[group]
    families, unlisted, forms = met(group, *(set(SETS) - set(TRANSFER)))
    assert not families & set(out.families)
    assert not unlisted & set(out.unlisted)
    assert not forms & set(out.forms)
    families, unlisted, forms = met(group, *TRANSFER)
    assert set(out.families) <= families
    assert unlisted == set(out.unlisted)
    assert set(out.forms) <= forms


def test_every_group_comes_back_when_another_is_left_out():
    """What is left out now is drawn again, so that leaving out goes round."""
    for other in GROUPS:
        families, unlisted, forms = met(other, "published", "mechanisms")
        for back in (item for number, item in GROUPS.items() if number != other):
            assert set(back.families) <= families
            assert set(back.unlisted) <= unlisted
            assert set(back.forms) <= forms


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.parametrize(
    ("name", "known"), [("published", IN_ACTUATOR), ("mechanisms", IN_MACHINE)]
)
def test_every_listed_effect_is_hidden_whatever_is_left_out(group, name, known):
    hidden = {x for entry in planned(name, group=group) for x in entry.spec.effects}
    assert {x for x, kind in known.items() if kind.listed} <= hidden


def test_groups_share_nothing_and_their_names_are_known():
    every = [x for g in GROUPS.values() for x in (*g.families, *g.unlisted, *g.forms)]
    assert len(set(every)) == len(every)
    kinds = {**IN_ACTUATOR}, {**IN_MACHINE}
    forms = {f"{n}: {f}" for known in kinds for n, k in known.items() for f in k.forms}
    unlisted = {n for known in kinds for n, kind in known.items() if not kind.listed}
    for item in GROUPS.values():
        actuator, machine = item.families
        assert (actuator in ACTUATORS, machine in MACHINES) == (True, True)
        assert set(item.forms) <= forms
        # a name of both an actuator's and a machine's effects hides in both
        for known in kinds:
            for kind in known.values():
                assert item.allowed(kind, of_group=False) or not kind.listed
    # each kind of physics without a word is left out once
    assert sorted(x for g in GROUPS.values() for x in g.unlisted) == sorted(unlisted)


def test_a_group_that_there_is_not_is_refused():
    with pytest.raises(InputError, match="group: 9; expected 1 to 3"):
        plan("small", group=9)


@pytest.mark.parametrize(
    ("effect", "family", "form"),
    [
        ("creep", "gpi", "fractional"),
        ("friction", "impedance", "stribeck-presliding"),
        ("gravity", "pendulum", "tilted"),
    ],
)
def test_a_case_takes_the_form_that_is_left_out_in_the_transfer_set_alone(
    effect, family, form
):
    def taken(of_group, seed=1):
        about = {"group": 1, "of_group": of_group}
        spec = CaseSpec(seed, "single", (effect,), family, 20.0, **about)
        return make(spec).truth["effects"][0]["form"]

    assert taken(of_group=True) == form
    assert form not in {taken(False, seed) for seed in range(4)}


def test_unlisted_effects_are_hidden_in_machines_too():
    """At least four kinds, and each as often as any other in its family."""
    specs = [e.spec for e in planned("mechanisms") if e.spec.kind == "unlisted"]
    hidden = Counter(spec.effects[0] for spec in specs)
    development = {
        e.spec.effects[0]
        for e in planned("mechanisms-development")
        if e.spec.kind == "unlisted"
    }
    assert set(hidden) == development
    left_out = set(GROUPS[LEFT_OUT_GROUP].unlisted) & set(IN_MACHINE)
    assert len(set(hidden) | left_out) >= 4
    assert left_out
    for family in {spec.family for spec in specs}:
        counts = Counter(s.effects[0] for s in specs if s.family == family)
        assert set(counts) == set(effects_of("unlisted", family, LEFT_OUT_GROUP))
        assert max(counts.values()) - min(counts.values()) <= 1


def test_a_larger_contest_holds_the_smaller_one():
    assert set(seeds("published", 0.1)) < set(seeds("published"))


def test_a_name_tells_nothing_of_the_case():
    entries = planned("development")
    for entry in entries:
        assert re.fullmatch(r"case-[0-9a-f]{10}", entry.name)
    # in the order of the names the kinds are mixed
    kinds = [entry.spec.kind for entry in entries]
    changes = sum(a != b for a, b in itertools.pairwise(kinds))
    assert changes > 100


def test_chunks_hold_each_case_once():
    entries = planned("small", group=1)
    cut = chunks(entries, 5)
    assert list(cut) == numbers(len(entries), 5)
    assert [len(chunk) for chunk in cut.values()] == [5, 5, 2]
    assert tuple(e for chunk in cut.values() for e in chunk) == entries


def test_an_unknown_set_gets_the_nearest_name():
    with pytest.raises(InputError, match="did you mean 'published'"):
        plan("publishd")


def test_a_scale_beyond_the_seeds_is_refused():
    most = max(stratum.cases for stratum in strata("published"))
    with pytest.raises(InputError, match="scale: 26"):
        plan("published", 26.0)
    assert most * 25.0 <= 5000


def test_kinds_that_are_left_out_and_the_rest_make_the_whole_set():
    left_out = ["gravity", "tank"]
    every = {entry.name for entry in planned("mechanisms")}
    without = {entry.name for entry in plan("mechanisms", without=left_out)}
    only = {entry.name for entry in plan("mechanisms", only=left_out)}
    assert without | only == every
    assert not without & only
    specs = [entry.spec for entry in plan("mechanisms", without=left_out)]
    assert not any({spec.family, *spec.effects} & set(left_out) for spec in specs)


def test_a_kind_that_is_left_out_must_be_known_and_leave_some():
    with pytest.raises(InputError, match=r"without: 'fricton'.*friction"):
        plan("mechanisms", without=["fricton"])
    with pytest.raises(InputError, match="no case of the set 'small' is left"):
        plan("small", only=["tank"])


@pytest.mark.parametrize("family", sorted({x.family for x in strata("mechanisms")}))
def test_effects_of_machines_are_balanced(family):
    chosen = [
        entry.spec.effects[0]
        for entry in planned("mechanisms")
        if (entry.spec.kind, entry.spec.family) == ("single", family)
    ]
    counts = Counter(chosen)
    assert set(counts) == set(effects_of("single", family))
    assert max(counts.values()) - min(counts.values()) <= 1

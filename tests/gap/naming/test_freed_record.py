"""A loop identified from a record in which an effect shows as well."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from hystbench.gap import identify_again
from hystbench.gap import search as module
from hystbench.gap.asked import Asked
from hystbench.gap.bases.gpi import is_another
from hystbench.gap.bases.load import load_base
from hystbench.gap.gap_search import GapSearch
from hystbench.gap.naming import freed_record
from hystbench.gap.naming.freed_record import freed_of_laws, freed_of_slow_law
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.searched import among
from tests.gap.small import hysteresis

DT, TAU_S, HEAT_UM, NOISE = 0.02, 5.0, 0.04, 0.05
FLOOR = Floor(NOISE, "declared")
LAWS = among("thermal-drift", "drift", "creep", "calibration-error", "sensor-lag")


def warmed(u):
    """What a body does that a current heats: exact over each sample."""
    warm, path = 0.0, []
    for value in u.tolist():
        path.append(warm)
        warm += (value**2 - warm) * -np.expm1(-DT / TAU_S)
    return HEAT_UM * np.array(path)


LONG, SHORT = (0.5, 80.0), (0.05, 2.5)
"""Least and largest time constant of a creep, in s, in a record of 80 s."""


def crept(z, ends):
    """What creep adds: 30 % by six lags, a ramp in each sample."""
    slow = np.zeros(6)
    times = np.geomspace(*ends, 6)
    fades, path, last = np.exp(-DT / times), [], 0.0
    for value in z.tolist():
        slow = fades * slow + (1 - fades) * (last + value) / 2
        last = value
        path.append(0.3 * slow.mean())
    return np.array(path)


def stack(ends=LONG):
    """A loop of growing size that creeps, steps with holds, and a quick motion."""
    random, t = np.random.default_rng(6), DT * np.arange(4000)
    grows = np.interp(t, [0, 80], [1.0, 9.0])
    held = np.repeat(random.uniform(-7, 7, 10), 400)
    quick = 5.0 * np.sin(2 * np.pi * 0.9 * t) + 2.0 * np.sin(2 * np.pi * 2.3 * t)
    inputs = {"slow": grows * np.sin(2 * np.pi * 0.05 * t)}
    inputs |= {"held": held * np.interp(t, [0, 4], [0.0, 1.0]), "quick": quick}
    loop = Model("loop", CURRENT, DISPLACEMENT, (hysteresis(),))
    records = []
    for name, u in inputs.items():
        z = loop.simulate(u, DT)
        y = z + crept(z, ends) + NOISE * random.standard_normal(len(u))
        records.append(record(u, y, name=name, dt=DT))
    return Evidence("stack", tuple(records), (), "linear", NOISE, "slow"), loop


@cache
def crept_loop(ends=LONG):
    """The records of a stack, its loop, and the one that is identified from them."""
    evidence, loop = stack(ends)
    return evidence, loop, load_base("gpi", evidence)[0]


def rod(heats):
    """A slow loop of falling size, and bursts with rest between them."""
    random, t = np.random.default_rng(5), DT * np.arange(2000)
    falling = 8.0 * np.interp(t, [0, 20, 40], [1.0, 1.0, 0.3])
    inputs = {"slow": falling * np.sin(2 * np.pi * 0.2 * t)}
    for name, start in (("a", 5.0), ("b", 12.0)):
        on = (t > start) & (t < start + 15.0)
        inputs[name] = 7.0 * on * np.sin(2 * np.pi * 1.5 * t)
    loop = Model("loop", CURRENT, DISPLACEMENT, (hysteresis(),))
    records = []
    for name, u in inputs.items():
        y = loop.simulate(u, DT) + heats * warmed(u)
        y += NOISE * random.standard_normal(len(u))
        records.append(record(u, y, name=name, dt=DT))
    return Evidence("rod", tuple(records), (), "linear", NOISE, "slow")


def beside(evidence, base):
    return GapSearch(evidence, Asked(vocabulary=LAWS), None).beside(base)


@pytest.fixture(scope="module")
def heated():
    evidence = rod(1.0)
    return evidence, load_base("gpi", evidence)[0]


@pytest.fixture(scope="module")
def cold():
    evidence = rod(0.0)
    return evidence, load_base("gpi", evidence)[0]


@pytest.fixture(scope="module")
def beside_the_loop(heated):
    """What is named before the loop is identified again."""
    return beside(*heated)


@pytest.fixture(scope="module")
def searched(heated):
    """What a search decides, and the bases that it asks about for their numbers."""
    evidence, base = heated
    re_tuned, asked = module.roughly_known, []

    def spied(base, records):
        asked.append(base)
        return re_tuned(base, records)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "roughly_known", spied)
        return module.search_and_judge(evidence, base, Asked(vocabulary=LAWS)), asked


def told(found):
    content = found.content
    return [item["name"] for item in content["effects"]], content["reason"]


def named(evidence, base):
    return told(module.search_and_judge(evidence, base, Asked(vocabulary=LAWS)))


def test_heat_that_the_loop_had_taken_for_its_own_is_named(
    heated, searched, monkeypatch
):
    evidence, base = heated
    effects, reason = told(searched[0])
    assert effects == ["thermal-drift"]
    assert "identified again, from record slow without what the effects do" in reason
    monkeypatch.setattr(identify_again, "freed_of_laws", lambda *_: None)
    monkeypatch.setattr(identify_again, "freed_of_slow_law", lambda *_: None)
    effects, reason = named(evidence, base)
    assert effects == ["drift"]
    assert "identified again" not in reason


def test_the_base_that_is_re_tuned_is_the_one_that_was_identified_again(
    heated, searched
):
    _, base = heated
    found, asked = searched
    assert asked == [found.base]
    assert is_another(base, found.base)
    assert not is_another(base, base)
    assert not is_another(Model("given", CURRENT, DISPLACEMENT, base.chain), found.base)


def test_a_law_that_does_less_than_noise_to_the_record_leaves_it(
    heated, beside_the_loop
):
    evidence, base = heated
    found = beside_the_loop
    about = base, found.named, evidence
    assert freed_of_laws(*about, found.floor) is not None
    assert freed_of_laws(*about, Floor(100.0 * found.floor.rms, "declared")) is None


def test_a_record_of_the_loop_alone_is_left_as_it_is(cold):
    evidence, base = cold
    found = beside(evidence, base)
    about = found.named, evidence, found.floor
    assert freed_of_laws(base, *about) is None


def test_a_base_that_was_given_is_not_identified(heated):
    evidence, base = heated
    given = Model(base.name, base.input, base.output, base.chain)
    found = beside(evidence, given)
    assert freed_of_laws(base, found.named, evidence, found.floor) is not None
    assert freed_of_laws(given, found.named, evidence, found.floor) is None


@pytest.fixture
def one_range(monkeypatch):
    """Try creep and heat in one range of time constants, as each is tried alike."""
    monkeypatch.setattr(freed_record, "CREEPS", freed_record.CREEPS[:1])
    monkeypatch.setattr(freed_record, "HEATS", freed_record.HEATS[-1:])


@pytest.mark.usefixtures("one_range")
def test_creep_that_hides_all_laws_is_named(monkeypatch):
    evidence, _, base = crept_loop()
    monkeypatch.setattr(identify_again, "freed_of_laws", lambda *_: None)
    effects, reason = named(evidence, base)
    assert effects == ["creep"]
    assert "identified again, from record slow without what the effects do" in reason
    monkeypatch.setattr(identify_again, "freed_of_slow_law", lambda *_: None)
    assert named(evidence, base)[0] != ["creep"]


@pytest.mark.parametrize("ends", [LONG, SHORT])
def test_a_record_is_freed_of_its_creep(ends):
    evidence, loop, base = crept_loop(ends)
    freed = freed_of_slow_law(base, evidence, FLOOR, ("creep",))
    slow = evidence.to_identify_from
    without = loop.simulate(slow.u, DT)
    left = np.std(freed.to_identify_from.y - without)
    assert left < 0.4 * np.std(slow.y - without)
    assert [x.name for x in freed.fit] == [x.name for x in evidence.fit]
    assert freed.fit[1:] == evidence.fit[1:]


@pytest.mark.usefixtures("one_range")
def test_samples_that_were_not_measured_hide_no_creep():
    """Straight lines in their place are far from what any loop does."""
    evidence, loop, base = crept_loop()
    *others, quick = evidence.fit
    lost = (np.arange(len(quick)) // 100) % 3 == 1
    y = np.where(lost, quick.y[0], quick.y)
    quick = replace(quick, y=y, interpolated=lost)
    freed = freed_of_slow_law(
        base, replace(evidence, fit=(*others, quick)), FLOOR, LAWS.offered
    )
    assert freed is not None
    slow = evidence.to_identify_from
    without = loop.simulate(slow.u, DT)
    left = np.std(freed.to_identify_from.y - without)
    assert left < 0.4 * np.std(slow.y - without)


def test_a_law_that_acts_where_nothing_was_measured_leaves_the_record(
    heated, beside_the_loop
):
    evidence, base = heated
    found = beside_the_loop
    slow, *others = evidence.fit
    lost = np.ones(len(slow), dtype=bool)
    lost[:2] = False  # a body takes seconds to get warm
    fit = (replace(slow, interpolated=lost), *others)
    assert freed_of_laws(base, found.named, evidence, found.floor) is not None
    missing = replace(evidence, fit=fit, identification="slow")
    assert freed_of_laws(base, found.named, missing, found.floor) is None


@pytest.mark.usefixtures("one_range")
def test_a_loop_that_fits_its_record_is_freed_of_nothing(cold):
    evidence, base = cold
    assert freed_of_slow_law(base, evidence, FLOOR, LAWS.offered) is None
    creeping, _, base = crept_loop()
    given = Model(base.name, base.input, base.output, base.chain)
    assert freed_of_slow_law(given, creeping, FLOOR, LAWS.offered) is None
    assert (
        freed_of_slow_law(base, creeping, Floor(10.0, "declared"), LAWS.offered) is None
    )
    assert freed_of_slow_law(base, creeping, FLOOR, ("drift",)) is None


@pytest.mark.usefixtures("one_range")
def test_heat_that_hides_all_laws_is_named(heated, monkeypatch):
    evidence, base = heated
    monkeypatch.setattr(identify_again, "freed_of_laws", lambda *_: None)
    assert named(evidence, base)[0] == ["thermal-drift"]

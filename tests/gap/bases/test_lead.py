"""Records that begin in the middle of a motion."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.gap.bases.lead import lead_warnings, without_leads
from hystbench.gap.bases.linear import IdentifiedModel
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.ladder import FitResult
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.scored_samples import ScoredSamples
from hystbench.gap.run import hold_out_begun_like_fit
from hystbench.model import Model
from hystbench.quantities import NONE_KNOWN, Quantities
from hystbench.record import Channel, Record
from tests.gap.small import block

DT = 0.01
CHANNELS = Channel("force", "N"), Channel("position", "mm")
LAG = TransferFunction(numerator=(1.0,), denominator=(0.3, 1.0))
FREE = ("transfer-function.numerator",)


def record(start, use="fit", count=2000):
    """A lag of .3 s that has run from zero until the record starts."""
    u = np.sin(1.7 * DT * np.arange(start + count)) + 1.0
    u[0] = 0.0
    y = LAG.simulate(u, u, DT) if start == 0 else LAG.simulate(u, u, DT)[start:]
    noise = 0.001 * np.random.default_rng(start).standard_normal(count)
    return Record("r", DT, u[start:], y + noise, *CHANNELS, "measured", use)


def linear(free=FREE):
    return IdentifiedModel("linear", *CHANNELS, (LAG,), free)


def fitted_to(*records, hold="band-limited", quantities=NONE_KNOWN):
    return Evidence("device", records, (), hold, quantities=quantities)


def leads(base, *records, quantities=NONE_KNOWN):
    about = fitted_to(*records, quantities=quantities)
    return [item.lead for item in without_leads(records, base, about)]


def test_of_a_record_that_was_cut_out_of_a_longer_one_the_first_tenth_is_left_out():
    assert leads(linear(), record(537), record(537, "hold-out")) == [200, 200]


def test_each_record_is_looked_at_by_itself():
    early = record(0)
    quiet = replace(early, y=np.where(np.arange(2000) < 200, early.y, early.y + 0.01))
    assert leads(linear(), quiet, record(537)) == [0, 200]


def test_what_no_state_at_the_start_would_do_is_scored():
    first = record(0)
    hum = np.where(np.arange(2000) < 200, np.sin(9 * DT * np.arange(2000)), 0.0)
    assert leads(linear(), replace(first, y=first.y + hum)) == [0]


def test_the_base_of_what_may_be_a_store_has_to_forget_a_state_within_a_tenth():
    short = record(537, count=1000)
    assert leads(linear(), short) == [0]
    moves = Quantities("force", "position")
    (lead,) = leads(linear(), short, quantities=moves)
    assert lead * DT == pytest.approx(0.3 * np.log(100), abs=3 * DT)


def test_beside_what_was_found_a_lead_is_as_long_as_a_state_lasts():
    """A hundredth is left of a lag after 4.6 of its time constants."""

    def lead(count):
        given = (record(537, count=count),)
        about = linear(), fitted_to(*given)
        return without_leads(given, *about, found=linear())[0].lead

    assert lead(1000) * DT == pytest.approx(0.3 * np.log(100), abs=3 * DT)
    assert lead(260) == 0  # half of the record at most


def test_a_base_that_was_given_starts_as_it_says():
    assert leads(linear(free=()), record(537)) == [0]


STORE = Quantities("power", "temperature")


def test_a_store_has_a_level_to_start_from():
    assert leads(linear(), record(537), quantities=STORE) == [0]


def test_one_level_is_no_start_of_records_that_begin_at_several():
    several = record(537), record(850)
    assert leads(linear(), *several, quantities=STORE) == [200, 200]
    assert leads(linear(), record(537), record(537), quantities=STORE) == [0, 0]
    held_out = (record(537, "hold-out"),)
    both, one = (fitted_to(*x, quantities=STORE) for x in (several, several[:1]))
    (found,) = without_leads(held_out, linear(), both)
    assert found.lead == 200
    assert without_leads(held_out, linear(), one) is held_out


def test_a_window_of_a_free_mass_knows_its_start_otherwise():
    assert leads(linear(), replace(record(537), decay_s=1.0)) == [0]


HEAVY = Mechanism(mass=1.0, damping=6.0, stiffness=100.0)


def sprung(cubic):
    """A mass whose spring may harden."""
    forces = (block("stiffness", quadratic=0.0, cubic=cubic),) if cubic else ()
    return IdentifiedModel("linear", *CHANNELS, (HEAVY, *forces), ("mechanism.mass",))


def middle_of_a_motion():
    """It hardens by as much as a tenth of its linear spring."""
    w = DT * np.arange(3000)
    u = 30 * np.sin(2.0 * w) + 30 * np.sin(7.3 * w + 0.5)
    y = sprung(70.0).simulate(u, DT)[530:]
    noise = 0.001 * np.random.default_rng(4).standard_normal(2470)
    return Record("r", DT, u[530:], y + noise, *CHANNELS, "measured", "fit")


def test_a_base_that_is_far_off_hides_a_start_which_forces_show():
    given = (middle_of_a_motion(),)
    base, right = sprung(0.0), sprung(70.0)
    about = base, fitted_to(*given, hold="zero-order")
    assert without_leads(given, *about) is given
    (found,) = without_leads(given, *about, found=right)
    assert found.lead == 247


def test_the_speed_of_a_free_mass_is_forgotten_though_its_place_is_not():
    free = Mechanism(mass=0.3, damping=1.0, stiffness=0.0, output="velocity")
    slow = TransferFunction(numerator=(1.0, 9.0), denominator=(1.0, 9.0, 0.01))
    base = IdentifiedModel("linear", *CHANNELS, (slow,), FREE)
    found = Model("found", *CHANNELS, (free,))
    given = (record(537),)  # whose lag the free mass has
    about = base, fitted_to(*given)
    assert without_leads(given, *about) is given
    (shorter,) = without_leads(given, *about, found=found)
    assert shorter.lead == 200


def test_what_has_no_lead_already_is_looked_at_no_more():
    given = (replace(middle_of_a_motion(), lead=10),)
    base, right = sprung(0.0), sprung(70.0)
    about = base, fitted_to(*given, hold="zero-order")
    assert without_leads(given, *about, found=right) is given


def test_what_is_not_scored_is_told():
    short = replace(record(537), name="cut", lead=200)
    assert lead_warnings((record(0), short, replace(short, name="late", lead=7))) == [
        "not scored is the beginning of records that start in the middle of a motion: "
        "cut (2 s) and late (0.07 s)"
    ]
    assert lead_warnings((record(0),)) == []


def test_scores_leave_a_lead_out():
    given = (record(537),)
    (found,) = without_leads(given, linear(), fitted_to(*given))
    assert found.counted.sum() == pytest.approx(1800)


def test_forces_in_a_free_mass_leave_leads_of_both_uses_out_alike():
    """What stands for the base forgets its speed in a second, and never its place."""
    fit = record(537)
    held = replace(record(537, "hold-out"), y=fit.y)
    free = Mechanism(mass=0.3, damping=1.0, stiffness=0.0, output="velocity")
    found = FitResult(
        IdentifiedModel("linear", *CHANNELS, (free,), ("mechanism.mass",)),
        ModelState((free,), (fit,), ScoredSamples.of((fit,))),
        Floor(0.001, "declared"),
        None,
        (),
    )
    evidence = hold_out_begun_like_fit(
        Evidence("device", (fit,), (held,)), linear(), found
    )
    assert evidence.hold_out[0].lead == 200


def test_the_weight_of_a_pendulum_is_part_of_what_a_state_does():
    """It alone makes it swing: without it the mass would creep back."""
    weight = block("gravity", amplitude=30.0)
    loose = Mechanism(mass=1.0, damping=2.0, stiffness=1.0)
    found = Model("found", *CHANNELS, (loose, weight))
    u = 9 * np.sin(2.0 * DT * np.arange(2500)) + 3 * np.sin(7.3 * DT * np.arange(2500))
    y = found.simulate(u, DT)[537:]
    noise = 0.001 * np.random.default_rng(4).standard_normal(len(y))
    given = (Record("r", DT, u[537:], y + noise, *CHANNELS, "measured", "fit"),)
    (shorter,) = without_leads(given, linear(), fitted_to(*given), found=found)
    assert 300 < shorter.lead < 600


def test_a_store_that_is_found_forgets_the_level_it_begins_with():
    """Of several records with levels of their own; of one, the level is a number."""
    store = block("store", gain=1.0, rate=3.0)
    found = Model("found", *CHANNELS, (store,))
    rng = np.random.default_rng(3)
    u = 2.0 + np.repeat(rng.uniform(-1, 1, 30), 100)
    y = found.simulate(u, DT)
    several = tuple(
        Record(f"{k}", DT, u[k:], y[k:], *CHANNELS, "measured", "fit") for k in (0, 930)
    )
    slow = TransferFunction(numerator=(1.0,), denominator=(500.0, 1.0))
    base = IdentifiedModel("linear", *CHANNELS, (slow,), FREE)
    alone = several[1:]
    both, one = (
        fitted_to(*x, hold="zero-order", quantities=STORE) for x in (several, alone)
    )
    found_both = without_leads(several, base, both, found=found)
    assert [x.lead for x in found_both] == [0, 207]
    assert without_leads(alone, base, one, found=found) is alone


def test_a_lone_hold_out_record_is_asked_by_how_the_fit_records_begin():
    store = block("store", gain=1.0, rate=3.0)
    u = 2.0 + np.repeat(np.random.default_rng(3).uniform(-1, 1, 30), 100)
    y = Model("found", *CHANNELS, (store,)).simulate(u, DT)
    fit = tuple(
        Record(f"{k}", DT, u[k:], y[k:], *CHANNELS, "measured", "fit") for k in (0, 930)
    )
    held = replace(fit[1], use="hold-out")
    slow = TransferFunction(numerator=(1.0,), denominator=(500.0, 1.0))
    base = IdentifiedModel("linear", *CHANNELS, (slow,), FREE)
    state = ModelState((store,), fit, ScoredSamples.of(fit))
    found = FitResult(base, state, Floor(0.001, "declared"), None, ())
    evidence = Evidence("tank", fit, (held,), "zero-order", quantities=STORE)
    assert hold_out_begun_like_fit(evidence, base, found).hold_out[0].lead > 0

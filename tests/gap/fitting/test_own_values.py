"""What records have of their own: a late trigger, another range, another zero."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lfilter

from hystbench.gap.asked import Asked
from hystbench.gap.cache import Remembered, remembering
from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect, without
from hystbench.gap.fitting.own_values import (
    NONE,
    Own,
    OwnValues,
    own_values,
    values_of_record,
)
from hystbench.gap.naming.with_own_values import SHARED
from hystbench.gap.progress import silent
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.schema import RECORD_VALUES
from hystbench.gap.stages import decide_in, show_in
from hystbench.model import Model
from hystbench.schema import check_against_schema
from tests.gap.closing import close_gap
from tests.gap.made import CURRENT, DISPLACEMENT, record, write_folder
from tests.gap.searched import among, search
from tests.gap.small import block, state_of

DT, COUNT, NOISE = 1e-3, 800, 0.02
GAIN, LAG_S = 12.0, 0.007
LIKELY = among(
    *("sensor-lag", "drive-lag", "creep", "drift", "input-delay"),
    *("calibration-error", "asymmetry", "resonance"),
)
"""What values of each record's own may be taken for."""


def tones(time, seed):
    """Four sines that start and end at rest; before and behind there is nothing."""
    rng = np.random.default_rng(seed)
    lines = zip(rng.uniform(3, 40, 4), rng.uniform(0, 6, 4), strict=True)
    inside = np.clip(time / 0.05, 0, 1) * np.clip(
        (DT * COUNT - 0.1 - time) / 0.05, 0, 1
    )
    return sum(0.3 * np.sin(2 * np.pi * f * time + p) for f, p in lines) * inside


def made(owns, lag_s=0.0, first=0):
    """Records by formula: what the device gives at a time is known between samples."""
    rng = np.random.default_rng(first)
    time, found = np.arange(COUNT) * DT, []
    for k, own in enumerate(owns):
        late, gain, offset = own
        fine = np.arange(40 * COUNT) * DT / 40
        x = GAIN * tones(fine - late, first + k)
        if lag_s:  # the lag's own formula, forty times as fine
            decay = np.exp(-DT / 40 / lag_s)
            x = lfilter([1 - decay], [1, -decay], x)
        y = gain * x[::40] + offset + NOISE * rng.standard_normal(COUNT)
        found.append(record(tones(time, first + k), y, name=f"r{k}", dt=DT))
    return tuple(found)


DELAYS = [(0.001, 1, 0), (0.004, 1, 0), (0.0023, 1, 0), (0, 1, 0), (-0.0031, 1, 0)]
SWITCHED = [(0, 1, 0)] * 3 + [(0, 2, 0)] + [(0, 1, 0)]
MOVED = [(0, 1, 0.3), (0, 1, -0.2), (0, 1, 0.1), (0, 1, 0), (0, 1, -0.5)]


def found_in(owns, floor=NOISE**2):
    records = made(owns)
    return own_values(records, [GAIN * item.u for item in records], floor)


@pytest.mark.parametrize(
    ("owns", "kind"), [(DELAYS, "delay"), (SWITCHED, "gain"), (MOVED, "offset")]
)
def test_each_kind_is_found_with_its_values_and_no_other(owns, kind):
    found = found_in(owns)
    assert found.kinds == (kind,)
    told = dict(found.records)
    for k, true in enumerate(owns):
        # What is as the simulator has it is not told.
        assert (f"r{k}" in told) == (true != (0, 1, 0))
        if f"r{k}" in told:
            near = pytest.approx(true, abs=5e-3)
            assert tuple(told[f"r{k}"]) == near
            assert told[f"r{k}"].delay_s == pytest.approx(true[0], abs=2e-5)


@pytest.mark.parametrize("shared", [(0.003, 1, 0), (0, 1.1, 0), (0, 1, 0.4), (0, 1, 0)])
def test_what_all_records_share_is_no_records_own(shared):
    """It is left to the effects: a delay, a gain or an offset of the device."""
    assert found_in([shared] * 5) == NONE


def test_a_record_differs_from_what_the_others_share():
    ((name, own),) = found_in([(0.003, 1, 0)] * 4 + [(0.003, 2, 0)]).records
    assert name == "r4"
    assert tuple(own) == pytest.approx((0, 2, 0), abs=5e-3)


def test_one_record_has_nothing_of_its_own():
    assert found_in([(0.003, 1.2, 0.4)]) == NONE


@settings(max_examples=25, deadline=None)
@given(st.floats(-0.02, 0.02), st.floats(0.2, 5), st.floats(-3, 3), st.integers(0, 99))
def test_what_is_taken_off_leaves_what_the_simulator_gives(late, gain, offset, seed):
    (item,) = made([(late, gain, offset)], first=seed)
    own = Own(late, gain, offset)
    values = OwnValues(("delay", "gain", "offset"), (("r0", own),))
    (bare,) = values.taken_off([item], "band-limited")
    rest = bare.y - GAIN * bare.u
    assert np.sqrt(np.mean(rest**2)) < 1.5 * NOISE / gain + 0.01
    assert values.taken_off([replace(item, name="other")], "linear")[0].y is not bare.y
    again = OwnValues.of_mapping(values.mapping("um"))
    assert again == values


def test_a_part_of_a_record_tells_its_own():
    (item,) = made([(0.002, 1.5, 0.3)])
    own = values_of_record(item, GAIN * item.u, ("delay", "gain", "offset"), 300)
    assert tuple(own) == pytest.approx((0.002, 1.5, 0.3), abs=0.02)


def rig():
    return Model("rig", CURRENT, DISPLACEMENT, (block("gain", value=GAIN),))


def values_of(content):
    values = content["record_values"]
    check_against_schema(values, RECORD_VALUES, "record_values")
    assert values["kinds"] == ["delay"]
    for item in values["records"]:
        true = DELAYS[int(item["name"][1:])][0]
        assert item["delay_s"] == pytest.approx(true, abs=2e-4)
        assert item["name"] in values["sentence"]
    return values


@pytest.mark.parametrize("lag", [0.003, 0.008])
def test_laws_of_more_numbers_do_not_tell_two_lags_apart(lag):
    """Behind a plain gain a lag of the drive and one of the sensor are the same."""
    given = made([(0, 1, 0)] * 5, lag)
    (effect,) = search("made", given, rig(), declared=NOISE, vocabulary=LIKELY).content[
        "effects"
    ]
    lags = {effect["name"], *effect["cannot_be_told_from"]}
    assert lags >= {"sensor-lag", "drive-lag"}
    assert effect["confidence"] < 0.6


def test_an_effect_is_named_beside_late_triggers():
    content = search(
        "made", made(DELAYS, LAG_S), rig(), declared=NOISE, vocabulary=LIKELY
    ).content
    assert content["verdict"] == "named"
    (effect,) = content["effects"]
    # Behind a plain gain the lags are one and the same.
    assert effect["name"] in ("sensor-lag", "drive-lag", "creep")
    (value,) = effect["parameters"].values()
    assert value["value"] == pytest.approx(LAG_S, rel=0.05)
    assert 0 < values_of(content)["share_of_gap_power"] < 1


def test_zeros_of_each_record_are_no_drift_beside_an_effect():
    """A path follows them, but offsets alone explain less than path and lag do."""
    owns = [(0, 1, zero) for zero in (3, -2, 1, 0, -4)]
    content = search(
        "made", made(owns, LAG_S), rig(), declared=NOISE, vocabulary=LIKELY
    ).content
    (effect,) = content["effects"]
    assert effect["name"] in ("sensor-lag", "drive-lag", "creep")
    assert content["record_values"]["kinds"] == ["offset"]


def test_what_was_found_with_zeros_of_each_record_is_looked_up(tmp_path):
    """Constants beside the laws are no form of an effect, and are kept all the same."""
    owns = [(0, 1, zero) for zero in (3, -2, 1, 0, -4)]
    found = []
    for _ in range(2):
        with remembering(Remembered(tmp_path, silent)):
            found.append(
                search(
                    "made", made(owns, LAG_S), rig(), declared=NOISE, vocabulary=LIKELY
                )
            )
    first, again = (item.content["effects"] for item in found)
    assert [item["name"] for item in first] == [item["name"] for item in again]


def test_zeros_are_found_together_with_a_creep_that_looks_like_them():
    """Loads that are put on and partly taken off: slow creep is nearly an offset."""
    rng, time, found = np.random.default_rng(3), np.arange(COUNT) * DT, []
    loads = [(1, 2), (2, -1), (-1, 0), (3, 3), (-2, -3)]
    for k, (load, zero) in enumerate(loads):
        on, off = (np.clip((time - at) / 0.02, 0, 1) for at in (0.1, 0.4))
        u = load * (on - 0.7 * off)
        slow = lfilter([1 - np.exp(-DT / 0.3)], [1, -np.exp(-DT / 0.3)], u)
        y = GAIN * (u + 0.2 * slow) + zero + NOISE * rng.standard_normal(COUNT)
        found.append(record(u, y, name=f"r{k}", dt=DT))
    content = search(
        "made", tuple(found), rig(), declared=NOISE, vocabulary=LIKELY
    ).content
    (effect,) = content["effects"]
    assert effect["name"] == "creep"
    assert content["record_values"]["kinds"] == ["offset"]


def test_late_triggers_alone_are_no_gap_and_hold_out_records_have_theirs(tmp_path):
    held = made([(0.0027, 1, 0), (0, 1, 0)], first=20)
    held = [replace(item, name=f"h{item.name}", use="hold-out") for item in held]
    data = write_folder(tmp_path / "rig", [*made(DELAYS), *held], noise_rms=NOISE)
    evidence = load_evidence(data)
    one, two = tmp_path / "one", tmp_path / "two"
    closed = close_gap(evidence, rig(), one, report=False, vocabulary=LIKELY)
    content = closed.outcome.content
    assert (content["verdict"], content["effects"]) == ("no-gap", [])
    assert values_of(content)["share_of_gap_power"] == pytest.approx(1, abs=0.01)
    # As recorded it is 1 um and more; a base that is exact is told as exact.
    raw = held[0].y - GAIN * held[0].u
    assert np.sqrt(np.mean(raw**2)) > 1.0
    assert content["gap"]["before"] == pytest.approx(NOISE, rel=0.2)
    # The jobs do the same: what was decided is read back.
    decide_in(two, load_evidence(data, "fit"), rig(), Asked(vocabulary=LIKELY))
    show_in(two, evidence, rig())
    for file in ("gap.json", "model.yaml", "holdout/hr0.csv"):
        assert (one / file).read_bytes() == (two / file).read_bytes()


def test_another_range_of_a_record_is_a_gap_without_a_name():
    """What doubles a response in one record is in no record."""
    content = search(
        "made", made(SWITCHED), rig(), declared=NOISE, vocabulary=LIKELY
    ).content
    assert (content["verdict"], content["effects"]) == ("unnamed", [])
    assert content["reason"].startswith("a gain of some records' own takes 100 %")
    (item,) = content["record_values"]["records"]
    assert (item["name"], item["gain"]) == ("r3", pytest.approx(2, rel=0.01))


def test_a_delay_that_all_share_hides_those_of_each():
    """With it, some records would be early; without, each is as late as it is."""
    start = state_of((block("gain", value=GAIN),), made(NOTHING))
    both = start
    for name, values in (
        ("drive-lag", {"time_constant_s": 0.01}),
        ("input-delay", LATE),
    ):
        variant = next(effects()[name].variants(both.simulation))
        both = with_effect(both, variant, values)
    left = without(both, SHARED)
    assert [item.effect for item in left.added] == ["drive-lag"]
    assert without(start, SHARED) is start


LATE = {"delay_s": 0.002}
NOTHING = [(0, 1, 0)] * 3

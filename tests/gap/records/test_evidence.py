"""What the gap workflow reads, and what it refuses."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from hystbench.blocks.gain import Gain
from hystbench.gap.records.evidence import check_units, load_evidence
from hystbench.model import Model
from hystbench.record import Channel
from tests.gap.made import play, record, sine, write_folder
from tests.messages import message

U = sine(2.0, count=1000)
Y = 5 * U + 0.3 * sine(7.0, count=1000)


def pair(y=Y, u=U, **about):
    """A fit record with a given output, and a sound one held out."""
    return [
        record(u, y, name="a", **about),
        record(0.8 * U, 0.8 * Y, name="b", use="hold-out"),
    ]


def test_roles_hold_and_noise_come_from_the_file(tmp_path):
    folder = write_folder(
        tmp_path / "d",
        pair(),
        input={"column": "current_A", "unit": "A", "hold": "zero-order"},
        noise_rms=0.01,
    )
    found = load_evidence(folder)
    assert [item.name for item in found.fit] == ["a"]
    assert [item.name for item in found.hold_out] == ["b"]
    assert (found.input_hold, found.noise_rms) == ("zero-order", 0.01)
    assert (found.input, found.output) == (
        Channel("current", "A"),
        Channel("displacement", "um"),
    )
    np.testing.assert_array_equal(found.fit[0].y, Y)


def test_without_records_held_out_nothing_can_be_shown(tmp_path):
    folder = write_folder(tmp_path / "d", pair()[:1])
    assert "none has 'use: hold-out'; expected at least one" in message(
        lambda: load_evidence(folder)
    )


@pytest.mark.parametrize(("low", "high"), [(-4.0, 3.0), (-3.0, 9.0)])
def test_a_clipped_output_is_named_with_its_row(tmp_path, low, high):
    y = np.clip(Y, low, high)
    said = message(lambda: load_evidence(write_folder(tmp_path / "d", pair(y))))
    assert "a.csv: row" in said
    assert "not clipped" in said
    row = int(said.split("row ")[1].split(":")[0])
    # Row 1 is the header: sample k stands in row k + 2, and there it does clip.
    assert y[row - 2] in (low, high)


@pytest.mark.parametrize(("low", "high"), [(-9.0, 3.6), (-3.6, 3.6)])
def test_an_output_that_is_clipped_in_every_period_is_named(tmp_path, low, high):
    """No single stretch is long, all of them together are."""
    u = np.sin(2 * np.pi * np.arange(1000) / 40)
    y = 4 * u
    assert y.max() > high
    said = message(
        lambda: load_evidence(
            write_folder(tmp_path / "d", pair(np.clip(y, low, high), u))
        )
    )
    assert "not clipped" in said


def test_a_stuck_output_is_named(tmp_path):
    y = Y.copy()
    y[400:500] = y[400]
    said = message(lambda: load_evidence(write_folder(tmp_path / "d", pair(y))))
    assert "row 402: displacement is" in said
    assert "not stuck" in said


@pytest.mark.parametrize("late", [0, 3])
@pytest.mark.parametrize("coarse", [0.0, 0.05])
@pytest.mark.parametrize("half_width", [0.1, 0.4])
def test_a_play_that_rests_at_each_turn_is_no_fault(tmp_path, coarse, half_width, late):
    """As an encoder of a stage with backlash reads it, without noise; also late."""
    u = triangle(np.arange(1000) / 250)
    y = 4 * np.pad(play(u, half_width), (late, 0))[: len(u)]
    y = np.round(y / coarse) * coarse if coarse else y
    found = load_evidence(write_folder(tmp_path / "d", pair(y, u)))
    np.testing.assert_allclose(found.fit[0].y, y)


@pytest.mark.parametrize("count", [970, 1000])
def test_a_record_may_end_where_a_play_rests(tmp_path, count):
    """Or where the motion has become too small for it."""
    t = np.arange(count) / 500
    for number, u in enumerate((triangle(t), np.exp(-3 * t) * np.sin(20 * t))):
        made = pair(4 * play(u, 0.3), u)
        load_evidence(write_folder(tmp_path / str(number), made))


@pytest.mark.parametrize("coarse", [0.0, 0.005])
def test_a_mass_held_by_friction_is_no_fault(tmp_path, coarse):
    """It comes to rest, and rests until the force is large enough."""
    u = triangle(np.arange(1000) / 250)
    y = np.cumsum(np.sign(u) * np.maximum(np.abs(u) - 0.3, 0.0)) / 10
    y = np.round(y / coarse) * coarse if coarse else y
    found = load_evidence(write_folder(tmp_path / "d", pair(y, u)))
    assert found.fit[0].name in ("a", "a-1")  # or cut where it rests


def test_an_output_that_holds_to_the_end_is_named(tmp_path):
    """A loose plug, say: what it would have read in the end nobody knows."""
    y = Y.copy()
    y[800:] = y[800]
    said = message(lambda: load_evidence(write_folder(tmp_path / "d", pair(y))))
    assert "row 802: displacement is" in said
    assert "not stuck" in said


def triangle(periods):
    return 2 / np.pi * np.arcsin(np.sin(2 * np.pi * periods))


def saturated(coarse=0.05):
    """An output of a drive that saturates, in steps of a coarse converter."""
    return np.round(np.clip(Y, -4.0, 4.0) / coarse) * coarse


def say(folder, stands_still, name="a"):
    """Say of a record in dataset.yaml that channels really stand still."""
    file = folder / "dataset.yaml"
    about = yaml.safe_load(file.read_text())
    (entry,) = (item for item in about["records"] if item["file"] == f"{name}.csv")
    entry["stands_still"] = stands_still
    file.write_text(yaml.safe_dump(about))
    return folder


@pytest.mark.parametrize("use", ["fit", "hold-out"])
def test_an_output_that_really_saturates_is_taken_where_the_dataset_says_so(
    tmp_path, use
):
    made = [*pair(), record(U, saturated(), name="c", use=use)]
    folder = write_folder(tmp_path / "d", made)
    said = message(lambda: load_evidence(folder))
    assert "c.csv: row" in said
    assert said.endswith(
        "expected a channel that is not clipped; if it is real, say "
        "'stands_still: [output]' of this record in dataset.yaml; if the recorder did "
        "it, leave this record out"
    )
    found = load_evidence(say(folder, ["output"], "c"))
    (taken,) = (item for item in (*found.fit, *found.hold_out) if item.name == "c")
    np.testing.assert_allclose(taken.y, saturated())


def test_an_input_that_is_really_limited_is_taken_where_the_dataset_says_so(tmp_path):
    """An amplifier at its end, measured, before mechanics that ring."""
    folder = write_folder(tmp_path / "d", pair(u=np.clip(U, -0.6, 0.6)))
    said = message(lambda: load_evidence(folder))
    assert "a.csv: row" in said
    assert "current is" in said
    assert "'stands_still: [input]' of this record in dataset.yaml" in said
    found = load_evidence(say(folder, ["input"]))
    np.testing.assert_array_equal(found.fit[0].u, np.clip(U, -0.6, 0.6))


@pytest.mark.parametrize(
    ("channels", "name"), [(["input"], "a"), ([], "a"), (["output"], "b")]
)
def test_it_holds_of_that_channel_of_that_record_alone(tmp_path, channels, name):
    folder = write_folder(tmp_path / "d", pair(saturated()))
    before = message(lambda: load_evidence(folder))
    assert message(lambda: load_evidence(say(folder, channels, name))) == before


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (["outptu"], "stands_still: 0: 'outptu' is unknown; did you mean 'output'?"),
        (["y"], "'y' is unknown; expected one of input, output"),
        ("output", "stands_still: 'output'; expected a list"),
        (["output", "output"], "expected each item once"),
    ],
)
def test_a_channel_that_is_none_is_refused(tmp_path, value, expected):
    folder = say(write_folder(tmp_path / "d", pair()), value)
    said = message(lambda: load_evidence(folder))
    assert "dataset.yaml: records: 0" in said
    assert expected in said


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda y: y * np.where(np.arange(len(y)) == 7, np.nan, 1), "row 9"),
        (lambda y: y * np.where(np.arange(len(y)) == 7, np.inf, 1), "row 9"),
        (np.zeros_like, "constant"),
    ],
)
def test_no_word_makes_a_channel_of_no_number_or_no_motion_usable(
    tmp_path, spoil, expected
):
    folder = write_folder(tmp_path / "d", pair(spoil(saturated())))
    assert expected in message(lambda: load_evidence(say(folder, ["input", "output"])))


def test_an_output_may_rest_with_its_input_and_be_coarsely_digitized(tmp_path):
    u, y = U.copy(), np.round(Y * 20) / 20
    u[300:600], y[300:600] = u[300], y[300]
    found = load_evidence(write_folder(tmp_path / "d", pair(y, u)))
    np.testing.assert_array_equal(found.fit[0].y, y)


def test_an_output_of_a_few_steps_may_stand_still_while_its_input_moves(tmp_path):
    # A motion that is done in four steps stands on each of them for a while.
    y = np.round(Y / (np.ptp(Y) / 4)) * (np.ptp(Y) / 4)
    found = load_evidence(write_folder(tmp_path / "d", pair(y)))
    np.testing.assert_allclose(found.fit[0].y, y)


@pytest.mark.parametrize(
    ("period", "expected"),
    [
        (501, "period_samples: 501; expected at most 500, half of its 1000 samples"),
        (999, "or all of them: one period of a steady state"),
        (1001, "period_samples: 1001; expected at most 500"),
        (430, "period_samples: 430; the input differs from one period to the next"),
        (2.5, "period_samples: 2.5; expected a whole number"),
        (0, "period_samples"),
    ],
)
def test_a_period_that_is_none_is_refused(tmp_path, period, expected):
    folder = write_folder(tmp_path / "d", pair(period_samples=period))
    said = message(lambda: load_evidence(folder))
    assert expected in said
    assert "dataset.yaml: records" in said


def test_a_period_that_fits_twice_is_taken(tmp_path):
    folder = write_folder(tmp_path / "d", pair(period_samples=500))
    assert load_evidence(folder).fit[0].period_samples == 500
    faded = U * np.clip(np.arange(1000) / 300, 0, 1)
    u = np.concatenate([faded, U])
    made = [record(u, 5 * u, name="a", period_samples=500), pair()[1]]
    assert load_evidence(write_folder(tmp_path / "e", made)).fit[0].period_samples


def test_one_period_of_a_steady_state_is_taken(tmp_path):
    folder = write_folder(tmp_path / "d", pair(period_samples=1000))
    assert load_evidence(folder).fit[0].repeats


def test_records_may_be_sampled_at_different_rates(tmp_path):
    fast = sine(2.0, count=4000, dt=0.00025)
    made = [*pair(), record(fast, 5 * fast, name="fast", dt=0.00025)]
    found = load_evidence(write_folder(tmp_path / "d", made))
    assert [item.dt for item in found.fit] == pytest.approx([0.001, 0.00025])


def test_the_slowest_fit_record_is_for_identification_unless_named(tmp_path):
    slow, slowest = sine(1.0, count=1000), sine(0.5, count=2000)
    made = [
        record(U, Y, name="quick"),
        record(slow, 5 * slow, name="slow"),
        record(slowest, 5 * slowest, name="slowest", use="hold-out"),
    ]
    assert (
        load_evidence(write_folder(tmp_path / "d", made)).to_identify_from.name
        == "slow"
    )
    named = write_folder(tmp_path / "e", made, identification="quick")
    assert load_evidence(named).to_identify_from.name == "quick"
    held = write_folder(tmp_path / "f", made, identification="slowest")
    said = message(lambda: load_evidence(held))
    assert "identification: 'slowest' is held out" in said


def test_simulated_output_is_read_and_its_unit_checked(tmp_path):
    made = [
        record(U, Y, name="a", simulated=5 * U),
        record(0.8 * U, 0.8 * Y, name="b", use="hold-out", simulated=4 * U),
    ]
    found = load_evidence(write_folder(tmp_path / "d", made))
    assert found.simulated_column == "simulated_um"
    np.testing.assert_array_equal(found.fit[0].simulated, 5 * U)
    np.testing.assert_array_equal(found.hold_out[0].simulated, 4 * U)
    other = {"column": "simulated_um", "unit": "mm"}
    folder = write_folder(tmp_path / "e", made, simulated=other)
    said = message(lambda: load_evidence(folder))
    assert "simulated: unit 'mm', but the output has 'um'" in said
    twice = {"column": "displacement_um", "unit": "um"}
    folder = write_folder(tmp_path / "f", made, simulated=twice)
    assert "named twice" in message(lambda: load_evidence(folder))


def test_nan_in_simulated_output_is_refused(tmp_path):
    spoilt = 5 * U
    spoilt[7] = np.nan
    made = [
        record(U, Y, name="a", simulated=spoilt),
        record(0.8 * U, 0.8 * Y, name="b", use="hold-out", simulated=5 * U),
    ]
    said = message(lambda: load_evidence(write_folder(tmp_path / "d", made)))
    assert "row 9: column 'simulated_um' is 'nan'" in said


@pytest.mark.parametrize(
    ("unit_in", "unit_out"), [("A", "um"), ("ampere", "micrometer"), ("A", "µm")]
)
def test_one_unit_in_another_spelling_is_the_same(tmp_path, unit_in, unit_out):
    found = load_evidence(write_folder(tmp_path / "d", pair()))
    chain = (Gain(value=5.0),)
    model = Model("m", Channel("i", unit_in), Channel("x", unit_out), chain)
    check_units(found, model, "m.yaml")


@pytest.mark.parametrize(
    ("unit_in", "unit_out", "expected"),
    [
        ("mA", "um", ["m.yaml: input: unit 'mA'", "by 1000"]),
        ("A", "mm", ["m.yaml: output: unit 'mm'", "the displacement of made", "0.001"]),
        ("V", "um", ["input: unit 'V'", "expected the same unit"]),
    ],
)
def test_another_unit_is_refused(tmp_path, unit_in, unit_out, expected):
    found = load_evidence(write_folder(tmp_path / "d", pair()))
    chain = (Gain(value=5.0),)
    model = Model("m", Channel("i", unit_in), Channel("x", unit_out), chain)
    said = message(lambda: check_units(found, model, "m.yaml"))
    for part in expected:
        assert part in said


@pytest.mark.parametrize(
    ("name", "count", "least"), [("a.csv", 99, 100), ("b.csv", 33, 34)]
)
def test_a_record_too_short_for_its_role_is_refused_before_any_search(
    tmp_path, name, count, least
):
    def cut(item, length):
        return replace(item, u=item.u[:length].copy(), y=item.y[:length].copy())

    long = [cut(item, {"a": 100, "b": 34}[item.name]) for item in pair()]
    assert len(load_evidence(write_folder(tmp_path / "long", long)).fit) == 1
    short = [cut(x, count) if f"{x.name}.csv" == name else x for x in long]
    said = message(lambda: load_evidence(write_folder(tmp_path / "short", short)))
    assert f"{name}: {count} samples; expected at least {least}" in said

"""Bases: identified from the fit records, or a simulator that a user brings."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import lsim, lti

from hystbench.blocks.gain import Gain
from hystbench.blocks.simulated_column import SimulatedColumn
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.gap.bases import load as bases
from hystbench.gap.bases.gpi import identified_gpi
from hystbench.gap.bases.linear import (
    IdentifiedModel,
    Linear,
    identified_linear,
    is_identified_linear,
)
from hystbench.gap.bases.load import load_base
from hystbench.gap.bases.spectral import Spectra, fit_ratio, stable
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model, load_model
from hystbench.quantities import Quantities
from hystbench.record import Channel
from tests.blocks.responses import frequency_response
from tests.conftest import run_hystbench
from tests.gap.made import multisine, play_sum, record, sine, steady, write_folder
from tests.messages import message


def evidence(*records, hold="band-limited", **about):
    last = records[-1]
    held = record(last.u, last.y, name="held", dt=last.dt, use="hold-out")
    return Evidence("made", records, (held,), hold, **about)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def dynamics(model):
    """The transfer function's block of a linear base."""
    (block,) = [item for item in model.chain if item.name == "transfer-function"]
    return block


def response(model, frequency_hz):
    return frequency_response(dynamics(model), np.asarray(frequency_hz, dtype=float))


SYSTEMS = {
    "lag": lambda s: 3 / (1 + 0.02 * s),
    "resonance": lambda s: 2 / (1 + 0.06 * s / 440 + (s / 440) ** 2),
    "resonance above a gain": lambda s: 2 + 0.3 / (1 + 0.1 * s / 440 + (s / 440) ** 2),
    "derivative": lambda s: (0.1 + 0.02 * s) / (1 + 0.0005 * s),
    "lag and resonance": lambda s: (
        4 / ((1 + 0.01 * s) * (1 + 0.1 * s / 600 + (s / 600) ** 2))
    ),
}


@pytest.mark.parametrize("word", ["linear", "gpi"])
def test_a_base_is_identified_without_the_hold_out_records_in_hand(word, monkeypatch):
    given = []

    def identify(records):
        given.append(records)
        raise InputError("enough")

    for name in ("identified_linear", "identified_gpi"):
        monkeypatch.setattr(bases, name, identify)
    with pytest.raises(InputError, match="enough"):
        load_base(word, evidence(record(np.arange(64.0), np.arange(64.0))))
    assert [records.hold_out for records in given] == [()]


def test_a_file_that_is_named_linear_was_not_identified(tmp_path):
    """Its numbers are the user's: re-tuning them is no part of what was fitted."""
    known = record(steady(multisine(1)), steady(multisine(1)))
    block = TransferFunction(numerator=(1.0,), denominator=(1.0, 50.0))
    free = ("transfer-function.numerator",)
    file = tmp_path / "m.yaml"
    Model("linear", known.input, known.output, (block,), free).save(file)
    base, _ = load_base(str(file), evidence(known))
    assert base.free == free
    assert not is_identified_linear(base)


class TestLinear:
    def test_an_output_that_no_input_moves_is_told_instead_of_fitted(self):
        noise = np.random.default_rng(4)
        made = noise.normal(size=(3, 2, 2000))
        records = [record(u, y) for u, y in made]
        with pytest.raises(InputError, match=r"made: linear: .* a constant .*--model"):
            identified_linear(evidence(*records))

    @pytest.mark.parametrize(
        "name", ["resonance above a gain", "derivative", "lag and resonance"]
    )
    def test_it_finds_a_system_out_of_the_middle_of_its_motion(self, name):
        # The records hold the steady state, which no start from rest has.
        noise = np.random.default_rng(1)
        records = []
        for seed in range(3):
            sines = multisine(seed)
            u, y = steady(sines), steady(sines, SYSTEMS[name]) + 0.4
            y = y + 0.01 * y.std() * noise.standard_normal(len(y))
            records.append(record(u, y, name=f"r{seed}"))
        found = identified_linear(evidence(*records))
        at = np.geomspace(2, 150, 20)
        wanted = SYSTEMS[name](2j * np.pi * at)
        error = np.abs(response(found.model, at) - wanted) / np.abs(wanted)
        assert error.max() < 0.05
        assert found.model.chain[-1].offset == pytest.approx(0.4, abs=0.05)

    def test_periods_that_are_left_out_change_no_sampling(self):
        """Of a fast input the last periods are taken, at the rate that they have."""
        u = np.tile(np.random.default_rng(3).standard_normal(500), 10)
        found = identified_linear(evidence(record(u, 2.0 * u, period_samples=500)))
        at = np.geomspace(2, 150, 20)
        assert np.abs(response(found.model, at) - 2.0).max() < 1e-3

    @pytest.mark.parametrize(("gain", "offset"), [(3.0, 0.0), (-0.2, 5.0)])
    def test_a_gain_gets_no_dynamics(self, gain, offset):
        u = steady(multisine())
        noise = 0.1 * np.random.default_rng(2).standard_normal(len(u))
        found = identified_linear(evidence(record(u, gain * u + offset + noise)))
        (block,) = found.model.chain
        assert isinstance(block, Gain)
        # Four standard errors of a least-squares line.
        sure = 4 * 0.1 / np.sqrt(len(u))
        assert block.value == pytest.approx(gain, abs=sure / u.std())
        assert block.offset == pytest.approx(offset, abs=sure)
        assert "order 0" in found.note
        assert found.fit_rms == pytest.approx(0.1, rel=0.1)

    @given(
        tau=st.floats(0.003, 0.3),
        gain=st.floats(0.1, 50),
        hold=st.sampled_from(["zero-order", "linear"]),
        seed=st.integers(0, 1000),
    )
    @settings(max_examples=4)
    def test_a_lag_is_found_whatever_the_hold(self, tau, gain, hold, seed):
        # The exact answer of a lag to a staircase and to straight lines.
        dt, count = 0.001, 2000
        u = np.random.default_rng(seed).standard_normal(count)
        decay = math.exp(-dt / tau)
        ramp = 1 - (1 - decay) * tau / dt
        y = np.zeros(count)
        for k in range(count - 1):
            step = (1 - decay) * u[k]
            if hold == "linear":
                step = (1 - decay - ramp) * u[k] + ramp * u[k + 1]
            y[k + 1] = decay * y[k] + step
        found = identified_linear(evidence(record(u, gain * y), hold=hold))
        at = np.array([1.0, 10.0, 60.0])
        wanted = gain / (1 + 2j * np.pi * at * tau)
        np.testing.assert_allclose(response(found.model, at), wanted, rtol=0.01)
        assert found.fit_rms < 0.01 * gain * y.std()
        assert found.model.chain[0].hold == hold

    def test_the_order_is_the_one_that_the_folds_ask_for(self):
        sines = [multisine(seed) for seed in range(3)]
        system = SYSTEMS["resonance"]
        noise = np.random.default_rng(3)
        records = [
            record(steady(s), steady(s, system) + noise.standard_normal(2000))
            for s in sines
        ]
        found = identified_linear(evidence(*records))
        assert len(dynamics(found.model).denominator) == 3
        assert "order 2" in found.note

    def test_records_may_be_sampled_at_different_rates(self):
        system = SYSTEMS["lag"]
        made = []
        for dt, count in ((0.001, 2000), (0.0004, 4000)):
            sines = multisine(highest_hz=150, dt=dt, count=count)
            u = steady(sines, dt=dt, count=count)
            made.append(record(u, steady(sines, system, dt=dt, count=count), dt=dt))
        found = identified_linear(evidence(*made))
        at = np.array([2.0, 20.0, 100.0])
        wanted = system(2j * np.pi * at)
        np.testing.assert_allclose(response(found.model, at), wanted, rtol=0.02)

    def test_it_is_deterministic_and_never_looks_at_what_is_held_out(self):
        sines = multisine()
        known = record(steady(sines), steady(sines, SYSTEMS["lag and resonance"]))
        first = identified_linear(evidence(known))
        spoilt = record(known.u, np.random.default_rng(0).random(2000), use="hold-out")
        again = identified_linear(Evidence("made", (known,), (spoilt,)))
        assert first == again

    def test_a_record_out_of_a_motion_is_simulated_as_one(self):
        # Force over displacement: from a constant past it would begin with a blow.
        def system(s):
            return (0.1 + 5 * s) / (1 + 0.05 * s)

        noise = np.random.default_rng(4)
        records = []
        for frequency_hz in (1.5, 2.0, 2.5, 3.0):
            count = 1500
            sines = np.array([frequency_hz]), np.array([10.0]), np.array([0.3])
            u = steady(sines, count=count, dt=0.01)
            y = steady(sines, system, count=count, dt=0.01) + 100
            y = y + 0.5 * noise.standard_normal(count)
            records.append(record(u, y, name=f"{frequency_hz}", dt=0.01))
        found = identified_linear(evidence(*records))
        assert dynamics(found.model).start == "moving"
        for item in records:
            error = item.y - found.model.simulate(item.u, item.dt)
            assert rms(error) < 0.1 * item.y.std()

    def test_the_model_file_simulates_as_the_note_says(self, tmp_path):
        sines = multisine()
        noise = np.random.default_rng(5).standard_normal(2000)
        known = record(steady(sines), steady(sines, SYSTEMS["lag"]) + 0.2 * noise)
        found = identified_linear(evidence(known))
        found.model.save(tmp_path / "m.yaml")
        again = load_model(tmp_path / "m.yaml")
        error = (known.y - again.simulate(known.u, known.dt))[200:]
        assert rms(error) == pytest.approx(found.fit_rms, rel=1e-6)

    @pytest.mark.parametrize("count", [1, 2])
    def test_the_note_says_what_its_errors_leave_out(self, count):
        """A model from the first sample on, with one offset for all, leaves more."""
        sines = multisine()
        known = [
            record(steady(sines), steady(sines, SYSTEMS["lag"]) + k, name=f"r{k}")
            for k in range(count)
        ]
        found = identified_linear(evidence(*known))
        assert "behind its first tenth" in found.note
        assert ("an offset of its own" in found.note) == (count == 2)
        assert found.fit_rms < 0.01

    @given(st.lists(st.floats(-5, 5), min_size=1, max_size=7))
    def test_poles_are_reflected_to_the_left(self, coefficients):
        poles = np.roots([1.0, *stable(np.array(coefficients))[::-1]])
        assert (poles.real < 0).all()

    def test_a_stretch_needs_no_start_from_rest(self):
        # A free decay from a state that the record does not show, and no input's.
        time = np.arange(1000) * 0.001
        u = sine(30.0, count=1000)
        gain = 2 / (1 + 2j * np.pi * 30 * 0.05)
        y = (gain * np.exp(2j * np.pi * 30 * time)).imag + 7 * np.exp(-time / 0.05)
        spectra = Spectra.of([record(u, y, dt=0.001)], "band-limited")
        ratio = fit_ratio(spectra, 1, 0)
        block = ratio.block(spectra.scale, "band-limited", "rest")
        slow, still = block.denominator
        assert slow / still == pytest.approx(0.05, rel=0.02)
        assert block.numerator[-1] == pytest.approx(2.0, rel=0.02)


class TestHysteresis:
    def slow(self, name="slow", offset=0.0):
        u = np.concatenate([sine(1.0, count=1000), 0.6 * sine(1.0, count=1000)])
        y = play_sum(u, [0.0, 0.1, 0.2, 0.3, 0.5], [5.0, 1.0, 1.0, 1.0, 1.0])
        return record(u, y + offset, name=name)

    def test_it_identifies_the_slowest_record(self):
        u = sine(20.0)
        quick = record(u, 3 * np.roll(u, 5), name="quick")
        slow = self.slow()
        model, note = identified_gpi(evidence(quick, slow))
        error = model.simulate(slow.u, slow.dt) - slow.y
        assert rms(error) < 0.02 * rms(slow.y)
        assert "record slow" in note
        named, note = identified_gpi(evidence(quick, slow, identification="quick"))
        assert "record quick" in note
        assert named != model

    def test_a_tolerance_that_is_not_reached_is_told_and_no_error(self):
        u = sine(2.0)
        noise = np.random.default_rng(0).standard_normal(len(u))
        _, note = identified_gpi(evidence(record(u, u + noise)))
        assert "epsilon not reached" in note
        assert "relative error 0.8" in note  # 1 / sqrt(1 + 0.5)

    def test_a_tolerance_that_is_not_reached_is_told_in_plain_words(self):
        """White noise of one beside a sine of three: a third of its rms over sqrt 2."""
        u = sine(2.0)
        noise = np.random.default_rng(0).standard_normal(len(u))
        made = record(u, 3.0 * u + noise)
        share = 100 * np.std(noise) / np.std(made.y)
        _, note = identified_gpi(evidence(made))
        told = note.partition("So it leaves ")[2]
        assert float(told.partition(" um rms of record made, ")[2].split(" %")[0]) == (
            pytest.approx(share, rel=0.1)
        )
        assert "an effect smaller than that can hide" in told
        _, note = identified_gpi(dataclasses.replace(evidence(made), noise_rms=1.0))
        assert "with a noise of 1 um: that is noise" in note

    def test_a_record_that_never_turns_back_shows_no_loop(self):
        """A pull and a hold, with the noise of a measured input."""
        noise = 1e-3 * np.random.default_rng(0).standard_normal(1000)
        u = np.minimum(np.linspace(0.0, 2.0, 1000), 1.5) + noise
        wanted = r"pull: its input turns back by 0\.00"
        with pytest.raises(InputError, match=wanted) as at:
            identified_gpi(evidence(record(u, 3 * u, name="pull")))
        assert "--model linear" in str(at.value)

    def test_an_offset_stands_behind_it(self):
        slow = self.slow(offset=40.0)
        model, _ = identified_gpi(evidence(slow))
        assert [block.name for block in model.chain] == ["gpi", "gain"]
        assert rms(model.simulate(slow.u, slow.dt) - slow.y) < 0.01 * rms(slow.y)

    def test_a_loop_that_was_repeated_starts_settled(self):
        # The third round of a loop, from the middle of a branch.
        u = np.roll(sine(1.0, count=1000), 130)
        y = play_sum(np.tile(u, 3), [0.0, 0.2, 0.5], [2.0, 2.0, 3.0])[-1000:]
        model, _ = identified_gpi(evidence(record(u, y)))
        assert model.chain[0].start == "settled"
        assert rms(model.simulate(u, 0.001) - y) < 0.03 * rms(y)


TRIED = """
import sys
import numpy as np

def doubled(u, dt):
    return 2 * u

def spoils(u, dt):
    u *= 3
    return u

def raises(u, dt):
    raise RuntimeError("no licence\\nfor this")

def leaves(u, dt):
    sys.exit(3)

def short(u, dt):
    return u[1:]

def square(u, dt):
    return np.outer(u[:3], u)

def lost(u, dt):
    return np.where(np.arange(len(u)) < 5, u, np.nan)

def none(u, dt):
    pass

def random(u, dt):
    return u + np.random.default_rng().random(len(u))

number = 4
"""


@pytest.fixture
def simulators(tmp_path, monkeypatch):
    """A module of simulators, under a name of its own in every test."""
    name = "tried_" + tmp_path.name.replace("-", "_")
    (tmp_path / f"{name}.py").write_text(TRIED)
    (tmp_path / f"broken_{name}.py").write_text("import nothing_of_the_kind\n")
    monkeypatch.syspath_prepend(tmp_path)
    return name


class TestFunction:
    known = record(sine(3.0), 2.1 * sine(3.0), name="known")

    def test_it_is_called_for_every_simulation(self, simulators):
        model, note = load_base(f"{simulators}:doubled", evidence(self.known))
        np.testing.assert_array_equal(
            model.simulate(self.known.u, self.known.dt), 2 * self.known.u
        )
        assert (model.input, model.output) == (self.known.input, self.known.output)
        assert "doubled" in note
        simulation = Simulation((Gain(value=3.0), *model.chain), (self.known,))
        np.testing.assert_array_equal(simulation.output[0], 6 * self.known.u)

    def test_it_cannot_change_the_records(self, simulators):
        before = self.known.u.copy()
        load_base(f"{simulators}:spoils", evidence(self.known))
        np.testing.assert_array_equal(self.known.u, before)

    @pytest.mark.parametrize(
        ("function", "expected"),
        [
            ("raises", ["2000 samples", "RuntimeError: no licence for this"]),
            ("leaves", ["it raised SystemExit: 3"]),
            ("short", ["shape (1999,)", "expected (2000,)"]),
            ("square", ["shape (3, 2000)"]),
            ("lost", ["nan at sample 5"]),
            ("none", ["expected"]),
            ("random", ["another output", "the same one every time"]),
            ("number", ["expected a function, got int"]),
            ("doubld", ["no function 'doubld'", "did you mean 'doubled'?"]),
        ],
    )
    def test_what_it_does_wrong_is_told_in_one_line(
        self, simulators, function, expected
    ):
        text = f"{simulators}:{function}"
        said = message(lambda: load_base(text, evidence(self.known)))
        for part in [text, *expected]:
            assert part in said

    @pytest.mark.parametrize("module", ["absent_{}", "broken_{}", "absent_{}.inner"])
    def test_a_module_that_cannot_be_imported(self, simulators, module):
        text = f"{module.format(simulators)}:doubled"
        said = message(lambda: load_base(text, evidence(self.known)))
        assert "cannot import" in said
        assert "ModuleNotFoundError" in said
        assert "the folder of the start and not of the model file" in said

    def test_a_model_file_may_name_it(self, simulators, tmp_path):
        model, _ = load_base(f"{simulators}:doubled", evidence(self.known))
        model.save(tmp_path / "m.yaml")
        again, _ = load_base(str(tmp_path / "m.yaml"), evidence(self.known))
        assert again == model

    def test_loading_a_file_runs_nothing(self):
        content = {
            "name": "m",
            "input": {"name": "i", "unit": "A"},
            "output": {"name": "x", "unit": "um"},
            "chain": [{"external": {"function": "absent.module:function"}}],
        }
        model = Model.from_mapping(content, "m.yaml")
        assert model.to_mapping() == content


class TestColumn:
    u = sine(3.0)
    records = (
        record(u, 2 * u, name="a", simulated=1.9 * u),
        record(u, 2 * u, name="again", simulated=1.8 * u),
        record(sine(5.0), sine(6.0), name="b", use="hold-out", simulated=sine(7.0)),
    )
    given = Evidence("made", records[:2], records[2:], simulated_column="simulated_um")

    def base(self):
        return load_base("column", self.given)[0]

    def test_each_record_has_its_own(self):
        simulation = Simulation(self.base().chain, self.records)
        for item, output in zip(self.records, simulation.output, strict=True):
            np.testing.assert_array_equal(output, item.simulated)

    def test_the_beginning_of_an_input_has_the_beginning_of_the_output(self):
        u = np.array(self.records[2].u[:500])
        np.testing.assert_array_equal(self.base().simulate(u, 0.001), sine(7.0)[:500])

    def test_effects_act_behind_it(self):
        simulation = Simulation((*self.base().chain, Gain(value=2.0)), self.records)
        np.testing.assert_array_equal(simulation.output[1], 3.6 * self.u)

    @pytest.mark.parametrize("steps", ["plain", "quick"])
    def test_an_input_that_was_changed_is_refused(self, steps):
        simulation = Simulation(
            (Gain(value=1.01), *self.base().chain), self.records, steps=steps
        )
        said = message(lambda: simulation.output)
        assert "needs a simulator that can be run again" in said
        assert not self.base().chain[0].reruns

    def test_another_sampling_interval_is_another_input(self):
        assert "of no record" in message(lambda: self.base().simulate(self.u, 0.002))

    def test_two_datasets_are_not_taken_for_each_other(self):
        # Equal blocks share what is kept of them.
        other = record(self.u, 2 * self.u, name="a", simulated=7 * self.u)
        chain = (SimulatedColumn(column="simulated_um", records=(other,)),)
        assert chain != self.base().chain
        for steps in ("plain", "quick"):
            own = Simulation(self.base().chain, self.records[:1], steps=steps)
            (ours,) = own.output
            (theirs,) = Simulation(chain, (other,), steps=steps).output
            np.testing.assert_array_equal(ours, 1.9 * self.u)
            np.testing.assert_array_equal(theirs, 7 * self.u)

    def test_a_dataset_without_one_is_refused(self):
        said = message(lambda: load_base("column", evidence(record(self.u, self.u))))
        assert "simulated: {column: .., unit: ..}" in said

    def test_a_model_file_runs_wherever_the_records_are(self, tmp_path):
        folder = write_folder(tmp_path / "d", [self.records[0], self.records[2]])
        model = self.base()
        model.save(tmp_path / "m.yaml")
        again, _ = load_base(str(tmp_path / "m.yaml"), self.given)
        assert again == model
        out = tmp_path / "out.csv"
        done = run_hystbench(
            "simulate", tmp_path / "m.yaml", folder / "b.csv", "--out", out
        )
        assert done.returncode == 0, done.stderr
        column = np.loadtxt(out, delimiter=",", skiprows=1)[:, -1]
        np.testing.assert_allclose(column, sine(7.0), atol=1e-9)

    def test_a_model_file_of_another_column_is_refused(self, tmp_path):
        path = tmp_path / "m.yaml"
        self.base().save(path)
        path.write_text(path.read_text().replace("simulated_um", "other_um"))
        said = message(lambda: load_base(str(path), self.given))
        assert "column: 'other_um'; expected 'simulated_um'" in said
        bare = evidence(record(self.u, self.u, name="bare"))
        said = message(lambda: load_base(str(path), bare))
        assert "record bare: no simulated output" in said


class TestLoad:
    known = evidence(record(sine(3.0), 2 * sine(3.0)))

    def test_words_and_files(self, tmp_path):
        assert load_base("gpi", self.known)[0].chain[0].name == "gpi"
        assert load_base("linear", self.known)[0].name == "linear"
        channels = self.known.input, self.known.output
        model = Model("mine", *channels, (Gain(value=2.0),))
        model.save(tmp_path / "mine.yaml")
        loaded, note = load_base(str(tmp_path / "mine.yaml"), self.known)
        assert loaded == model
        assert "mine.yaml" in note

    def test_units_of_a_file_are_checked(self, tmp_path):
        path = tmp_path / "mine.yaml"
        volts = Channel("voltage", "V"), self.known.output
        Model("mine", *volts, (Gain(value=2.0),)).save(path)
        said = message(lambda: load_base(str(path), self.known))
        assert f"{path}: input: unit 'V'" in said

    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("linaer", "did you mean 'linear'?"),
            ("gip", "did you mean 'gpi'?"),
            ("colum", "did you mean 'column'?"),
            ("my model", "expected one of gpi, linear, column"),
        ],
    )
    def test_what_is_nothing_of_these_is_told(self, text, expected):
        said = message(lambda: load_base(text, self.known))
        assert repr(text) in said
        assert expected in said

    def test_a_file_whose_model_runs_away_is_refused(self, tmp_path):
        path = tmp_path / "m.yaml"
        gains = tuple(Gain(value=1e9) for _ in range(40))
        Model("m", self.known.input, self.known.output, gains).save(path)
        said = message(lambda: load_base(str(path), self.known))
        assert "not finite from 0.001 s of record made" in said

    def test_a_file_that_is_not_there(self, tmp_path):
        path = str(tmp_path / "no.yaml")
        assert path in message(lambda: load_base(path, self.known))


def test_a_stretch_shorter_than_its_transient_has_numbers_is_fitted():
    u = np.array([0.0, 1.0, -1.0, 0.5])
    long = np.random.default_rng(2).normal(size=(2, 400))
    records = [record(*long, dt=0.001), record(u, 0.5 * u, dt=0.001)]
    ratio = fit_ratio(Spectra.of(records, "linear"), 6, 6)
    assert np.all(np.isfinite(ratio.a))


def test_where_five_poles_do_not_do_modes_are_added_one_by_one():
    modes = [
        lti([size * w**2], [1.0, 0.06 * w, w**2])
        for frequency, size in ((12.0, 1.0), (25.0, 0.5), (43.0, -0.4), (70.0, 0.3))
        for w in (2 * np.pi * frequency,)
    ]
    time = 0.001 * np.arange(2000)
    records = []
    for seed in range(3):
        random = np.random.default_rng(seed)
        u = steady(multisine(seed, highest_hz=100.0)) * np.minimum(1.0, time / 0.1)
        y = sum(lsim(mode, u, time)[1] for mode in modes)
        records.append(record(u, y + 0.02 * random.standard_normal(2000)))
    found = identified_linear(evidence(*records))
    assert len(dynamics(found.model).denominator) == 9
    assert found.fold_rms < 1.5 * 0.02


def test_of_many_poles_the_denominator_is_not_free(monkeypatch):
    known = record(steady(multisine(1)), steady(multisine(1)))
    down = np.poly([-10.0, -20.0, -30.0, -40.0, -50.0, -60.0, -70.0])

    def identified(evidence):
        block = TransferFunction(numerator=(1.0,), denominator=tuple(down.tolist()))
        chain = (block, Gain(value=1.0, offset=0.0))
        return Linear(
            IdentifiedModel("linear", known.input, known.output, chain), "", 0, 0, 0
        )

    monkeypatch.setattr(bases, "identified_linear", identified)
    model, _ = load_base("linear", evidence(known))
    assert "transfer-function.numerator" in model.free
    assert "transfer-function.denominator" not in model.free


def impedance_records(noise=0.0, fastest_hz=40.0, law=None):
    """The force of a mass on a spring along two motions, from its formula."""
    random = np.random.default_rng(4)
    made = []
    for place in range(2):
        t = np.arange(1500) * 1e-3
        w = 2 * np.pi * random.uniform(5, fastest_hz, 6)
        size, phase = random.uniform(0.2, 1.0, 6), random.uniform(0, 6, 6)
        q = size @ np.sin(np.outer(w, t) + phase[:, None])
        v = (size * w) @ np.cos(np.outer(w, t) + phase[:, None])
        a = -(size * w**2) @ np.sin(np.outer(w, t) + phase[:, None])
        force = 2e-4 * a + 0.05 * v + 30.0 * q + 4.0
        force += 0.0 if law is None else law(q)
        force += noise * random.standard_normal(len(t))
        made.append(record(q, force, name=f"motion {place}", dt=1e-3))
    return made


def test_where_a_motion_makes_a_force_the_base_is_an_impedance():
    """Its force grows with the square of the frequency: no ratio that runs does so."""
    about = {"quantities": Quantities("position", "force")}
    found = identified_linear(evidence(*impedance_records(0.01), **about))
    (block,) = found.model.chain
    values = (block.mass, block.damping, block.stiffness, block.bias)
    assert values == pytest.approx((2e-4, 0.05, 30.0, 4.0), rel=0.01)
    assert found.fit_rms < 0.011
    # Of what is not known to be a motion and a force it is none.
    unknown = identified_linear(evidence(*impedance_records(0.01)))
    assert {item.name for item in unknown.model.chain} <= {"transfer-function", "gain"}
    assert unknown.fit_rms > found.fit_rms


def test_an_impedance_behind_a_static_curve_has_the_mean_force_of_the_records():
    def stop(q):
        return 300.0 * np.sign(q) * np.maximum(np.abs(q) - 1.0, 0.0)

    given = evidence(
        *impedance_records(0.01, fastest_hz=12.0, law=stop),
        quantities=Quantities("position", "force"),
    )
    found = identified_linear(given)
    assert found.model.found_with == "static curve"
    (block,) = found.model.chain
    assert block.name == "impedance"
    left = [x.y - block.simulate(x.u, x.u, x.dt) for x in given.fit]
    assert np.mean(np.concatenate(left)) == pytest.approx(0.0, abs=1e-6)

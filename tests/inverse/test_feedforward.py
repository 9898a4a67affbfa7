"""The input for a reference, for models of any blocks."""

import csv
import re

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.commands.invert import bandwidth, holds_to
from hystbench.errors import InputError
from hystbench.inverse.feedforward import InputRange, feedforward
from hystbench.inverse.response import best_linear, without
from hystbench.model import Model, load_model
from hystbench.record import Channel
from tests.blocks.examples import EXAMPLES
from tests.conftest import ROOT, run_hystbench

DT = 1e-4
TIME = np.arange(2000) * DT
TWIN = ROOT / "src" / "hystbench" / "plants" / "gma.yaml"


def model_of(*blocks):
    chain = [
        registry()[name].from_mapping({**EXAMPLES[name], **values})
        for name, values in blocks
    ]
    return Model("m", Channel("current", "A"), Channel("x", "um"), tuple(chain))


def error(model, u, reference):
    y = model.simulate(u, DT)
    return np.sqrt(np.mean((y - reference) ** 2)) / np.ptp(reference)


def sine(frequency, size, rest=0.0):
    return rest + size * np.sin(2 * np.pi * frequency * TIME)


def test_a_linear_system_needs_its_own_inverse_and_no_more():
    model = model_of(("drive-lag", {"time_constant_s": 0.002}))
    found = feedforward(model, sine(50, 1.0), DT)
    # In closed form: r + tau dr/dt.
    w = 2 * np.pi * 50
    wanted = np.sin(w * TIME) + 0.002 * w * np.cos(w * TIME)
    inner = slice(200, -200)
    np.testing.assert_allclose(found.u[inner], wanted[inner], atol=0.02)
    assert found.exact == ""


@pytest.mark.parametrize(
    "blocks",
    [
        [("gpi", {}), ("sensor-lag", {})],
        [("gain", {"value": -0.5, "offset": 0.1}), ("gpi", {}), ("resonance", {})],
        [("prandtl-ishlinskii", {}), ("creep", {})],
        [("preisach", {"cells": 32, "half_widths": [0.05, 0.1]}), ("sensor-lag", {})],
        [("jiles-atherton", {}), ("input-delay", {})],
        [("gpi", {}), ("rate-dependent-hysteresis", {}), ("sensor-lag", {})],
        [("eddy-diffusion", {}), ("gpi", {}), ("asymmetry", {})],
        [("mechanism", {}), ("stiffness", {}), ("drag", {})],
        [("gpi", {}), ("mechanism", {"hold": "band-limited"}), ("stiffness", {})],
        [("impedance", {"mass": 1e-5}), ("hysteretic-force", {})],
        [("gpi", {}), ("thermal-drift", {}), ("sensor-lag", {})],
    ],
    ids=lambda blocks: "+".join(name for name, _ in blocks),
)
def test_the_models_output_follows(blocks):
    model = model_of(*blocks)
    u = 0.3 * np.sin(2 * np.pi * 20 * TIME)
    y = model.simulate(u, DT)
    rest = model.simulate(np.zeros(50), DT)[-1]
    reference = sine(20, 0.4 * np.ptp(y), rest)
    found = feedforward(model, reference, DT)
    line = np.polyfit(y, u, 1)
    assert error(model, np.polyval(line, reference), reference) > 0.02
    # The first half may begin with what no input makes: a delay, a mode at rest.
    off = (reference - found.y)[len(TIME) // 2 :]
    assert np.sqrt(np.mean(off**2)) < 0.01 * np.ptp(reference)
    assert found.left == pytest.approx(error(model, found.u, reference), rel=1e-9)


def test_an_integrator_is_refused():
    integrator = {"numerator": [20.0], "denominator": [0.002, 1.0, 0.0]}
    model = model_of(("gain", {}), ("transfer-function", integrator))
    with pytest.raises(InputError, match="block 2: transfer-function: a pole at s = 0"):
        feedforward(model, sine(20, 0.4, 0.0), DT)


def test_plays_at_the_beginning_are_inverted_exactly():
    model = model_of(("gain", {"value": 2.0, "offset": -0.1}), ("gpi", {}))
    u = 0.2 * np.sin(2 * np.pi * 10 * TIME)
    reference = model.simulate(u, DT)
    found = feedforward(model, reference, DT)
    assert found.exact == "gpi"
    assert error(model, found.u, reference) < 1e-4


def test_an_inverse_never_leaves_the_limits_of_the_input():
    model = load_model(TWIN)
    reference = sine(40, 9.0)
    found = feedforward(model, reference, DT, limits=InputRange(-0.4, 0.3))
    assert found.u.min() >= -0.4
    assert found.u.max() <= 0.3
    assert found.clipped > 0


def test_a_stroke_out_of_reach_is_refused():
    with pytest.raises(InputError, match="reference: "):
        feedforward(load_model(TWIN), sine(40, 500.0), DT)


@pytest.mark.parametrize("reference", [np.zeros(100), np.full(100, np.nan), np.ones(3)])
def test_a_reference_that_is_none_is_refused(reference):
    with pytest.raises(InputError, match="reference: expected"):
        feedforward(load_model(TWIN), reference, DT)


@pytest.mark.parametrize("band", [0.0, -1.0, 6000.0])
def test_a_band_beyond_half_the_sampling_rate_is_refused(band):
    with pytest.raises(InputError, match="--band: "):
        feedforward(load_model(TWIN), sine(10, 5.0), DT, band)


def test_the_best_linear_approximation_of_a_linear_system_is_it():
    model = model_of(("drive-lag", {"time_constant_s": 0.002}))
    found = best_linear(lambda u: model.simulate(u, DT), 1.0, 2000, DT, 500.0)
    wanted = 1 / (1 + 2j * np.pi * found.frequency_hz * 0.002)
    np.testing.assert_allclose(found.value, wanted, rtol=0.02)
    assert found.gain == pytest.approx(1.0, rel=0.01)


def test_within_the_band_a_filter_and_its_inverse_cancel():
    model = model_of(("drive-lag", {"time_constant_s": 0.002}))
    found = best_linear(lambda u: model.simulate(u, DT), 1.0, 2000, DT, 1500.0)
    u = sine(30, 1.0, 0.2)
    y = model.simulate(u, DT)
    inner = slice(300, -300)
    back = without(found, y, DT, 1000.0)
    np.testing.assert_allclose(back[inner], u[inner], atol=0.005)


def test_the_bandwidth_ends_where_the_error_is_above_a_percent():
    model, limits = load_model(TWIN), InputRange(-0.632, 0.632)
    rows = bandwidth(
        model,
        15.0,
        4 * DT,
        300.0,
        lambda wanted: feedforward(model, wanted, 4 * DT, 300.0, limits).u,
    )
    errors = {round(row.frequency_hz): row.error for row in rows}
    highest = holds_to(rows)
    assert errors[3] < 0.01
    assert 30 < highest < 300
    assert errors[300] > 0.01  # more input than there is


class TestCommand:
    def reference(self, tmp_path, name="displacement_um"):
        file = tmp_path / "wanted.csv"
        rows = [f"{t:.9g},{y:.9g}" for t, y in zip(TIME, sine(50, 7.0), strict=True)]
        file.write_text("\n".join([f"time_s,{name}", *rows]) + "\n")
        return file

    def test_the_drive_signal_moves_the_model_along_the_reference(self, tmp_path):
        out = tmp_path / "drive.csv"
        done = run_hystbench(
            "invert", TWIN, "--reference", self.reference(tmp_path), "--out", out
        )
        assert done.returncode == 0, done.stderr
        assert "'gpi' inverted exactly" in done.stdout
        with out.open() as stream:
            rows = list(csv.DictReader(stream))
        assert list(rows[0]) == [
            "time_s", "current_A", "displacement_um", "simulated_um",
        ]  # fmt: skip
        u = np.array([float(row["current_A"]) for row in rows])
        assert error(load_model(TWIN), u, sine(50, 7.0)) < 0.002

    def test_without_a_reference_it_tells_the_bandwidth(self, tmp_path):
        out = tmp_path / "bandwidth.csv"
        given = ("--dt", 4 * DT, "--stroke", 10, "--band", 200, "--out", out)
        done = run_hystbench("invert", TWIN, *given)
        assert done.returncode == 0, done.stderr
        assert "holds to" in done.stdout
        header, *rows = out.read_text().splitlines()
        assert header == "frequency_hz,rms_error_percent,largest_input,said"
        assert len(rows) == 13

    def test_sample_by_sample_the_model_moves_along_too(self, tmp_path):
        out = tmp_path / "drive.csv"
        limits = ("--limit-low", -2, "--limit-high", 2)
        given = ("--sampled", "--reference", self.reference(tmp_path), "--out", out)
        done = run_hystbench("invert", TWIN, *given)
        assert done.returncode == 2
        assert done.stderr == ("hystbench: --limit-low: expected it beside --sampled\n")
        done = run_hystbench("invert", TWIN, *given, *limits)
        assert done.returncode == 0, done.stderr
        assert "inverted sample by sample" in done.stdout
        with out.open() as stream:
            rows = list(csv.DictReader(stream))
        u = np.array([float(row["current_A"]) for row in rows])
        assert error(load_model(TWIN), u, sine(50, 7.0)) < 0.02

    def test_the_bandwidth_sample_by_sample(self, tmp_path):
        out = tmp_path / "bandwidth.csv"
        given = ("--dt", 1.5e-3, "--stroke", 10, "--band", 100, "--out", out)
        limits = ("--limit-low", -2, "--limit-high", 2)
        done = run_hystbench("invert", TWIN, "--sampled", *given, *limits)
        assert done.returncode == 0, done.stderr
        # Seven samples a period are too few for it, twenty are enough.
        (highest,) = re.findall(r"holds to (\S+) Hz", done.stdout)
        assert 1 / (20 * 1.5e-3) < float(highest) < 1 / (7 * 1.5e-3)

    @pytest.mark.parametrize(
        ("given", "said"),
        [
            (("--dt", "1e-4"), "--stroke: expected it, or a --reference"),
            (("--dt", "0", "--stroke", "1"), "--dt: 0; expected a number above 0"),
            (
                ("--dt", "1", "--stroke", "nan"),
                "--stroke: nan; expected a number above 0",
            ),
            (
                ("--dt", "1", "--stroke", "1", "--band", "nan"),
                "--band: nan; expected a number above 0",
            ),
            (
                ("--dt", "1", "--stroke", "1", "--band", "0"),
                "--band: 0; expected a number above 0",
            ),
            (("--limit-low", "nan"), "--limit-low: nan; expected a number"),
            (("--limit-high", "inf"), "--limit-high: inf; expected a number"),
        ],
    )
    def test_a_mistake_is_one_line(self, tmp_path, given, said):
        done = run_hystbench("invert", TWIN, *given, "--out", tmp_path / "x.csv")
        assert done.returncode == 2
        assert done.stderr == f"hystbench: {said}\n"

    def test_a_column_of_another_name_is_one_line(self, tmp_path):
        file = self.reference(tmp_path, "position_um")
        done = run_hystbench(
            "invert", TWIN, "--reference", file, "--out", tmp_path / "x.csv"
        )
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert "displacement_um" in done.stderr


@pytest.mark.parametrize("size", [0.02, 0.05])
def test_a_motion_that_runs_away_is_refused_in_one_line(size):
    # 100 q - 1e5 q^3 holds no load beyond q = 0.018.
    model = model_of(
        ("mechanism", {}), ("stiffness", {"quadratic": 0.0, "cubic": -1e5})
    )
    with pytest.raises(InputError, match=r"^reference: .*diverges") as told:
        feedforward(model, sine(20, size), DT)
    assert "\n" not in str(told.value)

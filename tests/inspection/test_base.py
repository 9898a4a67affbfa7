"""Effects are judged beside the model that is given, which is run on all records."""

import numpy as np
import pytest
import yaml

from hystbench.errors import InputError
from hystbench.inspection import screen
from hystbench.inspection.page import page
from hystbench.inspection.visible import could_do
from hystbench.model import Model
from hystbench.record import Channel
from tests.conftest import run_hystbench
from tests.gap.made import DISPLACEMENT, record, write_folder
from tests.gap.small import block
from tests.inspection.stage import NOISE, STAGE, T, looked, saved, through, wave


@pytest.fixture
def rig(tmp_path):
    u = np.sin(2 * np.pi * 5 * T)
    made = [
        record(u, 3.0 * u + 1.0, name="a"),
        record(0.5 * u, 1.5 * u + 1.0, name="b", use="hold-out"),
    ]
    write_folder(tmp_path / "rig", made)
    return tmp_path


def said(found):
    return " ".join(" ".join(screen.lines(found)).split())


def test_it_says_what_is_left_beside_what_the_output_moves_by(rig):
    """Of a gain of two for three, and no offset: rms of ``sin + 1``."""
    found = looked(rig, "rig", saved(rig, block("gain", value=2.0)), effects=False)
    left, moves = np.sqrt(0.5 + 1.0), 3.0 * np.sqrt(0.5)
    assert f"leaves {left:.3g} µm rms" in said(found)
    assert f"move by {moves:.3g} µm rms" in said(found)


def test_a_loop_is_run_over_the_period_before_a_steady_motion(tmp_path):
    """Cut out of a motion, it would else begin on its first branch from rest."""
    u = np.sin(2 * np.pi * 5 * np.arange(1000) / 1000)
    plays = {"thresholds": [0.4], "weights": [1.0]}
    loop = block("prandtl-ishlinskii", **plays)
    y = loop.simulate(u, u, 1e-3)[250:]
    y += NOISE * np.random.default_rng(4).standard_normal(len(y))
    cut = {"period_samples": 200}
    made = [record(u[250:], y, name=name, use=use, **cut) for name, use in USED]
    write_folder(tmp_path / "rig", made)
    found = looked(tmp_path, "rig", saved(tmp_path, loop), effects=False)
    assert found.base.left < 1.1 * NOISE


def test_a_part_that_goes_on_lies_where_it_was_measured(tmp_path):
    """It is run from the first row of the file, and compared from its own."""
    u = np.repeat([1.0, 0.2, 0.7, 0.4], 200)
    body = block("drive-lag", time_constant_s=0.3)
    y = body.simulate(u, u, 1e-3)
    write_folder(tmp_path / "rig", [record(u, y, name="run")])
    file = tmp_path / "rig" / "dataset.yaml"
    about = yaml.safe_load(file.read_text())
    about["records"] = [
        {"file": "run.csv", "name": name, "rows": rows, "use": use}
        for name, rows, use in (("a", [1, 500], "fit"), ("b", [501, 800], "hold-out"))
    ]
    file.write_text(yaml.safe_dump(about))
    found = looked(tmp_path, "rig", saved(tmp_path, body), effects=False)
    *_, last = found.base.whole
    assert len(last.record) == 300
    assert np.max(np.abs(last.residual)) < 1e-3


USED = ("a", "fit"), ("b", "hold-out")


@pytest.fixture
def begun(tmp_path):
    """Records of a lag that was far away before each began."""
    made = []
    for seed, use in enumerate(("fit", "fit", "hold-out")):
        u = np.concatenate([np.full(400, 8.0), wave(seed)])
        y = through(u, block("drive-lag", time_constant_s=0.02))
        y += NOISE * np.random.default_rng(seed).standard_normal(len(u))
        made.append(record(u[400:], y[400:], name=f"r{seed}", use=use))
    write_folder(tmp_path / "lag", made, noise_rms=NOISE)
    return tmp_path


def test_the_beginning_in_the_middle_of_a_motion_is_left_out(begun):
    """As the search does: the base that was identified leaves the noise alone."""
    found = looked(begun, "lag", "linear", effects=False)
    assert found.base.left < 2 * NOISE
    assert all(0 < item.record.lead < 400 for item in found.base.whole)
    assert "not scored is the beginning of records" in said(found)
    assert "the model may be wrong" not in said(found)


def test_effects_are_judged_behind_the_beginning_too(begun):
    """Beside a start of eight times the motion no effect had been as small."""
    found = looked(begun, "lag", "linear")
    (item,) = (x for x in found.effects if x.effect == "sensor-nonlinearity")
    assert item.seen_from < 0.1


def test_what_an_identified_base_was_fitted_to_is_told_apart(tmp_path):
    """A kick in the first tenth is no start of it: two errors, and why."""
    made = []
    for seed, use in enumerate(("fit", "fit", "hold-out")):
        u = wave(seed)
        y = 3 * u + NOISE * np.random.default_rng(seed).standard_normal(len(u))
        y[10:40] += np.random.default_rng(7).standard_normal(30)
        made.append(record(u, y, name=f"r{seed}", use=use))
    write_folder(tmp_path / "gain", made, noise_rms=NOISE)
    found = looked(tmp_path, "gain", "linear", effects=False)
    assert found.base.left > 5 * found.base.behind
    fit = found.base.note.partition("rms error ")[2].partition(" um on the fit")[0]
    assert found.base.behind == pytest.approx(float(fit), rel=0.01)
    assert f"({found.base.behind:.3g} µm behind the first tenth" in said(found)


def test_a_model_of_other_signals_is_refused(rig):
    other = Channel("voltage", "V")
    Model("other", other, DISPLACEMENT, (block("gain", value=2.0),)).save(
        rig / "other.yaml"
    )
    with pytest.raises(InputError, match=r"input: unit 'V', but .* has 'A'"):
        looked(rig, "rig", str(rig / "other.yaml"))


def test_the_command_runs_the_model(rig):
    model = saved(rig, block("gain", value=2.0))
    data = str(rig / "rig" / "dataset.yaml")
    done = run_hystbench("check", data, "--no-effects", "--model", model)
    assert done.returncode == 0, done.stderr
    assert "It runs on all records" in " ".join(done.stdout.split())


def test_effects_are_counted_beside_a_model_where_no_loop_fits(stage):
    model = saved(stage, block("mechanism", **STAGE), name="stage-model")
    alone, beside = looked(stage, "stage"), looked(stage, "stage", model)
    assert not alone.base.fits
    assert "With '--model FILE' they are judged beside your simulator" in said(alone)
    # What the model leaves is the noise alone.
    assert beside.base.left == pytest.approx(NOISE, rel=0.1)
    assert (
        "beside the model 'stage-model' the records"
        in screen.words_of(beside)("headline")[0]
    )
    for text in (said(beside), page(beside)):
        assert "loop" not in text.replace("hysteresis-loop", "")
        assert "stage-model" in text


def test_a_force_in_the_mode_of_a_model_is_not_said_to_have_none(stage):
    model = saved(stage, block("mechanism", **STAGE))
    found = looked(stage, "stage", model)
    why = {item.effect: item.why for item in found.unjudged}
    assert "acts inside the dynamics" in why["stiffness-hardening"]


def test_an_effect_beside_a_model_is_as_strong_as_it_is_said_to_be(stage):
    """The nonlinearity at the number told adds the share told, by its definition."""
    model = saved(stage, block("mechanism", **STAGE))
    found = looked(stage, "stage", model)
    (item,) = (x for x in found.effects if x.effect == "sensor-nonlinearity")
    added, whole = [], []
    for given in (x for x in found.records if x.use == "fit"):
        y = through(given.u, block("mechanism", **STAGE))
        added.append(item.value * y ** {"quadratic": 2, "cubic": 3}[item.number])
        whole.append(given.y)
    share = np.sqrt(np.mean(np.square(added)) / np.mean([np.var(y) for y in whole]))
    assert share == pytest.approx(item.seen_from, rel=0.05)


def test_what_a_free_number_of_a_model_could_do_is_no_sign_of_an_effect(stage):
    """A lag of a mode is, to first order, more of its damping."""
    blocks = block("mechanism", **STAGE)
    held = looked(stage, "stage", saved(stage, blocks, name="held"))
    names = tuple(f"mechanism.{key}" for key in STAGE)
    free = looked(stage, "stage", saved(stage, blocks, name="free", free=names))

    def least(found):
        return next(x for x in found.effects if x.effect == "drive-lag").seen_from

    assert least(free) > 1.5 * least(held)


def test_the_hysteresis_looked_for_beside_a_linear_model_is_none_of_its_own(stage):
    """Some of it is another gain, which is taken off."""
    found = looked(stage, "stage", saved(stage, block("mechanism", **STAGE)))
    (item,) = (x for x in found.effects if x.effect == "hysteresis")
    assert item.judged
    assert item.form or item.number


def test_a_free_mass_is_run_on_its_windows(tmp_path):
    """What its unknown velocity does is left out of each, as in the search."""
    made = []
    plant = block("mechanism", mass=0.02, damping=0.05, stiffness=0.0)
    for seed, use in enumerate(("fit", "hold-out")):
        u = np.sign(np.sin(2 * np.pi * 1.3 * (1 + 0.2 * seed) * T + 0.4))
        y = through(u, plant)
        y = y + 1e-4 * np.random.default_rng(seed).standard_normal(len(u))
        made.append(record(u, y, name=f"r{seed}", use=use))
    write_folder(tmp_path / "slide", made, noise_rms=1e-4)
    found = looked(tmp_path, "slide", saved(tmp_path, plant), effects=False)
    assert found.base.fit[0].record.decay_s is not None
    assert [len(x.simulated) for x in found.base.whole] == [len(T), len(T)]
    assert found.base.left < 0.01 * found.base.moves


@pytest.mark.parametrize(
    ("about", "words"),
    [
        ((False, False), "gain, or offset"),
        ((True, False), "gain, offset, or shape of the hysteresis"),
        ((True, True), "gain, offset, shape of the hysteresis, or free number"),
    ],
)
def test_what_a_base_could_do_as_well_is_told(about, words):
    assert could_do(*about) == words

"""The worked example: the periods of its records, and what is named of its twin."""

import numpy as np
import pytest
import yaml

from hystbench.dataset import load_dataset
from hystbench.gap.bases.load import load_base
from hystbench.gap.example import write_example
from hystbench.gap.records.evidence import load_evidence
from hystbench.identification.algorithm import identify_slow_loop
from hystbench.model import load_model
from hystbench.record import Channel, Record
from hystbench.settings import read_settings
from hystbench.signals import make_signal
from hystbench.twin_record import record_of_twin
from tests.conftest import shorten
from tests.gap.searched import search

CURRENT, LENGTH = Channel("current", "A"), Channel("displacement", "um")


def test_the_dataset_names_the_period_of_records_that_have_one(tmp_path):
    time = np.arange(2000) / 1000
    sine = np.sin(2 * np.pi * 10 * time)
    chirp = np.sin(2 * np.pi * (1 + 5 * time) * time)
    records = [
        Record(name, 1e-3, u, 2 * u, CURRENT, LENGTH, "twin")
        for name, u in (("sine", sine), ("chirp", chirp))
    ]
    identified = {
        "envelope": [1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
        "thresholds": [0.0],
        "weights": [2.0],
        "start": "rest",
        "offset": 0.0,
    }
    write_example(records[:1], records[1:], identified, tmp_path)

    dataset = load_dataset(tmp_path / "dataset")
    assert dataset.read("sine").period_samples == 100
    assert (dataset.use("sine"), dataset.use("chirp")) == ("fit", "hold-out")
    assert dataset.read("chirp").period_samples is None


FIT = ("sine-040hz", "sine-120hz", "chirp-1-100hz")
"""Of the example's fit records a few that show both effects, in half the time."""
SHORT_S = 0.5
"""Length of the sines, which repeat; the chirp is twice as long."""


@pytest.fixture(scope="module")
def settings(root):
    config = yaml.safe_load((root / "config.yaml").read_text(encoding="utf-8"))
    assert set(FIT) <= set(config["gap"]["twin"]["fit"])
    slow = config["excitations"][config["identification"]["signal"]]["sine"]
    slow["duration_s"] = config["excitation"]["duration_s"]
    shorten(config, SHORT_S)
    config["excitations"]["chirp-1-100hz"]["chirp"]["duration_s"] = 2 * SHORT_S
    return read_settings(config, root / "workflow" / "schemas" / "config.schema.yaml")


@pytest.fixture(scope="module")
def twin(settings):
    """The model file that stands for the actuator."""
    return load_model(settings.model_file)


@pytest.fixture(scope="module")
def named(settings, twin, tmp_path_factory):
    """Effects named beside the slow loop's model, on the example's records."""

    def recorded(name):
        signal = make_signal(name, **settings.signal_job(name))
        return record_of_twin(signal, twin, settings.measure_job, settings.model_file)

    slow = recorded(settings.identification_signal)
    identified = identify_slow_loop(slow, settings.identification_job)
    folder = tmp_path_factory.mktemp("example")
    held_out = [recorded("sine-020hz")]
    write_example(list(map(recorded, FIT)), held_out, identified.to_dict(), folder)
    evidence = load_evidence(folder / "dataset", "fit")
    base, _ = load_base(str(folder / "base.yaml"), evidence)
    with pytest.MonkeyPatch.context() as patch:
        # What would tell likely effects apart takes long and decides nothing.
        patch.setattr(
            "hystbench.gap.judge_and_tell.tell_apart", lambda *given: (None, "")
        )
        content = search(evidence.name, evidence.fit, base, evidence.input_hold).content
    assert content["verdict"] == "named"
    return {item["name"]: item["parameters"] for item in content["effects"]}


def depends_on_rate(block):
    """Tell whether the same samples ten times as fast give another output."""
    z = np.sin(np.arange(300) / 10) + np.sin(np.arange(300) / 3)
    slow, fast = (block.simulate(z, z, dt) for dt in (1e-3, 1e-4))
    return not np.allclose(slow, fast)


def pole_and_zero(twin):
    """Time constants in s of the first-order transfer function in the model file."""
    (block,) = (item for item in twin.chain if item.name == "transfer-function")
    (zero, up), (pole, down) = block.numerator, block.denominator
    return pole / down, zero / up


def test_only_what_depends_on_rate_behind_the_twins_hysteresis_is_named(twin, named):
    """The lag is named; the twin's narrow mode may be, and nothing else."""
    hysteresis, *behind = twin.chain
    assert hysteresis.name == "gpi"
    adds = {block.name for block in behind if depends_on_rate(block)}
    # A pole and a zero far above it are a lag to the search.
    pole, zero = pole_and_zero(twin)
    assert 0 < zero < 0.2 * pole
    assert adds == {"transfer-function", "resonance"}
    assert {"sensor-lag"} <= set(named) <= {"sensor-lag", "resonance"}


def test_the_lags_time_constant_is_that_of_the_pole_less_that_of_the_zero(twin, named):
    """A lag with the gain of both has ``sqrt(p^2 - z^2)`` at low frequencies.

    One with their phase has ``(p - z) / (1 + p z w^2)``. Where ``p w < 1``, as on all
    these records, both are off ``p - z`` by a share of about ``z / p`` at most.
    """
    pole, zero = pole_and_zero(twin)
    assert pole * 2 * np.pi * 120 < 1
    found = named["sensor-lag"]["time_constant_s"]["value"]
    assert found == pytest.approx(pole - zero, rel=zero / pole)


def test_the_resonance_lies_within_its_stated_error(twin, named):
    if "resonance" not in named:
        pytest.skip("the twin's narrow mode is not named on these records")
    (mode,) = (block for block in twin.chain if block.name == "resonance")
    found = named["resonance"]["frequency_hz"]
    assert abs(found["value"] - mode.frequency_hz) < 2 * found["standard_error"]
    # An error that is wide says nothing: half the width of the mode is the most.
    assert found["standard_error"] < mode.damping_ratio * mode.frequency_hz
    # Whether the mode adds to the motion or takes off.
    assert named["resonance"]["participation"]["value"] * mode.participation > 0

"""The device in mind: what it cannot have is not tried; causes are worded for it."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from hystbench.device_kinds import DEVICE_KINDS
from hystbench.gap.asked import Asked
from hystbench.gap.effects import effects
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.schema import SCHEMA
from hystbench.gap.stages import decide_in, show_in
from hystbench.gap.vocabulary import Vocabulary, in_words
from hystbench.interface.gap import find_gap
from hystbench.model import Model, load_model
from hystbench.schema import check_against_schema
from tests.gap.closing import close_gap
from tests.gap.conftest import without_rendering
from tests.gap.tiny import write_tiny

DT = 1e-3
SAMPLES = 1200
TAU = 0.05
NOISE = 0.01


def polarized(u):
    """A plain gain behind diffusion into a slab, by its transfer function."""
    padded = np.concatenate([u, np.zeros(4 * len(u))])
    q = np.sqrt(2j * np.pi * np.fft.rfftfreq(len(padded), DT)[1:] * TAU)
    shape = np.concatenate([[1.0], np.tanh(q) / q])
    return 3 * np.fft.irfft(shape * np.fft.rfft(padded), len(padded))[: len(u)]


def write_ceramic(folder, device=""):
    """Write records of voltage and polarization, and a base that is a plain gain."""
    rng = np.random.default_rng(3)
    time = DT * np.arange(SAMPLES)
    entries = []
    for name, hertz in {"a": 2.0, "b": 11.0, "c": 37.0, "held": 20.0}.items():
        u = np.sin(2 * np.pi * hertz * time) + 0.5 * rng.standard_normal(SAMPLES)
        y = polarized(u) + NOISE * rng.standard_normal(SAMPLES)
        rows = [f"{t:.9g},{v:.9g},{p:.9g}" for t, v, p in zip(time, u, y, strict=True)]
        head = "time_s,voltage_V,polarization"
        (folder / f"{name}.csv").write_text("\n".join([head, *rows]) + "\n")
        use = "hold-out" if name == "held" else "fit"
        entries.append(f"  - {{file: {name}.csv, use: {use}}}\n")
    (folder / "dataset.yaml").write_text(
        f"name: ceramic\n{device}time: {{column: time_s, unit: s}}\n"
        "input: {column: voltage_V, unit: V}\n"
        "output: {column: polarization, unit: uC/cm2}\n"
        f"noise_rms: {NOISE}\nrecords:\n" + "".join(entries)
    )
    base = {
        "name": "gain",
        "input": {"name": "voltage", "unit": "V"},
        "output": {"name": "polarization", "unit": "uC/cm2"},
        "chain": [{"gain": {"value": 3.0}}],
    }
    return folder, Model.from_mapping(base, "base")


@pytest.fixture(scope="module")
def ceramic(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ceramic")
    data, base = write_ceramic(folder, "device: {kind: piezoelectric}\n")
    said = []
    gap = find_gap(data, base, cache=False, say=said.append)
    with without_rendering():
        gap.save(folder / "out")
    return gap, folder / "out", said


def test_in_a_ceramic_eddy_currents_never_appear_in_words(ceramic):
    gap, out, said = ceramic
    (effect,) = gap.content["effects"]
    assert effect["name"] == "eddy-diffusion"
    assert effect["behaviour"] == "diffusion-like lag"
    assert effect["causes"] == ["relaxation of polarization", "the charge amplifier"]
    page = (out / "report.html").read_text(encoding="utf-8")
    # Commands name the block, as its user has to.
    shown = re.sub(r"<code>.*?</code>|base64,[^\"]*", "", page, flags=re.DOTALL)
    for text in (gap.sentence, repr(gap), gap.content["reason"], *said, shown):
        assert "eddy" not in text.lower()
    causes = "relaxation of polarization, or the charge amplifier"
    assert f"The simulator lacks diffusion-like lag ({causes})." in shown
    check_against_schema(json.loads((out / "gap.json").read_text()), SCHEMA, "gap.json")


def test_gap_json_tells_the_device(ceramic):
    assert ceramic[0].content["device"] == {
        "kind": "piezoelectric",
        "input": "voltage",
        "output": "none-known",
        "causality": "unknown",
    }


def test_without_a_kind_the_usual_causes_are_listed(tmp_path):
    data, base = write_ceramic(tmp_path)
    gap = find_gap(data, base, cache=False)
    (effect,) = gap.content["effects"]
    assert effect["behaviour"] == "diffusion-like lag"
    assert "eddy currents in the core or the housing" in effect["causes"]
    assert "relaxation of polarization" in effect["causes"]
    assert gap.content["device"]["kind"] is None


@pytest.fixture(scope="module")
def circuit(tmp_path_factory):
    """A device that can have neither friction nor backlash, and its gap."""
    folder = tmp_path_factory.mktemp("circuit")
    data, base = write_tiny(folder, more="device: {kind: electronic}\n")
    evidence, model = load_evidence(data), load_model(base)
    with without_rendering():
        close_gap(evidence, model, folder / "out")
    return evidence, model, folder / "out"


def tried(content):
    return {row["name"] for row in content["ranking"]}


#: Nothing moves in a circuit.
FORCES = {name for name, item in effects().items() if item.place == "inside"}


def test_what_a_device_cannot_have_is_not_tried_and_told(circuit):
    *_, out = circuit
    content = json.loads((out / "gap.json").read_text())
    assert not {"friction", "backlash"} & tried(content)
    assert set(content["asked"]["impossible"]) == {"friction", "backlash", *FORCES}
    assert content["asked"]["without"] == []
    assert "the device is electronic" in content["reason"]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Not in a device that is electronic:" in page


def test_as_two_jobs_it_is_the_same(circuit, tmp_path):
    evidence, model, out = circuit
    decide_in(tmp_path, evidence, model, Asked())
    show_in(tmp_path, evidence, model)
    one, two = (
        json.loads((folder / "gap.json").read_text()) for folder in (out, tmp_path)
    )
    for key in ("asked", "device", "effects", "reason"):
        assert one[key] == two[key]


def test_what_a_user_puts_in_stays_whatever_the_device():
    chosen = Vocabulary.of(["backlash"], ["friction"]).in_device("electronic")
    assert chosen.put_in == ("friction",)
    assert set(chosen.impossible) == FORCES
    assert "friction" not in chosen.offered


@pytest.mark.parametrize("kind", [*DEVICE_KINDS, None])
def test_what_is_impossible_is_not_offered(kind):
    chosen = Vocabulary.of().in_device(kind)
    assert not {*chosen.impossible} & {*chosen.offered}
    said = " ".join(chosen.words())
    # That a device without a store has no outflow goes without saying.
    stores = {"outflow", "overflow"}
    assert all((name in said) == (name not in stores) for name in chosen.impossible)


def test_whole_names_alone_are_worded():
    assert in_words("eddy-diffusion (slab)") == "diffusion-like lag (slab)"
    assert in_words("my-eddy-diffusion-rig") == "my-eddy-diffusion-rig"

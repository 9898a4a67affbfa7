"""Models that `hystbench gap` wrote, and others of blocks that it adds, as code.

Those in gap_models/ are what it wrote for the twin and for measured sets. The inputs
here are not the sets' own, but of their size and rate.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.export.described import describe, exact_delay
from hystbench.export.on_record import begun
from hystbench.model import Model, load_model
from tests.blocks.examples import EXAMPLES

from .compiled import Compiled
from .test_steps import chain_of, model_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

FOLDER = Path(__file__).with_name("gap_models")
#: Sampling interval in seconds, and the input's middle and amplitude.
WRITTEN = {
    "twin": (1e-4, 0.0, 0.632),
    "wiener-hammerstein": (1.95e-5, 0.0, 1.0),
    "mr-damper": (0.01, 0.0, 8.0),
    "piezo-rate": (0.0025, 0.0, 1400.0),
    "cascaded-tanks": (4.0, 3.0, 2.0),
    "emps": (0.004, 0.0, 60.0),
    "f16-ground-vibration": (0.0025, 0.0, 50.0),
}
SMOOTH = {"hold": "band-limited"}


def example(name, **more):
    return (name, EXAMPLES[name] | more)


NO_JOINT = EXAMPLES["structure"] | {"joint": [], "start": "settled"}
RESTING = {"gain": 40.0, "rate": 20.0, "start": "settled"}

#: Of blocks that the gap adds beside one another, with the hold that it writes.
OTHERS = {
    "creep over decades behind a half-space": (
        example("eddy-diffusion", geometry="half-space", **SMOOTH),
        example("gpi"),
        example("logarithmic-creep", **SMOOTH),
    ),
    "a lag and a force that remembers": (
        example("drive-lag", **SMOOTH),
        example("impedance"),
        example("hysteretic-force"),
        example("smooth-friction"),
    ),
    "modes beside friction, and a sensor": (
        example("mechanism", start="moving", **SMOOTH),
        example("friction-force"),
        example("slider-with-gap"),
        example("other-modes", start="moving", **SMOOTH),
        example("sensor-lag", **SMOOTH),
        example("sensor-nonlinearity"),
    ),
    "a joint that several modes move": (
        example("structure", output="acceleration", start="moving", **SMOOTH),
        example("iwan-force"),
        example("other-modes", start="moving", **SMOOTH),
    ),
    "modes without a joint": (
        ("structure", NO_JOINT),
        example("saturation"),
    ),
    "stores that spill": (
        example("store", gain=400.0, bias=100.0, output="outflow", **SMOOTH),
        example("store", gain=0.5, rate=20.0, exponent=0.5, height=2.0),
        example("sensor-lag", **SMOOTH),
    ),
    "stores that rest at first": (
        ("store", RESTING | {"bias": 30.0, "output": "outflow"} | SMOOTH),
        ("store", RESTING),
    ),
    "a free mass that has moved before": (
        example(
            "mechanism", stiffness=0.0, output="velocity", start="moving", **SMOOTH
        ),
        example("friction-force"),
    ),
    "a rate and a shape, then a mode": (
        example("gpi"),
        example("hysteresis-shape"),
        example("rate-dependent-hysteresis", form="acting-field", **SMOOTH),
        example("resonance", **SMOOTH),
        example("mains-pickup"),
    ),
}
MODELS = (*WRITTEN, *OTHERS)


def model_and_input(name) -> tuple[Model, float, np.ndarray]:
    """Give a model, the interval, and a smooth input that rises from where it rests."""
    if name in WRITTEN:
        model = load_model(FOLDER / f"{name}.yaml")
        dt, middle, size = WRITTEN[name]
    else:
        model = model_of(name, chain_of(*OTHERS[name]))
        dt, middle, size = 1e-4, 0.0, 0.5
    k = np.arange(1200)
    slow, fast = np.sin(2 * np.pi * k / 200), np.sin(2 * np.pi * k / 70)
    return model, dt, middle + size * (0.75 * slow + 0.25 * fast)


def code_of(model, dt, u, delay):
    """Make code as late as is asked, or as it gains by; none for that."""
    sampling = Sampling(dt, duration_s=(len(u) - 1) * dt)
    code = describe(model, sampling)
    most = exact_delay(code)
    late = most if delay is None else min(delay, most)
    if late:
        code = describe(model, replace(sampling, delay=late))
    if any(piece.step.past for piece in code.all_pieces()):
        code = begun(code, model, u)
    return code


LATE = (0, 2, None)


@pytest.fixture(scope="module", params=MODELS)
def off(request, tmp_path_factory):
    """How far code is off, as a share of the range, by how late it is.

    One program of C holds all that is made of a model.
    """
    model, dt, u = model_and_input(request.param)
    codes = {
        late: replace(code_of(model, dt, u, late), name=f"m{k}")
        for k, late in enumerate(LATE)
    }
    outputs = Compiled(list(codes.values()), tmp_path_factory.mktemp("c")).outputs(u)
    wanted, found = model.simulate(u, dt), {}
    assert np.isfinite(wanted).all()
    for late, code in codes.items():
        samples = code.sampling.delay
        away = outputs[code.name][samples:] - wanted[: len(u) - samples]
        found[late] = np.abs(away) / np.ptp(wanted)
    return found


def test_every_model_has_an_input():
    assert {path.stem for path in FOLDER.glob("*.yaml")} == set(WRITTEN)


def test_late_enough_code_is_the_simulation(off):
    assert off[None].max() <= 1e-9


#: Where the code takes a curve through signals with corners: behind play operators, or
#: behind friction, a store that spills, or a force against a clearance; and where it
#: leaves out the low-pass filter behind the forces of a motion, and says so.
CORNERS = 1e-3


#: Not the beginning of a record: forces remember a rate that was not known there.
BEGUN = slice(40, None)


def test_less_late_it_is_near(off):
    assert off[2][BEGUN].max() <= CORNERS
    rms = [float(np.sqrt(np.mean(off[late][BEGUN] ** 2))) for late in LATE]
    assert rms[2] <= 1e-9
    assert rms[0] <= 1e-7 or rms[1] < 1.01 * rms[0]

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
from hystbench.export.compared import in_straight_lines
from hystbench.export.described import describe
from hystbench.export.past import begun
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
    "stores that spill": (
        example("store", gain=400.0, bias=100.0, output="outflow", **SMOOTH),
        example("store", gain=0.5, rate=20.0, exponent=0.5, height=2.0),
        example("sensor-lag", **SMOOTH),
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
    sampling = Sampling(dt, duration_s=(len(u) - 1) * dt)
    code = describe(model, sampling)
    if delay and any(piece.step.forward for piece in code.pieces):
        code = describe(model, replace(sampling, delay=delay))
    if any(piece.step.past for piece in code.all_pieces()):
        code = begun(code, model, u)
    return code


#: In straight lines four samples late, so that rates and curvatures are known from the
#: first on; and as it stands, by how many samples it is late.
STRAIGHT, LATE = "straight", (0, 2, 15)


@pytest.fixture(scope="module", params=MODELS)
def off(request, tmp_path_factory):
    """How far code is off, as a share of the range, by what it is made of.

    One program of C holds all that is made of a model.
    """
    model, dt, u = model_and_input(request.param)
    models = {STRAIGHT: in_straight_lines(model), **dict.fromkeys(LATE, model)}
    codes = {
        key: replace(code_of(item, dt, u, 4 if key == STRAIGHT else key), name=f"m{k}")
        for k, (key, item) in enumerate(models.items())
    }
    program = Compiled(list(codes.values()), tmp_path_factory.mktemp("c"))
    outputs = program.outputs(u)
    found = {"filtered": any("low-pass" in told for told in codes[0].differences)}
    for key, code in codes.items():
        late, wanted = code.sampling.delay, models[key].simulate(u, dt)
        assert np.isfinite(wanted).all()
        away = outputs[code.name][late:] - wanted[: len(u) - late]
        found[key] = np.abs(away) / np.ptp(wanted)
    return found


def test_every_model_has_an_input():
    assert {path.stem for path in FOLDER.glob("*.yaml")} == set(WRITTEN)


def test_in_straight_lines_code_is_the_simulation(off):
    assert off[STRAIGHT].max() <= 1e-9


#: Where the code takes a curve through signals with corners: behind play operators, or
#: behind friction, a store that spills, or a force against a clearance.
CORNERS = 2e-4
#: Where it leaves out the low-pass filter behind the forces of a motion, and says so:
#: no sample to come mends that.
UNFILTERED = 1e-3
#: Not the ends of a record: there the curve through all its samples turns.
INNER = slice(40, -40)


def test_late_by_more_samples_it_is_nearer_the_simulation_as_it_stands(off):
    rms = {late: float(np.sqrt(np.mean(off[late][INNER] ** 2))) for late in LATE}
    for late in LATE[1:]:
        assert off[late][INNER].max() <= (UNFILTERED if off["filtered"] else CORNERS)
    nearer = rms[15] <= 1e-7 or rms[15] < rms[2] < rms[0]
    assert nearer or off["filtered"]

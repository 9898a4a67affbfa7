"""A new user's mass on a spring with dry friction, simulated in three ways."""

import numpy as np
import pytest

from hystbench.gap.asked import Asked
from hystbench.gap.bases.load import load_base
from hystbench.gap.run import closed_gap
from hystbench.record import Channel, Record
from tests.gap.made import evidence_of
from tests.gap.searched import among

DT, COUNT, NOISE = 2e-3, 400, 5e-6
MASS, DAMPING, SPRING = 0.4, 8.0, 2500.0  # kg, N s/m, N/m: 12.6 Hz, damped by .13
COULOMB = 1.5
LIKELY = among("friction", "drag", "input-delay", "sensor-lag")
"""What dry friction beside a simulator's own error may be taken for."""

MODEL = f"""
name: oscillator
input: {{name: force, unit: N}}
output: {{name: position, unit: m}}
chain:
  - transfer-function: {{numerator: [1.0], denominator: [{MASS}, {DAMPING}, {SPRING}]}}
"""
FUNCTIONS = f"""
import numpy as np
from scipy.signal import cont2discrete, lfilter

def runge_kutta(u, dt):
    "Classical, one step a sample, the force straight between samples."
    def slope(x, v, force):
        return v, (force - {DAMPING} * v - {SPRING} * x) / {MASS}
    x, v, y = 0.0, 0.0, [0.0]
    for now, then in zip(u[:-1].tolist(), u[1:].tolist()):
        half = (now + then) / 2
        a = slope(x, v, now)
        b = slope(x + dt / 2 * a[0], v + dt / 2 * a[1], half)
        c = slope(x + dt / 2 * b[0], v + dt / 2 * b[1], half)
        d = slope(x + dt * c[0], v + dt * c[1], then)
        x += dt / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        v += dt / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
        y.append(x)
    return np.array(y)

def discretised(u, dt):
    "Tustin's rule."
    law = ([1.0], [{MASS}, {DAMPING}, {SPRING}])
    top, bottom, _ = cont2discrete(law, dt, "bilinear")
    return lfilter(top.ravel(), bottom, u)
"""


def with_friction(u):
    """The device by short steps: dry friction holds where it can, else it brakes."""
    fine = 40
    force = np.interp(np.arange(fine * (COUNT - 1) + 1) / fine, np.arange(COUNT), u)
    step, x, v, y = DT / fine, 0.0, 0.0, []
    for k, now in enumerate(force.tolist()):
        if k % fine == 0:
            y.append(x)
        free = v + step * (now - DAMPING * v - SPRING * x) / MASS
        v = np.sign(free) * max(abs(free) - step * COULOMB / MASS, 0.0)
        x += step * v
    return np.array(y)


def measured():
    time, found = np.arange(COUNT) * DT, []
    rng = np.random.default_rng(7)
    for k, use in enumerate(["fit", "fit", "hold-out"]):
        lines = zip(rng.uniform(1, 20, 5), rng.uniform(0, 6, 5), strict=True)
        u = sum(2.5 * np.sin(2 * np.pi * f * time + p) for f, p in lines)
        u *= np.clip(time / 0.05, 0, 1)
        y = with_friction(u) + NOISE * rng.standard_normal(COUNT)
        about = Channel("force", "N"), Channel("position", "m"), "twin", use
        found.append(Record(f"run-{k}", DT, u, y, *about))
    return evidence_of("oscillator", found, "linear", NOISE, "force", "position")


@pytest.fixture(scope="module")
def evidence():
    return measured()


@pytest.mark.parametrize("simulator", ["model", "runge_kutta", "discretised"])
def test_dry_friction_is_named_whatever_simulates_the_oscillator(
    simulator, evidence, tmp_path, monkeypatch
):
    (tmp_path / "model.yaml").write_text(MODEL)
    (tmp_path / "of_a_new_user.py").write_text(FUNCTIONS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    function = f"of_a_new_user:{simulator}"
    base, _ = load_base("model.yaml" if simulator == "model" else function, evidence)
    content = closed_gap(evidence, base, Asked(vocabulary=LIKELY)).outcome.content
    (effect,) = content["effects"]
    assert (content["verdict"], effect["name"]) == ("named", "friction")
    assert effect["place"] == "inside"
    # Dahl's law that yields at once is dry friction: its largest force is Coulomb's.
    numbers = effect["parameters"]
    number = numbers.get("coulomb") or numbers["largest"]
    assert number["value"] == pytest.approx(COULOMB, rel=0.05)
    assert content["gap"]["after"] < 3 * NOISE

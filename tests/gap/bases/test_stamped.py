"""Records of a device whose input is stamped off by a sample, and whose sensor drifts.

An oscillator with a cubic spring, by Runge and Kutta's rule on a finer grid, apart from
the blocks. Its true numbers are told: two poles, no zero.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from hystbench.gap.asked import Asked
from hystbench.gap.bases.linear import identified_linear
from hystbench.gap.bases.load import load_base
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.run import closed_gap
from hystbench.quantities import Quantities
from hystbench.record import Channel, Record
from tests.gap.searched import among

DT, COUNT, FINE = 0.01, 1000, 8
HERTZ, DAMPING, CUBIC, NOISE = 6.0, 0.08, 0.5, 0.002
LEVELS = (0.15, 0.3, 0.4, 0.2, 0.35, 0.25)
ZEROS = (0.3, -0.5, 0.15, 0.6, -0.35, 0.45)


def forces():
    """Multisines that begin gently, twice as fine as the steps, shape (6, n)."""
    rng = np.random.default_rng(5)
    frequency = np.fft.rfftfreq(COUNT, DT)
    there = np.flatnonzero((frequency > 0.3) & (frequency < 12))
    lines = np.zeros((len(LEVELS), COUNT * FINE // 2 + 1), dtype=complex)
    phases = 2 * np.pi * rng.random((len(LEVELS), len(there)))
    lines[:, there] = np.exp(1j * phases)
    fine = np.fft.irfft(lines, COUNT * FINE)
    begun = np.clip(np.arange(COUNT * FINE) / (0.05 * COUNT * FINE), 0, 1)
    return fine * (np.array(LEVELS) / fine.std(axis=1))[:, None] * begun**2


@cache
def moved(cubic):
    """Positions of masses at rest at first, that the forces drive."""
    force = forces()
    speed = 2 * np.pi * HERTZ
    step = 2 * DT / FINE
    fine = np.column_stack([force, force[:, -1]])

    def rate(x, f):
        spring = x[0] + cubic * x[0] ** 3
        return np.array([x[1], speed**2 * (f - spring) - 2 * DAMPING * speed * x[1]])

    x, out = np.zeros((2, len(force))), []
    for k in range(0, force.shape[1], 2):
        out.append(x[0])
        a = rate(x, fine[:, k])
        b = rate(x + step / 2 * a, fine[:, k + 1])
        c = rate(x + step / 2 * b, fine[:, k + 1])
        d = rate(x + step * c, fine[:, k + 2])
        x = x + step / 6 * (a + 2 * b + 2 * c + d)
    return np.array(out)[:: FINE // 2].T


def evidence(late=1.0, zeros=ZEROS, cubic=CUBIC):
    """Four records to fit and two held out; the input written down so much late."""
    rng, force = np.random.default_rng(6), forces()
    at = np.arange(COUNT) * FINE - round(late * FINE)
    at = np.clip(at, 0, COUNT * FINE - 1)
    u, y = force[:, at], moved(cubic)
    y = y + np.array(zeros)[:, None] + NOISE * rng.standard_normal(y.shape)
    channels = Channel("force", "N"), Channel("position", "mm")
    records = [
        Record(f"r{k}", DT, u[k], y[k], *channels, "measured", use)
        for k, use in enumerate(["fit"] * 4 + ["hold-out"] * 2)
    ]
    kinds = Quantities("force", "position")
    return Evidence("made", (*records[:4],), (*records[4:],), quantities=kinds)


def first_halves(about):
    """Cut a search short: the first half of two records, and of one held out."""

    def half(record):
        return replace(record, u=record.u[: COUNT // 2], y=record.y[: COUNT // 2])

    return replace(
        about, fit=(*map(half, about.fit[:2]),), hold_out=(half(about.hold_out[0]),)
    )


def lead(model):
    """Samples by which a base takes its input early."""
    found = [x for x in model.chain if x.name == "input-delay"]
    return sum(x.lead_s - x.delay_s for x in found) / DT


@pytest.mark.parametrize("late", [-1.0, 0.0, 0.5, 1.0])
def test_a_base_has_its_poles_no_zero_and_the_timing_of_its_input(late):
    found = identified_linear(evidence(late))
    (block,) = [x for x in found.model.chain if x.name == "transfer-function"]
    assert (len(block.numerator), len(block.denominator)) == (1, 3)
    assert lead(found.model) == pytest.approx(late)


def test_offsets_of_records_are_no_error_of_a_linear_device():
    """What it leaves is the noise, and its offset the mean of the records'."""
    found = identified_linear(evidence(0.0, cubic=0.0))
    assert found.fit_rms == pytest.approx(NOISE, rel=0.1)
    assert found.fold_rms == pytest.approx(NOISE, rel=0.1)
    assert found.model.chain[-1].offset == pytest.approx(np.mean(ZEROS[:4]), abs=1e-3)


def test_a_level_has_its_zero():
    """Of a store an empty one is at zero: its records have no offset of their own."""
    kinds = Quantities("voltage", "level")
    about = evidence(0.0, cubic=0.0)
    about = Evidence("made", about.fit, about.hold_out, quantities=kinds)
    assert identified_linear(about).fit_rms > np.std(ZEROS[:4]) / 2


def test_the_spring_is_named_beside_both():
    """Held against a curve before the mass and another timing."""
    about = first_halves(evidence())
    base, _ = load_base("linear", about)
    known = among("stiffness-hardening", "asymmetry", "input-delay")
    found = closed_gap(about, base, Asked(vocabulary=known)).outcome.content
    assert [item["name"] for item in found["effects"]] == ["stiffness-hardening"]
    assert found["verdict"] == "named"
    assert found["record_values"]["kinds"] == ["offset"]
    told = {x["name"]: x["offset"] for x in found["record_values"]["records"]}
    apart = [told.get(f"r{k}", 0.0) for k in range(2)]
    wanted = np.array(ZEROS[:2])
    np.testing.assert_allclose(
        apart - np.mean(apart), wanted - wanted.mean(), atol=0.01
    )
    # Between samples the force is a curve to the device, and lines to the model.
    assert found["gap"]["after"] < 4 * NOISE

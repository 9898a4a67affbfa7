"""Algorithm 1 by variable projection, beside searches over all 39 parameters.

All methods see the same slow record of the twin and have ten starts (the swarm of
differential evolution is its own). Parameters: the eight of the envelopes and 31
weights, none negative.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np
from scipy.optimize import differential_evolution, least_squares

import hystbench
from benchmarks.timing import write_table
from benchmarks.work import ORDER
from hystbench.envelope import Envelope, thresholds
from hystbench.errors import InputError
from hystbench.identification import identify
from hystbench.identification.shape import envelope_of, random_point
from hystbench.measurement import measure
from hystbench.model import load_model
from hystbench.operators import generalized_prandtl_ishlinskii
from hystbench.record import FloatArray, Record
from hystbench.schema import load_yaml
from hystbench.signals import make_signal

COLUMNS = (
    *("method", "starts", "seconds", "relative_error", "evaluations"),
    *("seconds_over_ours", "error_over_ours"),
)
STARTS = 10
SEED = 1
#: Evaluations that least squares may take in each start, and the time (s) of
#: differential evolution: both went on to fall by little beyond them.
EVALUATIONS = 200
EVOLUTION_SECONDS = 60.0
LOW = np.array([-3.0, 0.05, -3.0, -3.0] * 2 + [0.0] * (ORDER + 1))
HIGH = np.array([3.0, 5.0, 3.0, 3.0] * 2 + [50.0] * (ORDER + 1))


class OutOfTimeError(Exception):
    """Differential evolution has had its time."""


class Fit:
    """Error of Eq. 9 over all 39 parameters; it keeps the best it has seen."""

    def __init__(self, slow: Record) -> None:
        self._slow = slow
        self._amplitude = float(np.abs(slow.u).max())
        self.evaluations, self.best = 0, np.inf

    def error(self, point: FloatArray) -> FloatArray:
        """Output less the measured one, shape (n,)."""
        self.evaluations += 1
        envelope = Envelope(*map(float, point[:8]))
        u, y = self._slow.u, self._slow.y
        try:
            r = thresholds(envelope, self._amplitude, ORDER)
        except InputError:  # envelopes that allow no thresholds: as bad as no model
            return -y
        sides = envelope.left(u), envelope.right(u)
        model, _ = generalized_prandtl_ishlinskii(*sides, r, point[8:])
        self.best = min(self.best, float(np.linalg.norm(model - y) / np.linalg.norm(y)))
        return model - y


def main() -> None:
    """Write identification.csv."""
    slow = slow_record()
    ours = variable_projection(slow)
    others = [run(slow) for run in (all_least_squares, evolution)]
    rows = [(*each, each[2] / ours[2], each[3] / ours[3]) for each in [ours, *others]]
    write_table("identification.csv", COLUMNS, rows)


def slow_record() -> Record:
    """The record of Algorithm 1 in the reproduction: 1 Hz on the twin."""
    config = load_yaml("config.yaml")
    name = config["identification"]["signal"]
    signal = make_signal(name, config["excitations"][name], config["excitation"])
    plant = (
        Path(hystbench.__file__).parent / "plants" / f"{config['twin']['model']}.yaml"
    )
    return measure(signal, load_model(plant), config["twin"], str(plant))


def timed(work: Callable[[], object]) -> float:
    """Seconds that the work takes."""
    start = perf_counter()
    work()
    return perf_counter() - start


def variable_projection(slow: Record) -> tuple[str, int, float, float, int]:
    """Ours, with an epsilon of its own that it cannot reach: it runs to the end."""
    start = perf_counter()
    found = identify(slow.u, slow.y, ORDER, starts=STARTS, seed=SEED, epsilon=0.0)
    seconds = perf_counter() - start
    iterations = len(found.cost_history)
    return "variable projection", STARTS, seconds, found.relative_error, iterations


def all_least_squares(slow: Record) -> tuple[str, int, float, float, int]:
    """Bounded least squares over all parameters, from random envelopes."""
    fit, random = Fit(slow), np.random.default_rng(SEED)
    span = float(slow.u.min()), float(slow.u.max())

    def search() -> None:
        for _ in range(STARTS):
            envelope = envelope_of(random_point(random), *span)
            weights = random.uniform(0, 2, ORDER + 1)
            point = np.concatenate((list(envelope.to_dict().values()), weights))
            inside = np.clip(point, LOW + 1e-6, HIGH - 1e-6)
            least_squares(fit.error, inside, bounds=(LOW, HIGH), max_nfev=EVALUATIONS)

    seconds = timed(search)
    return "least squares, 39 parameters", STARTS, seconds, fit.best, fit.evaluations


def evolution(slow: Record) -> tuple[str, int, float, float, int]:
    """Differential evolution over all parameters, for a minute."""
    fit, start = Fit(slow), perf_counter()

    def cost(point: FloatArray) -> float:
        if perf_counter() - start > EVOLUTION_SECONDS:
            raise OutOfTimeError
        error = fit.error(point)
        return float(error @ error)

    def search() -> None:
        bounds = list(zip(LOW, HIGH, strict=True))
        try:
            differential_evolution(cost, bounds, rng=SEED, polish=False)
        except OutOfTimeError:
            print(f"differential evolution: ended after {EVOLUTION_SECONDS:g} s")

    seconds = timed(search)
    name = "differential evolution, 39 parameters"
    return name, 1, seconds, fit.best, fit.evaluations

"""Algorithm 1 by variable projection, beside searches over all 39 parameters.

All methods have the same slow record of the twin and ten starts: a plain pair of
envelopes and nine random ones (the swarm of differential evolution is its own).
Parameters: the eight of the envelopes and 31 weights, none negative. Ours searches on
the record thinned and goes down the last bit on all of it; so may the others,
``thinned as ours``, with the same samples. Where each ends is scored on the whole
record.
"""

from __future__ import annotations

import itertools
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
from hystbench.identification.algorithm import SEARCH_SAMPLES
from hystbench.identification.shape import envelope_of, plain_point, random_point
from hystbench.identification.weights import reduced
from hystbench.model import load_model
from hystbench.operators import generalized_prandtl_ishlinskii
from hystbench.record import FloatArray, Record
from hystbench.signals import make_signal
from hystbench.twin_record import record_of_twin
from hystbench.yaml_files import load_yaml

COLUMNS = (
    *("method", "starts", "seconds", "relative_error", "evaluations"),
    *("seconds_over_ours", "error_over_ours"),
)
STARTS = 10
SEED = 1
#: Evaluations that least squares may take in each start and, where that was on the
#: thinned record, from its best point on the whole one; they went on to fall by little
#: beyond them. And how many times our time differential evolution has.
EVALUATIONS, LAST_EVALUATIONS = 200, 40
EVOLUTION_TIMES = 101.0
LOW = np.array([-3.0, 0.05, -3.0, -3.0] * 2 + [0.0] * (ORDER + 1))
HIGH = np.array([3.0, 5.0, 3.0, 3.0] * 2 + [50.0] * (ORDER + 1))


class OutOfTimeError(Exception):
    """Differential evolution has had its time."""


class Fit:
    """Error of Eq. 9 over all 39 parameters; it keeps the best point it has seen.

    Parameters
    ----------
    slow : Record
    samples : int, optional
        Samples of the record thinned as ours thins it; all by default.
    """

    def __init__(self, slow: Record, samples: int | None = None) -> None:
        self._whole = slow.u, slow.y
        self._seen = reduced(slow.u, slow.y, samples or len(slow.u))
        self._amplitude = float(np.abs(slow.u).max())
        self._least = np.inf
        self.evaluations, self.best = 0, np.concatenate((LOW[:8], np.zeros(ORDER + 1)))

    def error(self, point: FloatArray) -> FloatArray:
        """Output less the measured one on the samples seen, shape (n,)."""
        self.evaluations += 1
        error = self._error(point, *self._seen)
        if error @ error < self._least:
            self._least, self.best = float(error @ error), point.copy()
        return error

    def relative_error(self) -> float:
        """Relative error of the best point on the whole record."""
        error, (_, y) = self._error(self.best, *self._whole), self._whole
        return float(np.linalg.norm(error) / np.linalg.norm(y))

    def _error(self, point: FloatArray, u: FloatArray, y: FloatArray) -> FloatArray:
        envelope = Envelope(*map(float, point[:8]))
        try:
            r = thresholds(envelope, self._amplitude, ORDER)
        except InputError:  # envelopes that allow no thresholds: as bad as no model
            return -y
        sides = envelope.left(u), envelope.right(u)
        model = generalized_prandtl_ishlinskii(*sides, r, point[8:])
        return model - y


def main() -> None:
    """Write identification.csv."""
    slow = slow_record()
    ours = variable_projection(slow)
    others = [
        all_least_squares(slow),
        thinned_least_squares(slow),
        evolution(slow, EVOLUTION_TIMES * ours[2]),
    ]
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
    return record_of_twin(signal, load_model(plant), config["twin"], str(plant))


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
    fit = Fit(slow)
    seconds = timed(lambda: from_random_points(fit, slow))
    name = "least squares, 39 parameters"
    return name, STARTS, seconds, fit.relative_error(), fit.evaluations


def thinned_least_squares(slow: Record) -> tuple[str, int, float, float, int]:
    """Find the same on the thinned record, and from the best point down on all of it.

    As ours: its last steps are on the whole record too.
    """
    thinned, whole = Fit(slow, SEARCH_SAMPLES), Fit(slow)

    def search() -> None:
        from_random_points(thinned, slow)
        descend(whole, thinned.best, LAST_EVALUATIONS)

    seconds = timed(search)
    evaluations = thinned.evaluations + whole.evaluations
    name = "least squares, 39 parameters, thinned as ours"
    return name, STARTS, seconds, whole.relative_error(), evaluations


def from_random_points(fit: Fit, slow: Record) -> None:
    """Go down from ten points: plain envelopes, as ours begins, and random ones."""
    random = np.random.default_rng(SEED)
    span = float(slow.u.min()), float(slow.u.max())
    for number in range(STARTS):
        envelope = envelope_of(random_point(random) if number else plain_point(), *span)
        weights = random.uniform(0, 2, ORDER + 1)
        point = np.concatenate((list(envelope.to_dict().values()), weights))
        descend(fit, point, EVALUATIONS)


def descend(fit: Fit, point: FloatArray, evaluations: int) -> None:
    """Bounded least squares from a point."""
    inside = np.clip(point, LOW + 1e-6, HIGH - 1e-6)
    least_squares(fit.error, inside, bounds=(LOW, HIGH), max_nfev=evaluations)


def evolution(slow: Record, limit: float) -> tuple[str, int, float, float, int]:
    """Differential evolution over all parameters on the thinned record, for a time.

    On the whole record it would see a small part of so many points in that time.
    """
    fit, start = Fit(slow, SEARCH_SAMPLES), perf_counter()
    begun: list[int] = []

    def cost(point: FloatArray) -> float:
        if perf_counter() - start > limit:
            raise OutOfTimeError
        error = fit.error(point)
        return float(error @ error)

    def search() -> None:
        bounds = list(zip(LOW, HIGH, strict=True))
        try:
            # Where a population has come together, another one begins.
            for seed in itertools.count(SEED):
                begun.append(seed)
                differential_evolution(cost, bounds, rng=seed, polish=False)
        except OutOfTimeError:
            print(f"differential evolution: ended after {limit:.0f} s")

    seconds = timed(search)
    name = "differential evolution, 39 parameters, thinned as ours"
    return name, len(begun), seconds, fit.relative_error(), fit.evaluations

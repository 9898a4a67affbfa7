"""Fit of the RDGPI model to records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hystbench.bounded_least_squares import minimize
from hystbench.errors import InputError
from hystbench.metrics import relative_error
from hystbench.rdgpi.model import STARTS, Path, RateDependentGPI, Start, input_rate
from hystbench.record import FloatArray, Record


@dataclass(frozen=True)
class RateDependentFit:
    """A model fitted to records, and how well it fits them."""

    model: RateDependentGPI
    """The fitted model."""
    relative_error: dict[str, float]
    """RE of the free-run output by record, over the whole record."""
    starts: int
    """Starting points that were tried."""


#: Largest step of the input between samples of a fit, as a share of its range, and
#: the most samples of a record that are used.
LARGEST_STEP, MOST_SAMPLES = 0.04, 600

# log alpha1, log(beta1 - 1), log lambda1, tau, envelope_offset, log lambda2, with
# the largest magnitude of the input and the largest rate as units
_LOWER = np.array([np.log(1e-3), np.log(1e-4), np.log(1e-3), -10.0, -2.0, np.log(1e-2)])
_UPPER = np.array([np.log(5.0), np.log(10.0), np.log(1e3), 30.0, 2.0, np.log(1e3)])
_FIRST = np.array([np.log(0.5), np.log(0.05), np.log(0.1), 3.0, 0.0, 0.0])


def identify_rdgpi(
    records: Sequence[Record], order: int = 30, *, starts: int = 4, seed: int = 0
) -> RateDependentFit:
    """Fit the model to records by least squares of its free-run output.

    The mean squared errors of the records are summed. The data cannot tell
    ``envelope_gain`` from the scale of all else, ``c`` from ``alpha1``, nor
    ``beta2`` from ``rho``; those three are set to 1. ``rho`` and ``alpha2`` enter
    linearly and are solved for at each step, so the search is over six parameters,
    from several starting points, within bounds. Before the first sample the operators
    are at rest or settled, whichever fits better from the plain starting point.

    The fit uses every so many samples, with steps of the input below 4 % of its
    range, and the first 600 of those; the relative errors are over whole records.

    Parameters
    ----------
    records : sequence of Record
        Records to fit, such as the paper's sines of 10 to 100 Hz.
    order : int
        Order N.
    starts : int
        Starting points: a plain one, then random ones.
    seed : int
        Seed of the random ones.

    Returns
    -------
    RateDependentFit
        The best model.

    Raises
    ------
    InputError
        If there is no record, an input is constant or an output not finite.
    """
    if not records or starts < 1:
        raise InputError("rdgpi: expected one record or more, one start or more")
    for record in records:
        if np.ptp(record.u) == 0:
            raise InputError(f"rdgpi: record {record.name}: the input is constant")
        if not np.isfinite(record.y).all():
            raise InputError(f"rdgpi: record {record.name}: the output is not finite")
    random = np.random.default_rng(seed)
    points = [_FIRST]
    while len(points) < starts:
        drawn = _FIRST + random.normal(0.0, [1.5, 1.5, 2.0, 2.0, 0.2, 1.5])
        points.append(np.clip(drawn, _LOWER, _UPPER))
    kinds = STARTS
    tried: list[tuple[float, RateDependentGPI]] = []
    for point in points:
        for kind in kinds:
            fit = _ThinnedRecords.of(records, order, kind)
            # steep weights can overflow: such a point has no finite cost
            with np.errstate(over="ignore", invalid="ignore"):
                best, cost = minimize(fit.error, point, _LOWER, _UPPER)
            if np.isfinite(cost):
                tried.append((cost, fit.model(best)))
        if not tried:
            raise InputError("rdgpi: the outputs overflow from the plain start")
        model = min(tried, key=lambda pair: pair[0])[1]
        kinds = (model.start,)
    errors = {}
    for record in records:
        error = model.simulate(record.u, record.dt) - record.y
        errors[record.name] = relative_error(error, record.y)
    return RateDependentFit(model, errors, starts)


@dataclass(frozen=True)
class _ThinnedRecords:
    """Thinned records one after another, with the largest input and rate as units."""

    order: int
    start: Start
    largest: float
    fastest: float
    path: Path
    lead: Path
    parts: tuple[slice, ...]
    weight: FloatArray
    target: FloatArray

    @classmethod
    def of(cls, records: Sequence[Record], order: int, start: Start) -> _ThinnedRecords:
        """Thin records and find the units."""
        paths, leads, outputs = [], [], []
        for record in records:
            step = LARGEST_STEP * np.ptp(record.u) / np.max(np.abs(np.diff(record.u)))
            stride = max(1, min(int(step), len(record) // MOST_SAMPLES))
            keep = slice(0, None, stride)
            u, rate = record.u[keep], input_rate(record.u, record.dt)[keep]
            first, last = slice(0, MOST_SAMPLES), slice(-MOST_SAMPLES, None)
            paths.append((u[first], rate[first]))
            leads.append((u[last], rate[last]))
            outputs.append(record.y[keep][first])
        lengths = np.array([len(y) for y in outputs])
        ends = np.cumsum(lengths)
        path = Path(*map(np.concatenate, zip(*paths, strict=True)))
        weight = np.repeat(1 / np.sqrt(lengths), lengths)
        return cls(
            order=order,
            start=start,
            largest=max(float(np.max(np.abs(record.u))) for record in records),
            fastest=float(path.rate.max()),
            path=path,
            lead=Path(*map(np.concatenate, zip(*leads, strict=True))),
            parts=tuple(map(slice, ends - lengths, ends)),
            weight=weight,
            target=np.concatenate(outputs) * weight,
        )

    def model(self, point: FloatArray) -> RateDependentGPI:
        """Build the model at a point, with the rho and alpha2 that fit best."""
        plain, design = self._linear(point)
        first, second = _least_squares(design, self.target)
        return replace(plain, rho=first, alpha2=-second / first if first else 0.0)

    def error(self, point: FloatArray) -> FloatArray:
        """Error of all samples, scaled to add up to the sum of mean squares."""
        _, design = self._linear(point)
        return design @ _least_squares(design, self.target) - self.target

    def _linear(self, point: FloatArray) -> tuple[RateDependentGPI, FloatArray]:
        """Columns that rho and -rho alpha2 multiply to give the target."""
        alpha1, beta1, lambda1 = np.exp(point[:3])
        plain = RateDependentGPI(
            alpha1=float(alpha1 * self.largest),
            beta1=float(1 + beta1),
            lambda1=float(lambda1 / self.fastest),
            alpha2=0.0,
            beta2=1.0,
            lambda2=float(np.exp(point[5]) / self.fastest),
            c=1.0,
            rho=1.0,
            tau=float(point[3] / self.largest),
            envelope_gain=1.0,
            envelope_offset=float(point[4] * self.largest),
            order=self.order,
            start=self.start,
        )
        output = plain.respond(self.path, self.lead, self.parts) * self.weight
        loss = np.log(1 + plain.lambda2 * self.path.rate)
        return plain, np.stack([output, output * loss]).T


def _least_squares(design: FloatArray, target: FloatArray) -> tuple[float, float]:
    """Solve for two unknowns; nearly parallel columns share what they explain."""
    size = np.maximum(np.linalg.norm(design, axis=0), np.finfo(np.float64).tiny)
    columns = design / size
    normal = columns.T @ columns + 1e-12 * np.eye(2)
    first, second = np.linalg.solve(normal, columns.T @ target) / size
    return float(first), float(second)

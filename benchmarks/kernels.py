"""Each kernel beside its peers, on the same record with the same step size.

``same_result``: outputs and final weights within 1e-9, relative, of the plain float64
NumPy loops, for ours and for the peer alike. The step size is half of Eq. 19's bound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import adaptfilt
import numpy as np
import padasip
import pydaptivefiltering

from benchmarks import loops, reference
from benchmarks.compiled import BUILDS, CReference
from benchmarks.reference import Adapted
from benchmarks.timing import interleaved, least_and_median, write_table
from benchmarks.work import AMPLITUDE, ORDER, adaptive, record
from hystbench.envelope import PUBLISHED_ENVELOPE, thresholds
from hystbench.filters import AdaptiveFilter
from hystbench.operators import (
    generalized_prandtl_ishlinskii,
    rate_dependent_prandtl_ishlinskii,
)
from hystbench.record import FloatArray

COLUMNS = (
    "kernel",
    "peer",
    "samples",
    "ns_per_sample",
    "peer_ns_per_sample",
    "ratio",
    "same_result",
    "median_ratio",
    "repeats",
)
SHORT, LONG = 20_000, 1_000_000
FRACTION = 0.5  # of Eq. 19's bound
TURN = 0.02  # seconds that each candidate is called for on end, as timeit does
PLAIN = "NumPy loop"

Candidate = Callable[[], Adapted]


@dataclass(frozen=True)
class Contest:
    """Ours and its peers on one record; the NumPy loop is among the peers."""

    kernel: str
    samples: int
    ours: Candidate
    peers: dict[str, Candidate]
    repeats: int


def main() -> None:
    """Write kernels.csv."""
    short, long = record(SHORT), record(LONG)
    contests = [
        lms(*short, repeats=7),
        lms(*long, repeats=3),
        plays("backlash", *short),
        plays("gpo", *short),
        volterra(*short),
        simulation(short[0]),
        rate_dependent_simulation(short[0]),
    ]
    write_table("kernels.csv", COLUMNS, [row for each in contests for row in run(each)])


def run(contest: Contest) -> list[tuple[object, ...]]:
    """Measure a contest: a row for each peer."""
    candidates = {"ours": contest.ours, **contest.peers}
    found = {name: candidate() for name, candidate in candidates.items()}
    plain = found[PLAIN]
    same = {name: reference.equal(each, plain) for name, each in found.items()}
    del found
    seconds = interleaved(candidates, contest.repeats, TURN)
    scale = 1e9 / contest.samples
    least, median = least_and_median(seconds["ours"])
    rows = []
    for peer in contest.peers:
        peer_least, peer_median = least_and_median(seconds[peer])
        rows.append(
            (
                *(contest.kernel, peer, contest.samples),
                *(least * scale, peer_least * scale, peer_least / least),
                same["ours"] and same[peer],
                *(peer_median / median, contest.repeats),
            )
        )
    return rows


def lms(x: FloatArray, d: FloatArray, repeats: int) -> Contest:
    """LMS with 31 taps: the delayed filter."""
    ours = adaptive("delayed", x, FRACTION)
    mu, taps, zeros = ours.step_size, ORDER + 1, np.zeros(ORDER)

    def with_padasip() -> Adapted:
        line = np.concatenate((zeros, x))
        rows = np.lib.stride_tricks.sliding_window_view(line, taps)[:, ::-1]
        other = padasip.filters.FilterLMS(n=taps, mu=2 * mu, w="zeros")
        y, _, _ = other.run(d, rows)
        return Adapted(y, other.w)

    def with_adaptfilt() -> Adapted:
        # Its outputs are a posteriori; the a priori ones follow from its errors.
        given = np.concatenate((zeros, x)), np.concatenate((zeros, d))
        _, e, w = adaptfilt.lms(*given, taps, 2 * mu)
        return Adapted(d - e, w)

    def with_pydaptivefiltering() -> Adapted:
        other = pydaptivefiltering.LMS(filter_order=ORDER, step_size=2 * mu)
        return Adapted(np.real(other.optimize(x, d).outputs), np.real(other.w))

    return Contest(
        "LMS",
        len(x),
        run_ours(ours, x, d),
        {
            PLAIN: lambda: reference.lms(x, d, ORDER, mu),
            "padasip": with_padasip,
            "adaptfilt": with_adaptfilt,
            "PyDaptiveFiltering": with_pydaptivefiltering,
            "numba": lambda: loops.lms(x, d, ORDER, mu),
            **c_builds("", lambda c: c.lms(x, d, mu)),
            **c_builds(", looked ahead", lambda c: c.lms(x, d, mu, ahead=True)),
        },
        repeats,
    )


def plays(name: str, x: FloatArray, d: FloatArray) -> Contest:
    """Backlash or GPO filter."""
    ours = adaptive(name, x, FRACTION)
    mu, r = ours.step_size, ours.thresholds
    envelope = PUBLISHED_ENVELOPE if name == "gpo" else None
    return Contest(
        name,
        len(x),
        run_ours(ours, x, d),
        {
            PLAIN: lambda: reference.play_lms(x, d, ORDER, mu, r, envelope),
            "numba": lambda: loops.play_lms(x, d, ORDER, mu, r, envelope),
            **c_builds("", lambda c: c.play_lms(x, d, mu, r, envelope)),
            **c_builds(
                ", looked ahead", lambda c: c.play_lms(x, d, mu, r, envelope, True)
            ),
        },
        repeats=7,
    )


def volterra(x: FloatArray, d: FloatArray) -> Contest:
    """Full second-order Volterra filter of 992 weights."""
    ours = adaptive("volterra", x, FRACTION)
    mu1, mu2 = ours.step_size, ours.second_order_step
    taps = ORDER + 1
    rows, columns = np.triu_indices(taps)

    def with_pydaptivefiltering() -> Adapted:
        # It has one weight for each product of two different taps where the full form
        # has two: with twice their step size its outputs are the same.
        twice = np.where(rows == columns, 1, 2)
        steps = np.concatenate((np.full(taps, mu1), mu2 * twice))
        other = pydaptivefiltering.VolterraLMS(memory=taps, step_size=steps)
        y = np.asarray(other.optimize(x, d).outputs)
        second = np.empty((taps, taps))
        second[rows, columns] = second[columns, rows] = other.w[taps:] / twice
        return Adapted(y, np.concatenate((other.w[:taps], second.ravel())))

    return Contest(
        "volterra",
        len(x),
        run_ours(ours, x, d),
        {
            PLAIN: lambda: reference.volterra(x, d, ORDER, mu1, mu2),
            "PyDaptiveFiltering": with_pydaptivefiltering,
            "numba": lambda: loops.volterra(x, d, ORDER, mu1, mu2),
            **c_builds("", lambda c: c.volterra(x, d, mu1, mu2)),
            **c_builds(", fused", lambda c: c.volterra(x, d, mu1, mu2, fused=True)),
        },
        repeats=5,
    )


def simulation(x: FloatArray) -> Contest:
    """GPI model, Eq. 9, its envelope functions included."""
    r = thresholds(PUBLISHED_ENVELOPE, AMPLITUDE, ORDER)
    weights = np.linspace(2.0, 0.2, ORDER + 1)

    def given() -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        return PUBLISHED_ENVELOPE.left(x), PUBLISHED_ENVELOPE.right(x), r, weights

    return Contest(
        "GPI simulation",
        len(x),
        lambda: Adapted(generalized_prandtl_ishlinskii(*given()), weights),
        {
            PLAIN: lambda: Adapted(reference.prandtl_ishlinskii(*given()), weights),
            **c_builds("", lambda c: Adapted(c.prandtl_ishlinskii(*given()), weights)),
        },
        repeats=7,
    )


def rate_dependent_simulation(x: FloatArray) -> Contest:
    """RDGPI model: thresholds and weights that follow the input's rate."""
    rate = np.abs(np.gradient(x, 1e-4))
    spacing = 0.02 * np.log(1.5 + 0.01 * rate)
    ratio = np.exp(-2.0 * spacing)
    nothing = np.ones(1)
    given = spacing, ratio, ORDER + 1

    def in_c(c: CReference) -> Adapted:
        return Adapted(c.rate_dependent(x, spacing, ratio), nothing)

    return Contest(
        "RDGPI simulation",
        len(x),
        lambda: Adapted(rate_dependent_prandtl_ishlinskii(x, x, *given)[0], nothing),
        {
            PLAIN: lambda: Adapted(reference.rate_dependent(x, *given), nothing),
            **c_builds("", in_c),
        },
        repeats=7,
    )


def run_ours(ours: AdaptiveFilter, x: FloatArray, d: FloatArray) -> Candidate:
    """Run a filter of the package as its users do."""

    def filtered() -> Adapted:
        result = ours.run(x, d)
        return Adapted(result.output, result.weights)

    return filtered


def c_builds(
    form: str, candidate: Callable[[CReference], Adapted]
) -> dict[str, Candidate]:
    """Take one loop of the C reference in each of its builds."""
    return {
        f"{name}{form}": partial(candidate, CReference(name, ORDER)) for name in BUILDS
    }

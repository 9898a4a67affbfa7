"""How far exported code is from the simulation of a whole record, in typical cases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.blocks import step
from hystbench.blocks.curve import CENTRAL, about_sample
from hystbench.blocks.step import Sampling
from hystbench.export import python
from hystbench.export.described import describe, exact_delay
from hystbench.model import Model

DT = 1e-4
"""Sampling interval in seconds; the numbers do not depend on it."""
SAMPLES = 2000
BEGUN = 500
"""Samples that are left out: hysteresis remembers how a record began."""
NOISE = 1e-3
"""Rms of a measured input's noise, where its amplitude is one."""

_LAG = {"drive-lag": {"time_constant_s": 10 * DT, "hold": "band-limited"}}
_LOOP = {
    "prandtl-ishlinskii": {"thresholds": [0.0, 0.2, 0.4], "weights": [0.5, 0.5, 0.5]}
}
_FRICTION = {"friction": {"coulomb": 1.0, "velocity_scale": 0.01 / DT}}


@dataclass(frozen=True)
class Case:
    """A chain of blocks, and a sine that enters it.

    Parameters
    ----------
    words : str
    chain : tuple of dict
        As a model file has it.
    samples : int
        Of the sine's period.
    noise : float
        Rms, the sine's amplitude being one.
    """

    words: str
    chain: tuple[Mapping[str, Mapping[str, object]], ...]
    samples: int
    noise: float = 0.0


CASES = (
    *(Case("a lag", (_LAG,), n) for n in (50, 20, 10)),
    Case("a lag behind hysteresis", (_LOOP, _LAG), 100),
    Case("friction", (_FRICTION,), 100),
    Case("friction, noise of 0.1 %", (_FRICTION,), 100, NOISE),
    Case("a lag, noise of 0.1 %", (_LAG,), 100, NOISE),
)
WAYS = ((6, 0), (3, 0), (2, 0), (6, 1), (6, None))
"""Points and delay, as ``hystbench export`` takes them; none for ``exact``."""


def error(case: Case, points: int, delay: int | None) -> float:
    """Give the rms error of exported code, as a share of the output's rms.

    Parameters
    ----------
    case : Case
    points : int
    delay : int, optional
        As of :class:`~hystbench.blocks.step.Sampling`; none for as many samples as make
        the code the simulation. The output is held against the
        simulation so many samples before.
    """
    content = {
        "name": "case",
        "input": {"name": "input", "unit": "A"},
        "output": {"name": "output", "unit": "um"},
        "chain": list(case.chain),
    }
    model = Model.from_mapping(content, case.words)
    u = np.sin(2 * np.pi * np.arange(SAMPLES) / case.samples)
    u += case.noise * np.random.default_rng(0).standard_normal(SAMPLES)
    wanted = model.simulate(u, DT)
    # The record's own end is no part of it: the curve is turned about it.
    part = slice(BEGUN, SAMPLES - BEGUN)
    code = describe(model, Sampling(DT, points))
    late = exact_delay(code) if delay is None else delay
    if late:
        code = describe(model, Sampling(DT, points, delay=late))
    made = python.loaded(code).simulate(u)[late:]
    off = (made - wanted[: len(made)])[part]
    return float(np.sqrt(np.mean(off**2) / np.mean(wanted[part] ** 2)))


def noise_of_rate(points: int, delay: int | None) -> float:
    """Give how noisy a rate is, of white noise, over that of a central difference."""
    late = 1 if delay is None else delay
    return step.noise_of_rate(about_sample(CENTRAL, max(points, late + 2), late))


def table(cases: Sequence[Case] = CASES) -> list[dict[str, str]]:
    """Give the errors of all cases and ways, a row each; a way is a column."""
    rows = []
    for case in cases:
        row = {"case": case.words, "samples a period": str(case.samples)}
        for way in WAYS:
            row[_words(*way)] = f"{error(case, *way):.1g}"
        rows.append(row)
    rate = {"case": "noise of a rate, over a central difference's"}
    rate["samples a period"] = ""
    rate |= {_words(*way): f"{noise_of_rate(*way):.2g}" for way in WAYS}
    return [*rows, rate]


def _words(points: int, delay: int | None) -> str:
    late = "exact" if delay is None else str(delay)
    return f"--points {points}" + f" --delay {late}" * (delay != 0)

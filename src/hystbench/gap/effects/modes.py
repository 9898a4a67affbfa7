"""Modes of the mechanics: a further one, or one whose spring hardens."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import fft

from hystbench.blocks import block_class
from hystbench.blocks.base import Block
from hystbench.blocks.exponential_stiffness import ExponentialStiffness
from hystbench.blocks.force import Dynamics
from hystbench.blocks.saturating_stiffness import SaturatingStiffness
from hystbench.blocks.stiffness import Stiffness
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.blocks.transverse_springs import TransverseSprings
from hystbench.errors import InputError
from hystbench.gap.effects.effect import NOT_IN_CHAIN, Declined, Effect
from hystbench.gap.effects.law import Law, Moved
from hystbench.gap.effects.places import TRANSFER_FUNCTION
from hystbench.gap.effects.variant import Values, Variant, logarithmic
from hystbench.gap.simulation.simulation import Simulation
from hystbench.record import FloatArray

PEAKS = 3
"""Frequencies at which the residual looks most like a lightly damped mode."""
LIGHT = 0.02
"""Damping ratio of that mode: its peak is as wide as a step of the search."""
BINS = 8
"""Bins of the spectrum in a step from mode to mode, which is a half-width of a peak."""
NEAR = 0.25
"""Share of a frequency around it in which a mode is told by its peak."""


class Resonance(Effect):
    """A mode behind the hysteresis, of less than a third of critical damping.

    A heavily damped fast mode is a lag or a delay to the data: it may not take their
    place.
    """

    name = "resonance"
    shows = "frequency"
    place = "mechanics"

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer modes from two periods in the shortest record to 0.45 of the rate.

        A lightly damped mode falls between the points of a grid, so that frequencies at
        which the residual has its peaks are points too.
        """
        low, high = 2 / simulation.shortest, 0.45 / simulation.step
        grid = logarithmic(low, high, 6)
        yield self.inserted(
            simulation,
            simulation.behind_linear,
            grids={
                "frequency_hz": np.union1d(grid, peaks(simulation, low, high)),
                "damping_ratio": np.array([0.01, 0.15]),
            },
            unit={"participation": 0.01},
            refused={"frequency_hz": "either", "damping_ratio": "either"},
            limits={"damping_ratio": (0.001, 0.33)},
        )


def peaks(simulation: Simulation, low: float, high: float) -> FloatArray:
    """Give the frequencies at which one light mode would lower the residual most.

    Only what lies within ``NEAR`` of a mode's frequency counts, where it stands out
    of what else the residual holds.

    Parameters
    ----------
    simulation : Simulation
    low, high : float
        In Hz.

    Returns
    -------
    ndarray, shape (PEAKS or fewer,)
        In Hz, rising.
    """
    count = int(np.log(high / low) / LIGHT) + 2
    modes = np.geomspace(low, high, count)
    # In bins of the logarithm of frequency all modes look alike, each further along.
    width = np.log(modes[1] / low) / BINS
    first, last = (int(np.log(1 + end) / width) for end in (-NEAR, NEAR))
    x = np.exp(width * np.arange(first, last + 1))
    mode = 1 / (1 - x**2 + 2j * LIGHT * x) - 1
    bins = np.zeros((3, (count - 1) * BINS + len(x)))
    inputs = simulation.at(simulation.behind_linear)
    for record, v, simulated in zip(
        simulation.records, inputs, simulation.output, strict=True
    ):
        length = fft.next_fast_len(2 * len(record), real=True)
        left = fft.rfft(record.y - simulated, length)[1:]
        driven = fft.rfft(v, length)[1:]
        place = np.log(fft.rfftfreq(length, record.dt)[1:] / low) / width - first
        place = np.rint(place).astype(int)
        inside = slice(*np.searchsorted(place, [0, bins.shape[1]]))
        both = (driven.conj() * left)[inside]
        for row, lines in zip(
            bins, (both.real, both.imag, np.abs(driven[inside]) ** 2), strict=True
        ):
            row += np.bincount(place[inside], lines, len(row))
    real, imaginary, square = sliding_window_view(bins, len(x), axis=1)[:, ::BINS]
    along = real @ mode.real + imaginary @ mode.imag
    square = square @ np.abs(mode) ** 2
    gain = along**2 / np.maximum(square, np.finfo(float).tiny)
    inner = gain[1:-1]
    tops = 1 + np.flatnonzero((inner > gain[:-2]) & (inner >= gain[2:]))
    best = tops[np.argsort(gain[tops])[-PEAKS:]]
    return np.sort(modes[best])


Before = tuple[Block, ...]
"""What is left of a block when a mode is taken out of its end."""


class StiffnessHardening(Effect):
    """A spring that stiffens or softens with its displacement."""

    name = "stiffness-hardening"
    shows = "frequency"
    place = "mechanics"
    laws = (
        *("stiffness", "exponential-stiffness"),
        *("saturating-stiffness", "transverse-springs"),
    )

    def variants(self, simulation: Simulation) -> Iterator[Variant]:
        """Offer the spring for each mode, those inside transfer functions included.

        Raises
        ------
        Declined
            If there is no mode, or none that can be taken out.
        """
        found = False
        for k, block in enumerate(simulation.chain):
            for before, mode in _modes(block):
                found = True
                yield from self._hardened(simulation, k, before, mode)
        if found:
            return
        if any(isinstance(block, Dynamics) for block in simulation.chain):
            raise Declined(NOT_IN_CHAIN)
        raise Declined("the chain has no mode whose spring could harden")

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer a cube of either sign, a square beside it, and other springs.

        One grows steeply, one up to a stiffness; one levels off, beside a linear spring
        or in its place.
        """
        if moved.anywhere:
            return
        linear = moved.force / moved.reach
        for sign, share in ((1.0, AS_STIFF), (-1.0, HALF_LOST)):
            cubic = sign * 0.03 * linear / moved.reach**2
            block = Stiffness(quadratic=0.0, cubic=cubic)
            yield Law("cube", block, ("cubic",))
            yield Law("square and cube", block, ("quadratic", "cubic"))
            # Where the mode moves by more than its width, little tells nothing of much.
            much = sign * share * moved.stiffness / moved.reach**2
            if abs(much) > abs(cubic):
                yield Law("cube", replace(block, cubic=much), ("cubic",))
        steep = ExponentialStiffness(coefficient=0.03 * linear, reach=moved.reach / 2)
        yield Law("steep", steep, ("coefficient", "reach"))
        across = TransverseSprings(stiffness=0.1 * linear, reach=moved.reach / 2)
        yield Law("up to a stiffness", across, ("stiffness", "reach"))
        shares = (0.5, 1.0) if moved.loose else (0.5,)
        for share in shares if moved.stiffness > 0.0 else ():
            levels_off = SaturatingStiffness(
                stiffness=share * moved.stiffness, reach=moved.reach
            )
            form = "levels off" + ", without a linear spring" * (share == 1.0)
            numbers = ("stiffness", "reach")
            yield Law(form, levels_off, numbers, stands_for=share)

    def _hardened(
        self, simulation: Simulation, k: int, before: Before, mode: Mapping[str, Any]
    ) -> Iterator[Variant]:
        """Offer a spring that is hardly another, one that stiffens, one that softens.

        The first is solved for. Where the mode moves by more than its own width, what
        the first does tells nothing: the others are searched.
        """
        rest = simulation.chain[k + 1 :]

        def build(given: Values) -> tuple[Block, ...]:
            own = block_class(self.name).from_mapping({**mode, **given})
            return (*before, own, *rest)

        # What moves the spring: the mode's own input, or what it gives.
        unit = 1.0 / simulation.largest(k + 1 if before else k) ** 2
        solved = Variant(
            self.name,
            self.place,
            f"{mode['frequency_hz']:.3g} Hz" if before else "",
            k,
            build,
            tuple(range(len(before) + 1)),
            unit={"coefficient": 1e-3 * unit},
            free=("coefficient",),
            replaces=True,
            neutral=False,
            zero={"coefficient": 0.0},
        )
        yield solved
        for way, shares in (("stiffer", STIFFER), ("softer", SOFTER)):
            yield replace(
                solved,
                form=f"{solved.form} {way}".strip(),
                unit={},
                grids={"coefficient": unit * shares},
            )


STIFFER, SOFTER = np.geomspace(2e-3, 4.0, 9), -np.geomspace(0.5, 2e-3, 6)
"""Share of the linear force that the cube has at the largest static displacement. At
resonance a mode moves by far more; softer by all of it, a spring has no force left."""

AS_STIFF, HALF_LOST = 1.0, 1 / 6
"""Share of the linear spring's force that a cube has at the largest displacement, where
a fit starts with much of it. The softer spring still pulls: a sixth takes half of its
slope there."""

MODE = ("frequency_hz", "damping_ratio", "participation")
DAMPED = 0.5
"""Damping ratio up to which a pair of poles is a mode."""


def _modes(block: Block) -> Iterator[tuple[Before, dict[str, Any]]]:
    """Give the modes of a block, each with what stays of the block before it."""
    if block.name == "resonance":
        given = block.to_mapping()
        yield (), {key: given[key] for key in MODE}
    elif block.name == TRANSFER_FUNCTION:
        yield from _modes_inside(cast("TransferFunction", block))


def _modes_inside(
    block: TransferFunction,
) -> Iterator[tuple[Before, dict[str, Any]]]:
    """Take underdamped pairs of poles out of a transfer function, as a mode behind it.

    ``G(s) = (N(s) wn^2 / D'(s)) / (s^2 + 2 zeta wn s + wn^2)`` with the first factor
    proper. The mode starts from rest, so the whole must too.
    """
    poles = np.roots(block.denominator)
    if block.start != "rest" or len(block.numerator) > len(block.denominator) - 2:
        return
    for pole in poles[poles.imag > 0]:
        wn = float(abs(pole))
        zeta = float(-pole.real / wn)
        if zeta > DAMPED:
            continue
        pair = np.array([1.0, 2 * zeta * wn, wn**2])
        # Divided by the pair's own static value, so that the mode's is one.
        down = np.polydiv(np.array(block.denominator), pair / wn**2)[0]
        try:
            left = _left(block, down)
        except InputError:
            continue  # of many poles, rounding may make what is left unstable
        yield (
            (left,),
            {
                "frequency_hz": wn / (2 * np.pi),
                "damping_ratio": zeta,
                "participation": 1.0,
                **({"hold": block.hold} if block.hold != "default" else {}),
            },
        )


def _left(block: TransferFunction, down: np.ndarray) -> Block:
    """Give a transfer function's numerator over what is left of its denominator."""
    if len(down) == 1:
        static = block.numerator[-1] / float(down[0])
        return block_class("gain").from_mapping({"value": static})
    given = block.to_mapping() | {"denominator": down.tolist()}
    return block_class(TRANSFER_FUNCTION).from_mapping(given)

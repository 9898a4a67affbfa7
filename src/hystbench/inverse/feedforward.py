"""The input for a reference: exact for plays, iterated for all around them.

References
----------
.. [1] P. Krejci, K. Kuhnen, "Inverse control of systems with hysteresis and creep", IEE
   Proceedings - Control Theory and Applications 148 (2001) 185-192.
.. [2] M. Al Janaideh, S. Rakheja, C.-Y. Su, "An analytical generalized
   Prandtl-Ishlinskii model inversion for hysteresis compensation in micropositioning
   control", IEEE/ASME Transactions on Mechatronics 16 (2011) 734-744.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from hystbench import kernels
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.inverse.response import Response, best_linear, without
from hystbench.model import Model
from hystbench.record import FloatArray

ROUNDS = 40
"""Corrections at most."""
ENOUGH = 2e-4
"""RMS error, as a share of the reference's peak-to-peak, that needs no more of them."""
SLOW = 0.98
"""A correction that leaves more of the error than this is the last."""
BAND_SHARE = 0.1
"""Band of the inverse as a share of the sampling rate, where nobody says another."""
FAR = 1e12
"""An input of play operators is looked for so far, where nobody sets a limit."""


class InputRange(NamedTuple):
    """Lowest and highest input of the actuator."""

    low: float = -FAR
    high: float = FAR


@dataclass(frozen=True)
class Feedforward:
    """An input, and how well the model's output follows the reference with it."""

    u: FloatArray
    y: FloatArray
    """The input and the model's output, shape (n,) each."""
    error: tuple[float, ...]
    """RMS error of the model's output after each correction, as a share of the
    reference's peak-to-peak."""
    exact: str
    """The block that was inverted exactly, or nothing."""
    clipped: int
    """Samples at which the input stands at a limit."""

    @property
    def left(self) -> float:
        """RMS error that is left, as a share of the reference's peak-to-peak."""
        return min(self.error)


def feedforward(
    model: Model,
    reference: FloatArray,
    dt: float,
    band_hz: float | None = None,
    limits: InputRange = InputRange(),  # noqa: B008 - cannot be changed
) -> Feedforward:
    """Find the input that makes a model's output follow a reference.

    The first play operators in the chain are inverted exactly. What is before, around
    and behind them, or the whole model where there are none, is inverted by iteration:
    the best linear approximation of what is left gives the first input, and turns each
    error that is left into a correction [1]_. The reference is known as a whole, so
    that the input may move before it does.

    Parameters
    ----------
    model : Model
    reference : ndarray, shape (n,)
        Wanted output, in the unit of the model's.
    dt : float
        Sampling interval in seconds.
    band_hz : float, optional
        Up to this frequency errors are corrected; a tenth of the sampling rate else.
    limits : InputRange
        Those of the input.

    Returns
    -------
    Feedforward

    Raises
    ------
    InputError
        If the reference does not move, or wants what no input makes, or if the model
        integrates.

    References
    ----------
    .. [1] D. A. Bristow, M. Tharayil, A. G. Alleyne, "A survey of iterative learning
       control", IEEE Control Systems Magazine 26 (2006) 96-114.
    """
    reference = np.ascontiguousarray(reference, dtype=np.float64)
    stroke = float(np.ptp(reference)) if len(reference) else 0.0
    if len(reference) < 16 or not np.isfinite(reference).all() or stroke == 0:
        raise InputError(
            "reference: expected at least 16 finite samples that are not all the same"
        )
    band = BAND_SHARE / dt if band_hz is None else band_hz
    if not 0 < band <= 0.5 / dt:
        raise InputError(
            f"--band: {band:g} Hz; expected above 0 and at most {0.5 / dt:g} Hz, half "
            "the sampling rate"
        )
    for place, block in enumerate(model.chain, start=1):
        if isinstance(block, TransferFunction) and block.integrates:
            raise InputError(
                f"chain: block {place}: {block.name}: a pole at s = 0; expected none, "
                "as the response of an integrator to a reference never ends"
            )
    start = Start.of(model, limits)
    anywhere = Start.of(model, InputRange())
    response = best_linear(
        lambda x: model.simulate(anywhere.to_input(x)[0], dt),
        stroke,
        len(reference),
        dt,
        min(1.5 * band, 0.5 / dt),
        hysteretic=start.plays is None,
    )
    x = without(response, reference - response.rest, dt, band)
    found = _corrected(model, start, response, x, reference, dt, band)
    if not np.isfinite(found.left):
        raise InputError(
            "reference: the model's output diverges with the input that it would "
            "take; expected a smaller or slower reference"
        )
    if found.clipped and limits == InputRange():
        raise InputError(
            f"reference: the input diverges at {found.clipped} of {len(reference)} "
            f"samples, as '{found.exact}' does not reach what is asked of it; expected "
            "a smaller or slower reference, or --limit-low and --limit-high"
        )
    return found


class Plays(NamedTuple):
    """Play operators, what they weigh, and a linear path beside them.

    ``y = path v + sum_i (w_i P_i + s_i P_i^2 + c_i P_i^3)``; an envelope of eight
    numbers makes the operators generalized ones.
    """

    path: float
    envelope: tuple[float, ...]
    thresholds: FloatArray
    terms: FloatArray  # shape (3, m): w, s and c
    settled: bool

    @classmethod
    def of(cls, block: object) -> Plays | None:
        """Give the plays that a block is made of, None of any other block."""
        if isinstance(block, GeneralizedPrandtlIshlinskii):
            terms = np.zeros((3, len(block.weights)))
            terms[0] = block.weights
            settled = block.start == "settled"
            r = np.array(block.thresholds)
            return cls(0.0, block.envelope, r, terms, settled)
        if isinstance(block, PrandtlIshlinskii):
            none = (0.0,) * len(block.weights)
            squares, cubes = block.square_weights or none, block.cube_weights or none
            terms = np.array([block.weights, squares, cubes])
            return cls(1.0, (), np.array(block.thresholds), terms, False)
        return None

    def invert(
        self, y: FloatArray, low: float = -FAR, high: float = FAR
    ) -> tuple[FloatArray, int]:
        """Find the input of an output, sample by sample and to rounding.

        At each sample the output rises with the input, the operators' states being
        what they are, so that one input gives the wanted output [1]_ [2]_. That holds
        for weights that are nowhere negative in sum and envelopes that rise.

        Parameters
        ----------
        y : ndarray, shape (n,)
            Output.
        low, high : float
            Limits of the input.

        Returns
        -------
        v : ndarray, shape (n,)
            Input; at its limit where the output lies out of reach.
        lost : int
            Samples of which that is so.
        """
        v = np.empty(len(y))
        state = np.zeros(len(self.thresholds))
        own = np.array(self.envelope or (0.0,) * 8)
        wanted = np.ascontiguousarray(y)
        sizes = (len(y), len(state), int(bool(self.envelope)))
        given = (self.path, own, self.thresholds, self.terms, low, high, wanted)
        lost = 0
        for _ in range(2 if self.settled else 1):
            lost = kernels.call("hb_invert_plays", *sizes, *given, state, v)
        return v, lost


@dataclass(frozen=True)
class Start:
    """How what is iterated becomes an input: by plays that are inverted exactly.

    What is iterated is then the output of these plays, else the input itself.
    """

    name: str
    """The block of the plays; nothing where there is none."""
    plays: Plays | None
    scale: float
    shift: float
    """The straight line before the plays; what else is before or around them counts as
    nothing here, and is left to the iteration."""
    limits: InputRange
    """Those of the input."""

    @classmethod
    def of(cls, model: Model, limits: InputRange) -> Start:
        """Look for the first plays in the chain."""
        scale, shift = 1.0, 0.0
        for block in model.chain:
            plays = Plays.of(block)
            if plays is not None and scale != 0:
                return cls(block.name, plays, scale, shift, limits)
            if isinstance(block, Gain):
                scale, shift = scale * block.value, shift * block.value + block.offset
        return cls("", None, 1.0, 0.0, limits)

    def to_input(self, x: FloatArray) -> tuple[FloatArray, int]:
        """Give the input, and the samples at which it stands at a limit."""
        if self.plays is None:
            u = np.clip(x, *self.limits)
            return u, int((u != x).sum())
        ends = sorted(self.scale * limit + self.shift for limit in self.limits)
        v, lost = self.plays.invert(x, *ends)
        return (v - self.shift) / self.scale, lost


def _corrected(
    model: Model,
    start: Start,
    response: Response,
    x: FloatArray,
    reference: FloatArray,
    dt: float,
    band: float,
) -> Feedforward:
    """Correct by the error that is left, as long as it falls."""
    stroke = float(np.ptp(reference))

    def tried(x: FloatArray) -> Feedforward:
        u, clipped = start.to_input(x)
        y = model.simulate(u, dt)
        off = float(np.sqrt(np.mean((reference - y) ** 2))) / stroke
        return Feedforward(u, y, (off,), start.name, clipped)

    best = tried(x)
    errors, share = list(best.error), 1.0
    for _ in range(ROUNDS):
        if errors[-1] <= ENOUGH or share < 0.05:
            break
        change = share * without(response, reference - best.y, dt, band)
        again = tried(x + change)
        if again.error[0] < errors[-1]:
            slow = again.error[0] > SLOW * errors[-1]
            x, best = x + change, again
            errors.append(again.error[0])
            if slow:
                break
        else:
            share *= 0.5
    return replace(best, error=tuple(errors))

"""Block ``iwan-force``: elements in parallel that slip one after the other."""

import numpy as np

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number, numbers
from hystbench.errors import InputError
from hystbench.record import FloatArray

ELEMENTS = 12
"""Elements that stand for a density: the force of the first loading is within some
tenths of a percent of the largest, and within one where nearly all slip at once or
soon."""


LEAST_EXPONENT = -0.95
"""Exponent without a first slip: at minus one the stiffness has no bound."""


class IwanForce(Force, name="iwan-force", law="slider"):
    """A sum of stops, elastic and perfectly plastic: a joint that slips bit by bit.

    ``F = stiffness sum of s_i E_i[q]``; E_i is the way since the last turn, held
    between plus and minus a threshold r_i (a stop operator, which is what a play
    operator leaves of its input), and the shares s_i add up to one. Thresholds are
    spread between zero and the slip distance with a density that goes as
    ``r^exponent``: zero is even, toward minus one are bolted joints, whose loss at a
    small amplitude goes as its power of ``exponent + 3`` [2]_; a large one is dry
    friction that slips at once. With a first slip no threshold lies below that share of
    the slip distance, and the exponent may be below -1. Or ``weights`` are those of
    thresholds ``slip_distance i / n``, i from 1 to n.

    Its loops are Masing's: every branch is the first loading at twice the size, and a
    small loop within a large one closes, as none of Bouc and Wen's does.

    References
    ----------
    .. [1] W. D. Iwan, "A distributed-element model for hysteresis and its steady-state
       dynamic response", Journal of Applied Mechanics 33 (1966) 893-900.
    .. [2] D. J. Segalman, "A four-parameter Iwan model for lap-type joints", Journal of
       Applied Mechanics 72 (2005) 752-760.
    """

    stiffness: float = number("U/Q", "where nothing slips", 0.0)
    slip_distance: float = number("Q", "way from rest to where all slip", TINY)
    exponent: float = number(
        "-",
        "of the density of thresholds: 0 even, below it more short ones",
        -4.0,
        20.0,
        0.0,
    )
    first_slip: float = number(
        "-", "least threshold, as a share of the slip distance", 0.0, 0.99, default=0.0
    )
    weights: tuple[float, ...] = numbers(
        "-",
        "stiffness of each element, up to a factor, in place of an exponent",
        0.0,
        optional=True,
    )

    def check(self) -> None:
        """Refuse a density of which the stiffness has no bound."""
        if self.exponent < LEAST_EXPONENT and not self.first_slip:
            raise InputError(
                f"exponent: {self.exponent:g}; expected at least {LEAST_EXPONENT:g} "
                "without a first_slip"
            )

    def elements(self) -> tuple[FloatArray, FloatArray]:
        """Give the share of the stiffness and the threshold of each element.

        Of a density each stands for an interval, of which there are more of short
        thresholds, with its stiffness and its largest force.
        """
        if self.weights:
            n = len(self.weights)
            total = max(float(np.sum(self.weights)), TINY)
            return np.array(self.weights) / total, np.arange(1, n + 1) / n * (
                self.slip_distance
            )
        first = self.first_slip ** (1.0 / 1.5)
        edges = np.linspace(first, 1.0, ELEMENTS + 1) ** 1.5
        shares, largest = (_between(edges, self.exponent + k) for k in (0.0, 1.0))
        means = largest / np.maximum(shares, TINY)
        thresholds = np.clip(means, edges[:-1], edges[1:]) * self.slip_distance
        return shares / shares.sum(), thresholds

    def numbers(self) -> FloatArray:
        """Give sliders without a gap: a stiffness and a reach each."""
        shares, thresholds = self.elements()
        return np.column_stack([self.stiffness * shares, thresholds])


def _between(edges: FloatArray, exponent: float) -> FloatArray:
    """Integrate a power from each edge to the next."""
    order = exponent + 1.0
    if order == 0.0:
        return np.diff(np.log(edges))
    return np.diff(edges**order) / order

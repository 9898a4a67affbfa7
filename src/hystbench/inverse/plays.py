"""Exact inverses of models made of play operators.

References
----------
.. [1] P. Krejci, K. Kuhnen, "Inverse control of systems with hysteresis and creep", IEE
   Proceedings - Control Theory and Applications 148 (2001) 185-192.
.. [2] M. Al Janaideh, S. Rakheja, C.-Y. Su, "An analytical generalized
   Prandtl-Ishlinskii model inversion for hysteresis compensation in micropositioning
   control", IEEE/ASME Transactions on Mechatronics 16 (2011) 734-744.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hystbench import kernels
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.prandtl_ishlinskii import PrandtlIshlinskii
from hystbench.record import FloatArray

FAR = 1e12
"""An input of play operators is looked for so far, where nobody sets a limit."""


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

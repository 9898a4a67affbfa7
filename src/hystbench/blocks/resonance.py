"""Block ``resonance``: one mechanical mode beside a rigid path."""

import numpy as np

from hystbench.blocks.linear import LinearBlock
from hystbench.blocks.parameter import number
from hystbench.blocks.state_space import StateSpace, mode


class Resonance(LinearBlock, name="resonance", place="mechanics"):
    """One mode that carries a part of the static displacement.

    ``G(s) = (1 - p) + p wn^2 / (s^2 + 2 zeta wn s + wn^2)``, with static gain one.

    References
    ----------
    .. [1] D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed.,
       Research Studies Press, 2000.
    """

    frequency_hz: float = number("Hz", "undamped frequency wn / 2 pi", 1e-3, 1e6)
    damping_ratio: float = number("-", "zeta, share of critical damping", 1e-5, 10.0)
    participation: float = number(
        "-",
        "p, static share; negative: out of phase with the rest",
        -10.0,
        10.0,
    )

    def continuous(self) -> StateSpace:
        """Return the mode with displacement and scaled velocity as states."""
        wn = 2.0 * np.pi * self.frequency_hz
        return mode(wn, self.damping_ratio, self.participation)

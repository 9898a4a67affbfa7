"""Block ``saturation``: the material's response levels off."""

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import TINY, number
from hystbench.errors import InputError
from hystbench.record import FloatArray


class Saturation(Block, name="saturation", place="material", curve="saturation"):
    """Odd and soft saturation.

    Without a sharpness ``y = level tanh(z / level)``; with one, n, the algebraic law
    ``y = z / (1 + |z / level|^n)^(1/n)``, a corner that is sharper the larger n is.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: magnetisation and strain saturate.
    """

    level: float = number("Y", "output that is never reached", TINY)

    sharpness: float = number(
        "-",
        "exponent n of the algebraic law; 0 for the tangent",
        0.0,
        100.0,
        default=0.0,
    )

    def check(self) -> None:
        """Refuse an exponent below one: its curve is not smooth at zero."""
        if 0.0 < self.sharpness < 1.0:
            raise InputError(f"sharpness: {self.sharpness:g}; expected 0 or at least 1")

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the curve."""
        ratio = z / self.level
        if self.sharpness == 0.0:
            return self.level * np.tanh(ratio)
        # Beyond the level the inverse of the ratio: no power of a large one is taken.
        size = np.abs(ratio)
        inside = np.minimum(size, 1.0)
        small = inside / np.maximum(size, 1.0)
        bent = inside / (1.0 + small**self.sharpness) ** (1.0 / self.sharpness)
        return np.asarray(np.copysign(self.level * bent, z))

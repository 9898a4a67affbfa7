"""Block ``saturation``: the material's response levels off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.parameter import number
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Saturation(Block):
    """Odd and soft saturation: ``y = level tanh(z / level)``.

    References
    ----------
    .. [1] G. Engdahl (ed.), Handbook of Giant Magnetostrictive Materials, Academic
       Press, 2000: magnetisation and strain saturate.
    """

    name: ClassVar = "saturation"
    place: ClassVar = "material"
    reference: ClassVar = "Engdahl, Handbook of Giant Magnetostrictive Materials, 2000"

    level: float = number("Y", "output that is never reached", 1e-9, 1e9)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the curve."""
        return self.level * np.tanh(z / self.level)

"""Block ``hysteresis``: hysteresis that a base model without any lacks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hystbench.blocks.base import Place
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii


@dataclass(frozen=True)
class MaterialHysteresis(GeneralizedPrandtlIshlinskii):
    """The block ``gpi`` as an effect in a chain whose base has no hysteresis.

    References
    ----------
    .. [1] M. Al Janaideh, S. Rakheja, C.-Y. Su, "An analytical generalized
       Prandtl-Ishlinskii model inversion for hysteresis compensation in
       micropositioning control", IEEE/ASME Transactions on Mechatronics 16 (2011)
       734-744.
    """

    name: ClassVar = "hysteresis"
    place: ClassVar[Place] = "material"

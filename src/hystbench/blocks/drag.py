"""Block ``drag``: a force inside a mechanism that grows with the velocity squared."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import number


class Drag(Force, name="drag", law="drag"):
    """The drag of a fluid in turbulent flow, ``F = coefficient q' |q'|``.

    References
    ----------
    .. [1] G. K. Batchelor, An Introduction to Fluid Dynamics, Cambridge, 1967.
    """

    coefficient: float = number("U s^2/Q^2", "of the velocity squared", 0.0)

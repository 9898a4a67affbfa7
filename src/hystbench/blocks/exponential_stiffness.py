"""Block ``exponential-stiffness``: a spring inside a mechanism that grows steeply."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import TINY, number


class ExponentialStiffness(Force, name="exponential-stiffness", law="sinh"):
    """A spring beside the linear one, ``F = coefficient (reach sinh(q / reach) - q)``.

    It hardly acts below the reach, where it is a cube, and grows as an exponential
    beyond: rubber that bottoms out, bonds, the current of diodes.

    References
    ----------
    .. [1] W. Lacarbonara, Nonlinear Structural Mechanics, Springer, 2013.
    """

    coefficient: float = number("U/Q", "its linear part, which is left out", 0.0)
    reach: float = number("Q", "distance beyond which it grows steeply", TINY)

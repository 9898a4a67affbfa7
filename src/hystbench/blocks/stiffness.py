"""Block ``stiffness``: a spring inside a mechanism that is not linear."""

from hystbench.blocks.force import Force
from hystbench.blocks.parameter import number


class Stiffness(Force, name="stiffness", law="stiffness"):
    """A spring beside the linear one, ``F = quadratic q^2 + cubic q^3``.

    A positive cube hardens, a negative one softens; a square makes both ways differ.

    References
    ----------
    .. [1] I. Kovacic, M. J. Brennan (eds.), The Duffing Equation: Nonlinear Oscillators
       and their Behaviour, Wiley, 2011.
    """

    one_of = ("quadratic", "cubic")

    quadratic: float = number("U/Q^2", "weight of the square", default=0.0)
    cubic: float = number("U/Q^3", "weight of the cube", default=0.0)

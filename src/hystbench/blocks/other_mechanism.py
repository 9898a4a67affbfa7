"""Block ``other-mechanism``: another mode with forces of its own."""

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.superposed import BesideBlock


class OtherMechanism(Mechanism, BesideBlock, name="other-mechanism", place="inside"):
    """A mechanism with the input of the one before it, added to its output.

    The forces that follow it in the chain act against its own motion, as in a nonlinear
    modal model [1]_: modes are coupled only by what drives them. A force that depends
    on the sum of their motions acts inside a ``structure``.

    References
    ----------
    .. [1] D. R. Roettgen, M. S. Allen, "Nonlinear characterization of a bolted,
       industrial structure using a modal framework", Mechanical Systems and Signal
       Processing 84 (2017) 152-170.
    """

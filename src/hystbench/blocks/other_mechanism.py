"""Block ``other-mechanism``: another mode with forces of its own."""

from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.superposed import BesideBlock


class OtherMechanism(Mechanism, BesideBlock, name="other-mechanism", place="inside"):
    """A mechanism with the input of the one before it, added to its output.

    A structure has a joint that moves in several of its modes: each of them is a
    mechanism, and the forces that follow it in the chain act against its own motion.
    Modes are coupled only by what drives them: a force that depends on the sum of their
    motions is told apart mode by mode, as in a nonlinear modal model [1]_.

    References
    ----------
    .. [1] D. R. Roettgen, M. S. Allen, "Nonlinear characterization of a bolted,
       industrial structure using a modal framework", Mechanical Systems and Signal
       Processing 84 (2017) 152-170.
    """

"""Block ``other-modes``: what else a force moves beside a mechanism."""

from hystbench.blocks.superposed import BesideBlock
from hystbench.blocks.transfer_function import TransferFunction


class OtherModes(TransferFunction, BesideBlock, name="other-modes", place="inside"):
    """Linear response to what drives the mechanism before it, added to its output.

    A structure of several modes is a ``mechanism`` for one of them, in which forces
    may act, and the transfer function of all others here (modal superposition [1]_).

    References
    ----------
    .. [1] D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed.,
       Research Studies Press, 2000, chapter 2.
    """

"""Block ``other-modes``: what else a force moves beside a mechanism or structure."""

from hystbench.blocks.superposed import BesideBlock
from hystbench.blocks.transfer_function import TransferFunction


class OtherModes(TransferFunction, BesideBlock, name="other-modes", place="inside"):
    """Linear response to what drives the block before it, added to its output.

    Modes in which forces may act are a ``mechanism`` or a ``structure``, and all others
    are a transfer function here (modal superposition [1]_).

    References
    ----------
    .. [1] D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed.,
       Research Studies Press, 2000, chapter 2.
    """

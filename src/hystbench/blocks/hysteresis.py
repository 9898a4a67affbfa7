"""Block ``hysteresis``: hysteresis that a base model without any lacks."""

from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii


class MaterialHysteresis(
    GeneralizedPrandtlIshlinskii, name="hysteresis", place="material"
):
    """The block ``gpi`` as an effect in a chain whose base has no hysteresis.

    References
    ----------
    .. [1] M. Al Janaideh, S. Rakheja, C.-Y. Su, "An analytical generalized
       Prandtl-Ishlinskii model inversion for hysteresis compensation in
       micropositioning control", IEEE/ASME Transactions on Mechatronics 16 (2011)
       734-744.
    """

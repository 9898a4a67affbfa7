"""A hysteretic base: Algorithm 1 on the slowest of the fit records."""

from __future__ import annotations

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model

ORDER = 20
"""Order N of the base: so many operators and one more."""


def identified_gpi(evidence: Evidence) -> tuple[Model, str]:
    """Identify the generalized Prandtl-Ishlinskii model of the slowest fit record.

    Parameters
    ----------
    evidence : Evidence
        Of its fit records only the slowest is looked at, or the one that the dataset
        names for identification.

    Returns
    -------
    Model
        A ``gpi`` block, and a ``gain`` behind it where a constant was fitted.
    str
        One sentence: the record, the relative error, and whether it is tolerable.

    Raises
    ------
    InputError
        If the record is too short.
    """
    from hystbench.identification import identify  # late: scipy

    slow = evidence.slowest
    found = identify(slow.u, slow.y, ORDER)
    block = GeneralizedPrandtlIshlinskii(
        envelope=tuple(found.envelope.to_dict().values()),
        thresholds=tuple(found.thresholds.tolist()),
        weights=tuple(found.weights.tolist()),
        start=found.start,
    )
    chain: tuple[Block, ...] = (block,)
    if found.offset:
        chain = (block, Gain(value=1.0, offset=found.offset))
    note = (
        f"gpi base of order {ORDER} from record {slow.name}, from {found.start}: "
        f"{found.message}"
    )
    return Model("gpi", evidence.input, evidence.output, chain), note

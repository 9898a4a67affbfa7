"""The generalized Prandtl-Ishlinskii base that is identified from one fit record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.errors import InputError
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.thresholds import ABOVE_NOISE
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.units import sized


@dataclass(frozen=True)
class IdentifiedGpi(Model):
    """A hysteresis that was identified from a fit record, with the gap in it."""


def is_another(first: Model, base: Model) -> bool:
    """Tell whether a base was first identified as another hysteresis."""
    return isinstance(first, IdentifiedGpi) and first.chain[0] not in base.chain


def again_words(record: str) -> str:
    """Say from what a hysteresis was identified again."""
    return (
        f"the hysteresis of the base was identified again, from record {record} "
        "without what the effects do to it, and the gap is counted from that"
    )


ORDER = 20
"""Order N of the base: so many operators and one more."""


def identified_gpi(evidence: Evidence) -> tuple[IdentifiedGpi, str]:
    """Identify the generalized Prandtl-Ishlinskii model of the slowest fit record.

    Parameters
    ----------
    evidence : Evidence
        Of its fit records only the slowest is looked at, or the one that the dataset
        names for identification.

    Returns
    -------
    IdentifiedGpi
        A ``gpi`` block, and a ``gain`` behind it where a constant was fitted.
    str
        One sentence: the record, the relative error, and whether it is tolerable.

    Raises
    ------
    InputError
        If the record is too short, or its input never turns back.
    """
    from hystbench.identification import identify  # late: scipy

    slow = evidence.to_identify_from
    back = _way_back(slow.u)
    if ORDER * back < np.ptp(slow.u):  # the least loop that so many operators tell
        raise InputError(
            f"record {slow.name}: its input turns back by "
            f"{sized(back, slow.input.unit)} at most, and so shows no loop; expected a "
            "record that goes up and down: name another under 'identification' in "
            "dataset.yaml, or take --model linear"
        )
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
    if not found.reached:
        left = rms(slow.y - found.simulate(slow.u))
        note += f". {_leaves(slow, left, evidence)}"
    return IdentifiedGpi("gpi", evidence.input, evidence.output, chain), note


def _way_back(u: FloatArray) -> float:
    """Give how far an input goes back at most: down after it rose, or up after."""
    rises = np.max(u - np.minimum.accumulate(u))
    falls = np.max(np.maximum.accumulate(u) - u)
    return float(min(rises, falls))


def _leaves(record: Record, left: float, evidence: Evidence) -> str:
    """Say what it means that a base is not as near to its record as was asked."""
    unit = record.output.unit
    noise = evidence.noise_rms
    known = "" if noise is None else f", with a noise of {noise:.3g} {unit}"
    share = left / max(float(np.std(record.y)), 1e-300)
    told = (
        f"So it leaves {left:.3g} {unit} rms of record {record.name}, "
        f"{100 * share:.2g} % of its output{known}"
    )
    if noise is not None and left**2 <= (1 + ABOVE_NOISE) * noise**2:
        return f"{told}: that is noise, and the loop fits its record"
    return (
        f"{told}: an effect smaller than that can hide in the base's own error. Name a "
        "slower or less noisy record under 'identification' in dataset.yaml, bring a "
        "model of your own (--model FILE), or take --model linear for what has no loop"
    )

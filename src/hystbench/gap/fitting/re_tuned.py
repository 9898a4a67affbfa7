"""How far a base moved whose numbers and timing are known only about, in words."""

from __future__ import annotations

from hystbench.blocks.input_delay import InputDelay
from hystbench.gap.fitting.state import ModelState
from hystbench.sentences import finely, shortly


def re_tuned_words(start: ModelState, state: ModelState) -> str:
    """Say which number of a base the fit moved most, and how late its input is.

    Parameters
    ----------
    start : ModelState
        The base on the fit records, its free numbers as they are given.
    state : ModelState
        A model with effects, beside which they were re-tuned.
    """
    own = {place for item in state.added for place in item.blocks}
    left = [k for k in range(len(state.chain)) if k not in own]
    if len(left) != len(start.chain):
        return "its numbers and its timing were re-tuned"  # an effect stands for one
    moves, late = [(0.0, "")], ""
    for free in start.free:
        block = state.chain[left[free.block]]
        was = start.value(free)
        now = state.value(free._replace(block=left[free.block]))
        if isinstance(block, InputDelay) and free.parameter == "delay_s":
            samples = (now - was) / min(record.dt for record in start.records)
            word = "late" if samples > 0 else "early"
            late = f"its input counts as {shortly(abs(samples), 2)} samples {word}"
        else:
            moves.append((abs(now / was - 1.0), free.parameter))
    far, name = max(moves)
    most = f"{name} moved most, by {finely(far)}" if name else ""
    return " and ".join(part for part in (most, late) if part)

"""A fit in stages: first to records in which a force shows little, then to all.

A mass on a hardening spring, or near a stop, may have two steady motions. A record that
jumps from one to the other jumps elsewhere when the numbers change a little, so that a
fit to it stops anywhere. Where the model without the force explains most, there is one
motion. These records lead the numbers to where the others can be followed
(continuation [1]_).

References
----------
.. [1] E. L. Allgower, K. Georg, "Introduction to Numerical Continuation Methods",
   SIAM, 2003, doi:10.1137/1.9780898719154.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hystbench.gap.fitting.least_squares import Fitted, fitted, fitted_to_the_end
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import ScoredSamples


def gentlest(state: ModelState) -> tuple[int, ...]:
    """Give half of the records: those of whose output a model leaves the least share.

    None of a single record.
    """
    outputs = [np.var(state.measured[part]) for part in state.sample.slices]
    shares = state.squares / np.maximum(outputs, 1e-300)
    order = np.argsort(shares, kind="stable").tolist()
    return tuple(sorted(order[: len(order) // 2]))


def in_stages(state: ModelState, first: Sequence[int], score: Score) -> Fitted:
    """Fit a model to some of its records, and from there to all.

    Parameters
    ----------
    state : ModelState
    first : sequence of int
        Places of the records that are fitted first.
    score : Score
        Of all records.
    """
    records = tuple(state.records[k] for k in first)
    some = replace(state, records=records, sample=ScoredSamples.of(records))
    near = fitted(some.settled(), Score.plain(some.sample, score.floor)).state
    whole = replace(near, records=state.records, sample=state.sample)
    return fitted_to_the_end(whole.settled(), score)

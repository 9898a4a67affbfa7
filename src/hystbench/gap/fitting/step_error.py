"""The floor that adding effects ends at: noise, and what the simulator's steps miss."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.records.scored_samples import rms
from hystbench.gap.simulation.simulation import Simulation


def step_error(state: ModelState) -> float | None:
    """Measure what the plain simulation misses by its steps, RMS over scored samples.

    The state's own residual is that of a simulation in short steps. None where the
    chain holds a simulator whose inside is not seen: nobody knows its steps.
    """
    if not all(block.seen for block in state.chain):
        return None
    plain = state.sample.take(Simulation(state.chain, state.records, state.hold).output)
    return rms(plain - (state.measured - state.residual))


def floor_with_steps(noise_rms: float, error: float | None) -> float:
    """Give the RMS of noise and step error together: neither knows of the other.

    Where the step error is not known it is that of the noise.
    """
    return noise_rms if error is None else float(np.hypot(noise_rms, error))


def above_floor(state: ModelState, score: Score) -> float:
    """Tell how much could be gained in the score if all went that is no noise or step.

    Parameters
    ----------
    state : ModelState
    score : Score
        Its floor is that of the noise.
    """
    floor = floor_with_steps(float(np.sqrt(score.floor)), step_error(state)) ** 2
    whole = replace(score, floor=floor)
    return score_of(state, whole) - whole.least(state.freedom)

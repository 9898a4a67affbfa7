"""Algorithm 1 on a slow record as the settings of a job ask for it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from hystbench.envelope import PUBLISHED_ENVELOPE
from hystbench.identification import Identification, Progress, identify
from hystbench.identification.shape import envelope_scale
from hystbench.record import Record


def identify_slow_loop(
    slow: Record, settings: Mapping[str, Any], progress: Progress | None = None
) -> Identification:
    """Identify envelope functions, thresholds and weights on a slow record.

    On the twin the published envelopes are fitted beside the identified ones, and
    these get the same scale: data cannot tell it, and the GPO filter's convergence
    factor depends on it.

    Parameters
    ----------
    slow : Record
    settings : mapping
        ``tolerable_relative_error``, ``order``, ``max_iterations``, ``starts`` and
        ``seed``.
    progress : callable, optional
        As for :func:`hystbench.identification.identify`.
    """
    tolerable = settings["tolerable_relative_error"]
    twin = slow.origin == "twin"
    span = float(slow.u.min()), float(slow.u.max())
    return identify(
        slow.u,
        slow.y,
        settings["order"],
        epsilon=tolerable**2 * float(np.sum(slow.y**2)),
        max_iterations=settings["max_iterations"],
        starts=settings["starts"],
        seed=settings["seed"],
        scale=envelope_scale(PUBLISHED_ENVELOPE, *span) if twin else None,
        published=PUBLISHED_ENVELOPE if twin else None,
        progress=progress,
    )

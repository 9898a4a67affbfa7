"""Many filters at once, on all processors."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor

from numpy.typing import ArrayLike

from hystbench.filters.base import AdaptiveFilter, Result


def run_many(
    jobs: Iterable[tuple[AdaptiveFilter, ArrayLike, ArrayLike]],
    workers: int | None = None,
    limit: float | None = None,
) -> list[Result]:
    """Run many filters at once: step sizes, orders, seeds.

    Each job runs as it would alone, so the results do not depend on ``workers``.
    Jobs may share their arrays.

    Parameters
    ----------
    jobs : iterable of (AdaptiveFilter, array_like, array_like)
        Filter, input x and plant output d.
    workers : int, optional
        Threads; by default one for each processor.
    limit : float, optional
        As for :meth:`AdaptiveFilter.run`.

    Returns
    -------
    list of Result
        In the order of the jobs.
    """
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        running = [pool.submit(item.run, x, d, None, limit) for item, x, d in jobs]
        return [job.result() for job in running]

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
        Threads; by default one for each processor that this process may use.
    limit : float, optional
        As for :meth:`AdaptiveFilter.run`.

    Returns
    -------
    list of Result
        In the order of the jobs.
    """
    listed = list(jobs)
    done: list[Result | None] = [None] * len(listed)
    todo = iter(range(len(listed)))  # one for all: each thread takes the next

    def work(_: int) -> None:
        for k in todo:
            item, x, d = listed[k]
            done[k] = item.run(x, d, None, limit)

    count = workers or len(os.sched_getaffinity(0))
    with ThreadPoolExecutor(count) as pool:
        list(pool.map(work, range(count)))  # so that what one raises is raised here
    return [result for result in done if result is not None]

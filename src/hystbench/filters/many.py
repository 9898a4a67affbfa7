"""Many filters at once, on all processors."""

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor

from numpy.typing import ArrayLike

from hystbench.filters.base import AdaptiveFilter
from hystbench.filters.state import Result
from hystbench.filters.together import but_step_size, run_together

Job = tuple[AdaptiveFilter, ArrayLike, ArrayLike]

MOST = 32
"""Filters that are run together: their results share memory."""

SHARES = 4
"""Batches for each thread, where there are several threads and as many filters."""


def run_many(
    jobs: Iterable[Job],
    workers: int | None = None,
    limit: float | None = None,
) -> list[Result]:
    """Run many filters at once: step sizes, orders, seeds.

    Each job gives what it would give alone, so the results do not depend on
    ``workers``. Jobs may share their arrays. Filters that differ in step size alone
    are run together where x and d are the very same arrays: what comes before the
    weights is then the same.

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
        In the order of the jobs. Those that were run together share memory.
    """
    listed = list(jobs)
    done: list[Result | None] = [None] * len(listed)
    count = workers or len(os.sched_getaffinity(0))
    todo = iter(_batches(listed, count))  # one for all: each thread takes the next

    def work(_: int) -> None:
        for batch in todo:
            x, d = listed[batch[0]][1:]
            results = run_together([listed[k][0] for k in batch], x, d, None, limit)
            for k, result in zip(batch, results, strict=True):
                done[k] = result

    with ThreadPoolExecutor(count) as pool:
        list(pool.map(work, range(count)))  # so that what one raises is raised here
    return [result for result in done if result is not None]


def _batches(jobs: Sequence[Job], workers: int) -> list[list[int]]:
    """Divide jobs, by number, into what one thread runs together.

    Each time threads change places at the interpreter's lock costs as much as a good
    part of a short run, so a batch should be large; but all threads should end at the
    same time, so there should be several for each. Filters in a batch stand in the
    order of their step sizes: those that diverge are then neighbours, and so are
    those that :func:`run_together` goes on with.
    """
    alike: dict[object, list[int]] = {}
    for number, (item, x, d) in enumerate(jobs):
        same = tuple(but_step_size(item).items())
        alike.setdefault((same, id(x), id(d)), []).append(number)
    parts = SHARES * workers if workers > 1 else 1
    batches = []
    for numbers in alike.values():
        numbers.sort(key=lambda number: jobs[number][0].step_size)
        size = min(MOST, -(-len(numbers) // parts))
        batches += [numbers[k : k + size] for k in range(0, len(numbers), size)]
    return sorted(batches)

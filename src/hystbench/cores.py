"""The same work for many items, on several cores.

Each core runs a copy of this process, made by fork: it has all that the work needs and
gives back only what it found, so that a result is the same on any number of cores. On
Linux alone: other systems do not fork a process safely that has used their libraries.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import IO, Any, NoReturn, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

WORTH_S = 0.1
"""Work of less time is not shared: a copy of the process costs some hundredths."""
PLACE = 4
"""Bytes in which the place of an item is told."""


@dataclass
class Cores:
    """How many cores may be used, and what work took so far."""

    count: int
    seconds: dict[str, float] = field(default_factory=dict)
    """For a unit of effort, by the kind of work."""


_current: ContextVar[Cores | None] = ContextVar("cores", default=None)


def available() -> int:
    """Count the cores that this process may use; one where it cannot be copied."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1


@contextmanager
def on_cores(count: int) -> Iterator[None]:
    """Let :func:`each` use so many cores within the block."""
    most = min(count, available())
    before = _current.set(Cores(most) if most > 1 else None)
    try:
        yield
    finally:
        _current.reset(before)


def unchanged(result: Any, item: Any = None) -> Any:
    """Give a result as it is."""
    return result


def each(
    function: Callable[[Item], Result],
    items: Sequence[Item],
    kind: str,
    effort: float = 1.0,
    seconds: float = 0.0,
    write: Callable[[Result], Any] = unchanged,
    read: Callable[[Any, Item], Result] = unchanged,
) -> list[Result]:
    """Give a function of every item, in their order.

    Parameters
    ----------
    function : callable
        Changes nothing outside.
    items : sequence
    kind : str
        Words for the work. It is shared once work of its kind was seen to take long.
    effort : float
        Of an item, in a unit of the kind's own.
    seconds : float
        That a unit of it takes, about, as long as nothing of its kind was seen.
    write, read : callable
        To what pickle can hold, and back beside the item.

    Raises
    ------
    Exception
        What the function raises for the first item for which it does.
    ChildProcessError
        If a copy of the process ends before its work does.
    """
    cores = _current.get()
    if cores is None or len(items) < 2:
        return [function(item) for item in items]
    begun = time.perf_counter()
    efforts = effort * len(items)
    worth = cores.seconds.get(kind, seconds) * efforts > WORTH_S
    used = min(cores.count, len(items)) if worth else 1
    alone = _current.set(None)
    try:
        if worth:
            whole = _shared(lambda item: write(function(item)), items, used)
            found = [read(own, item) for own, item in zip(whole, items, strict=True)]
        else:
            found = [function(item) for item in items]
    finally:
        _current.reset(alone)
    cores.seconds[kind] = (time.perf_counter() - begun) * used / efforts
    return found


def _shared(
    function: Callable[[Item], Any], items: Sequence[Item], cores: int
) -> list[Any]:
    """Work on items in this process and in copies of it: whoever is free takes one."""
    import tempfile  # late: commands that share nothing need none of it

    with ExitStack() as files:
        ask, tell = os.pipe()
        files.callback(os.close, ask)
        for place in range(len(items)):
            os.write(tell, place.to_bytes(PLACE, "little"))
        os.close(tell)
        copies: list[tuple[int, IO[bytes]]] = []
        try:
            for _ in range(cores - 1):
                file: IO[bytes] = files.enter_context(tempfile.TemporaryFile())
                copy = os.fork()
                if copy == 0:
                    _work_and_end(function, items, ask, file)
                copies.append((copy, file))
            found = _taken(function, items, ask)
            while copies:
                copy, file = copies[-1]
                _, status = os.waitpid(copy, 0)
                copies.pop()
                if status:
                    raise ChildProcessError(
                        f"a copy of the process ended with status {status}; expected "
                        "memory for each: --cores 1 needs least"
                    )
                file.seek(0)
                found |= pickle.load(file)  # noqa: S301  (a copy of this process wrote it)
        finally:
            for copy, _ in copies:
                os.kill(copy, signal.SIGKILL)
                os.waitpid(copy, 0)
    for place in sorted(found):
        if isinstance(found[place], _Raised):
            raise found[place].error
    return [found[place] for place in range(len(items))]


@dataclass(frozen=True)
class _Raised:
    """An error in the place of a result."""

    error: Exception


def _taken(
    function: Callable[[Item], Any], items: Sequence[Item], ask: int
) -> dict[int, Any]:
    """Take items while there are any; give results by their places."""
    found: dict[int, Any] = {}
    while told := os.read(ask, PLACE):
        place = int.from_bytes(told, "little")
        try:
            found[place] = function(items[place])
        except Exception as error:
            found[place] = _Raised(error)
    return found


def _work_and_end(
    function: Callable[[Item], Any], items: Sequence[Item], ask: int, file: IO[bytes]
) -> NoReturn:
    """Do what a copy has to do; it never goes back to where it was copied."""
    status = 1
    try:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_DFL)  # the first process tells of it
        pickle.dump(_taken(function, items, ask), file)
        file.flush()
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(status)

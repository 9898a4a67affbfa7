"""Ctrl-C: one line and exit status 130, at whatever moment it comes.

Python's own way, an exception at any instruction, prints a traceback where libraries
are being imported, and is dropped where an object is being deleted. So the signal
waits while anything is being imported, or while files take their places; and where
its exception was dropped it comes again.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType

TOLD = "hystbench: interrupted"
#: Seconds between two looks at a signal that has to wait.
AGAIN_S = 0.01
#: Added to a signal's number, as a shell does: 130 for Ctrl-C.
STATUS = 128

#: Seconds that an import may make a signal wait: a user's module may run for long.
LONGEST_S = 2.0


@dataclass
class _State:
    """Where the one handler of this process is."""

    held: int = 0
    """How many blocks are running that must not be cut in two."""
    waiting: int = 0
    """Number of the signal that waits, or was raised last; 0 before any came."""
    since: float = 0.0
    """When it came, on the clock that never goes back."""
    raised: bool = False
    """Whether it was raised and not dropped, so that things are being tidied up."""


_state = _State()


class Interrupted(BaseException):
    """Ctrl-C, or a request to end.

    No ``KeyboardInterrupt``: libraries print something of their own for that.

    Parameters
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.status = STATUS + number


@contextmanager
def held() -> Iterator[None]:
    """Let signals wait until the end of the block."""
    _state.held += 1
    try:
        yield
    finally:
        _state.held -= 1


def listen() -> None:
    """Raise :class:`Interrupted` in the main thread for SIGINT and SIGTERM.

    A signal that is ignored, as in the background of a shell script, stays ignored.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _come)
    signal.signal(signal.SIGALRM, _come)
    sys.unraisablehook = _dropped


def end_at_once() -> None:
    """From here on a signal ends the process, for there is nothing left to tidy up.

    One that was told already changes nothing any more.

    Raises
    ------
    Interrupted
        If a signal has come and waits still: imports made it wait to the end.
    """
    signal.setitimer(signal.ITIMER_REAL, 0)
    if _state.waiting and not _state.raised:
        _state.raised = True
        raise Interrupted(_state.waiting)
    last = signal.SIG_IGN if _state.raised else _end
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is _come:
            signal.signal(number, last)


def _come(number: int, frame: FrameType | None) -> None:
    again = number == signal.SIGALRM
    if again and _state.raised:
        return  # was on its way when the signal was raised
    if not again and _state.waiting and not _state.held:
        _end(number, frame)  # asked a second time
    if not again and not _state.waiting:
        _state.waiting, _state.since = number, time.monotonic()
    waited = time.monotonic() - _state.since
    if _state.held or (waited < LONGEST_S and _importing(frame)):
        _look_again()
        return
    signal.setitimer(signal.ITIMER_REAL, 0)
    _state.raised = True
    raise Interrupted(_state.waiting)


def _look_again() -> None:
    """Look at the signal every now and then until it is raised.

    Once would not do: Python sees a signal that comes just before a long call of the
    system only when the call ends, and the next one ends the call.
    """
    signal.setitimer(signal.ITIMER_REAL, AGAIN_S, AGAIN_S)


def _importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _dropped(about: sys.UnraisableHookArgs) -> None:
    """Bring a signal back whose exception could not be raised where it came."""
    if isinstance(about.exc_value, Interrupted):
        _state.raised = False
        _look_again()
    else:
        sys.__unraisablehook__(about)


def _end(number: int, frame: FrameType | None) -> None:
    os.write(2, f"{TOLD}\n".encode())
    os._exit(STATUS + number)

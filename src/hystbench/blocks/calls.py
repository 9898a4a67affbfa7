"""Calls of simulators of somebody's own: kept, counted, bounded, and told of."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from hashlib import blake2b
from typing import TYPE_CHECKING

import numpy as np

from hystbench.blocks.kept_outputs import KeptOutputs
from hystbench.errors import InputError
from hystbench.record import FloatArray

if TYPE_CHECKING:
    from hystbench.blocks.simulator import Simulator

MEMORY = 2**24
"""Samples that are kept in memory: the same input asked again costs no call."""
WORTH = 0.01
"""Seconds that a call must take for its output to go to disk, which takes far less."""
PATIENCE = 30.0
"""Seconds of calls above which work is told of, before and while it goes on."""
EVERY = 5.0
"""Seconds between two lines of progress, at least."""

USED_UP = "the calls that --calls allows are used up"


class CallsUsedUp(InputError):  # noqa: N818  (a bound that was asked for)
    """The calls that a user allows are used up."""


@dataclass
class Calls:
    """Outputs of simulators, each made by a call or known from an earlier one."""

    bound: int | None = None
    """Calls that may be made at most."""
    reserve: int = 0
    """Calls of the bound that are kept back, until it is set to zero."""
    kept: KeptOutputs | None = None
    """Outputs on disk, of this run and of earlier ones."""
    say: Callable[[str], None] = lambda _: None
    """Told a line of progress at a time."""
    clock: Callable[[], float] = time.monotonic
    """Gives seconds."""
    worth: float = WORTH
    """Seconds that a call must take for its output to go to disk."""
    made: int = field(default=0, init=False)
    """Calls that were made."""
    found: int = field(default=0, init=False)
    """Calls that outputs on disk have spared."""
    seconds: float = field(default=0.0, init=False)
    """What the calls took together."""
    expected: int = field(default=0, init=False)
    """Calls likely to be needed at most, with those made and spared; 0: not known."""
    _memory: dict[tuple[str, bytes, int, float], FloatArray] = field(
        default_factory=dict, init=False, repr=False
    )
    _samples: int = field(default=0, init=False, repr=False)
    _begun: set[str] = field(default_factory=set, init=False, repr=False)
    _refused: bool = field(default=False, init=False, repr=False)
    _told: float | None = field(default=None, init=False, repr=False)
    _first: float = field(default=0.0, init=False, repr=False)

    @property
    def asked(self) -> int:
        """Outputs that were needed so far, made or spared."""
        return self.made + self.found

    @property
    def mean_seconds(self) -> float:
        """What a call took, in the mean.

        The first one imports or starts the simulator, so it counts only while it is
        the only one.
        """
        if self.made < 2:
            return self.seconds
        return (self.seconds - self._first) / (self.made - 1)

    def output(self, simulator: Simulator, z: FloatArray, dt: float) -> FloatArray:
        """Give what a simulator gives for samples, or what it gave for them before.

        The first input of each one is called in any case, and what the disk has of it
        is held against that: a simulator may read a file that has changed.

        Parameters
        ----------
        simulator : Simulator
        z : ndarray, shape (n,)
        dt : float
            Sampling interval in seconds.

        Returns
        -------
        ndarray, shape (n,)

        Raises
        ------
        CallsUsedUp
            If a call is needed, and no more are allowed.
        InputError
            As :meth:`Simulator.call` does.
        """
        digest = blake2b(z.tobytes(), digest_size=16).digest()
        key = (simulator.label, digest, len(z), dt)
        if key not in self._memory:
            self._remember(key, self._found_or_made(simulator, z, dt))
        return self._memory[key].copy()

    def fresh(self, simulator: Simulator, z: FloatArray, dt: float) -> FloatArray:
        """Call a simulator, whatever it gave before; the output is not kept.

        Raises
        ------
        CallsUsedUp
            If no more calls are allowed.
        InputError
            As :meth:`Simulator.call` does.
        """
        return self._made(simulator, z, dt)[0]

    def refused(self) -> bool:
        """Tell whether a call was needed that the bound did not allow."""
        return self._refused

    def _found_or_made(
        self, simulator: Simulator, z: FloatArray, dt: float
    ) -> FloatArray:
        kept, name = self.kept, simulator.label
        first = name not in self._begun
        if kept is not None and not first:
            known = kept.get(name, z, dt)
            if known is not None:
                self.found += 1
                return known
        y, took = self._made(simulator, z, dt)
        known = None
        if kept is not None and first:
            # Only now is all imported that the function is made of.
            kept.open(name, simulator.source())
            known = kept.get(name, z, dt)
            if known is not None and not np.array_equal(known, y):
                self.say(
                    f"{name}: gives another output than an earlier run kept in "
                    f"{kept.folder}, though its source is the same; what was kept of "
                    "it is dropped"
                )
                kept.drop(name)
                known = None
        self._begun.add(name)
        if kept is not None and known is None and took >= self.worth:
            kept.put(name, z, dt, y)
        return y

    def _made(
        self, simulator: Simulator, z: FloatArray, dt: float
    ) -> tuple[FloatArray, float]:
        """Call a simulator, count the call and take its time."""
        if self.bound is not None and self.made >= self.bound - self.reserve:
            self._refused = True
            raise CallsUsedUp(
                f"{simulator.label}: {USED_UP}: {self.bound}; expected a larger number"
            )
        start = self.clock()
        y = simulator.call(z, dt)
        end = self.clock()
        if not self.made:
            self._first = end - start
        self.made += 1
        self.seconds += end - start
        self._tell(end)
        return y, end - start

    def _remember(self, key: tuple[str, bytes, int, float], y: FloatArray) -> None:
        while self._memory and self._samples + len(y) > MEMORY:
            self._samples -= len(self._memory.pop(next(iter(self._memory))))
        self._memory[key] = y
        self._samples += len(y)

    def _tell(self, now: float) -> None:
        """Say how far calls are, now and then, where they take long."""
        if self.expected * self.mean_seconds < PATIENCE:
            return
        if self._told is None:
            self._told = now  # the first line comes a while after what was foretold
        if now - self._told < EVERY:
            return
        self._told = now
        total = self.expected
        if self.bound is not None:
            total = min(total, self.bound + self.found)
        left = max(total - self.asked, 0) * self.mean_seconds
        spared = (
            f", {self.found:,} spared by outputs kept on disk" if self.found else ""
        )
        self.say(
            f"{self.made:,} calls made{spared}; at most about {total:,} in "
            f"all, {minutes(left)} left"
        )


def minutes(seconds: float) -> str:
    """Say a time in minutes, or in hours where there are many."""
    if seconds < 90:
        return "1 minute"
    if seconds < 7200:
        return f"{seconds / 60:.0f} minutes"
    return f"{seconds / 3600:.1f} hours"


_current = Calls()


def current() -> Calls:
    """Give where calls go now: in memory alone, unless :func:`counted` says more."""
    return _current


@contextmanager
def counted(calls: Calls) -> Iterator[Calls]:
    """Let all calls within the block go by ``calls``."""
    global _current
    before, _current = _current, calls
    try:
        yield calls
    finally:
        _current = before

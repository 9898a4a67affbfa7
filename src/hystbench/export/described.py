"""A model as steps: what each block calls at a sample, with names for all it keeps."""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from hystbench.blocks.base import Block
from hystbench.blocks.force import Driven, Dynamics
from hystbench.blocks.step import (
    LARGEST_POINTS,
    UNKNOWN_PAST,
    Sampling,
    Step,
)
from hystbench.blocks.superposed import Superposed
from hystbench.blocks.wrapping import Wrapped
from hystbench.errors import InputError, placed
from hystbench.model import Model
from hystbench.record import Channel, FloatArray

#: Keywords of C and C++ that a model may be called, and the standard headers.
C_WORDS = """
alignas alignof asm auto bool break case char class const constexpr continue default do
double else enum extern float for goto if inline int long new nullptr register restrict
return short signed sizeof static struct switch template this thread_local typedef
typeof union unsigned using virtual void volatile while
assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal
stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib
stdnoreturn string tgmath threads time uchar wchar wctype
"""
#: Windows makes no files of these names.
DEVICES = {"aux", "con", "nul", "prn"} | {
    f"{port}{number}" for port in ("com", "lpt") for number in range(1, 10)
}
#: So begin functions of C that are copied, and what stands beside a unit's sources.
OPENINGS = ("hb_", "fmi")
TAKEN = (
    {*keyword.kwlist, *C_WORDS.split(), "numpy", "hb"}
    | {name.lower() for name in sys.stdlib_module_names}
    | DEVICES
)
LARGEST_STATE = 1_000_000
"""Numbers of 8 bytes that a state may hold: 8 MB, far more than a controller has."""


@dataclass(frozen=True)
class Piece:
    """One block's step, and for one that wraps hysteresis what is inside."""

    label: str
    step: Step
    inner: Piece | None = None
    wait: int = 0
    """Calls, from the first on, in which nothing comes out of it yet; none where what
    is before it waits as long."""

    @property
    def history(self) -> str:
        """Name the state that the model's input is kept in."""
        return f"{self.label}_history"

    @property
    def takes(self) -> list[str]:
        """Name what it takes inside another: a signal, and a factor on thresholds."""
        return ["v"] + ["growth"] * self.step.grows

    @property
    def each(self) -> list[str]:
        """Name the same where what is around it drives it several times a sample."""
        return [f"{name}s[i]" for name in self.takes]

    @property
    def states_inside(self) -> list[str]:
        """Name the states of the piece and of what is inside it."""
        return [
            f"{part.label}_{state}"
            for part in self.all_inside()
            for state in part.step.states
        ]

    def all_inside(self) -> Iterator[Piece]:
        """Give the piece and what is inside it, the innermost first."""
        if self.inner is not None:
            yield from self.inner.all_inside()
        yield self


@dataclass(frozen=True)
class Described:
    """A model as the pieces that its signal passes, one call of each a sample."""

    name: str
    """The model's name as an identifier of C and of Python."""
    title: str
    """The model's name as its file has it, in one line of printable letters."""
    input: Channel
    output: Channel
    sampling: Sampling
    pieces: tuple[Piece, ...]
    starts: Mapping[str, FloatArray] = field(default_factory=dict)
    """What states are at the start, by name; the others are zero."""

    def all_pieces(self) -> Iterator[Piece]:
        """Give every piece, what is inside another before it."""
        for piece in self.pieces:
            yield from piece.all_inside()

    def all_states(self) -> Iterator[tuple[str, int]]:
        """Give the name and length of every state."""
        if self.sampling.delay:
            yield "calls", 1
        for piece in self.all_pieces():
            for name, length in piece.step.states.items():
                yield f"{piece.label}_{name}", length

    @property
    def functions(self) -> set[str]:
        """Name the functions that are called."""
        called = {piece.step.function for piece in self.all_pieces()}
        return called | {"remember" for piece in self.watching}

    @property
    def watching(self) -> list[Piece]:
        """Give the pieces whose history is of the model's input."""
        return [piece for piece in self.all_pieces() if piece.step.watches]

    @property
    def differences(self) -> list[str]:
        """Say how the steps differ from :meth:`Model.simulate`, a sentence each."""
        delay = self.sampling.delay
        late = [
            f"The output is late by {delay} sample{'s' * (delay > 1)} "
            f"({delay * self.sampling.dt:.12g} s), as asked; the first "
            f"{f'{delay} are' if delay > 1 else 'is'} 0."
        ]
        told = late[: bool(delay)]
        for piece in self.all_pieces():
            own = [piece.step.differs]
            if not self.starts:
                own.append(UNKNOWN_PAST.get(piece.step.past, ""))
            said = "; ".join(filter(None, own))
            if said:
                told.append(f"{piece.label} {said}.")
        return told

    @property
    def begins(self) -> str:
        """Say what the code has seen at its start."""
        if self.starts:
            return "It starts as on the record that it was exported with."
        return "Nothing has ever entered."

    @property
    def memory(self) -> str:
        """Say how much the code keeps from sample to sample."""
        count = sum(length for _, length in self.all_states())
        return f"Its state holds {count} numbers, {8 * count} bytes."

    @property
    def about(self) -> str:
        """Say what the code computes."""
        return (
            f"{self.output.name} ({self.output.unit}) of {self.input.name} "
            f"({self.input.unit}), one call a sample of {self.sampling.dt:.12g} s"
        )


Maker = Callable[[Sampling], Piece]
"""Makes a piece for what is known of the signal at its place."""


def _shares(delay: int, pieces: Sequence[Piece]) -> list[int]:
    """Divide a delay among the pieces that gain by it.

    Those that take a rate get the samples that make it exact first; the rest goes
    round.

    Raises
    ------
    InputError
        If no piece gains, or the delay is more than they gain by.
    """
    turns = _turns(pieces)
    if not turns:
        raise InputError(
            f"--delay: {delay}; expected none, as no step of this model is nearer to "
            "the simulation where samples to come are known"
        )
    if delay > len(turns):
        raise InputError(
            f"--delay: {delay}; expected at most {len(turns)}, with which the code is "
            "the simulation or as near as it gets"
        )
    first = sorted(turns, key=lambda turn: turn[0] >= pieces[turn[1]].step.rates)
    taken = [place for _, place in first[:delay]]
    return [taken.count(place) for place in range(len(pieces))]


def _turns(pieces: Sequence[Piece]) -> list[tuple[int, int]]:
    """Give, in turn, each sample to come that a piece gains by: how many before, place.

    What looks at the model's input itself has the delay of a piece before it.
    """
    gains: dict[int, int] = {}
    for place, piece in enumerate(pieces):
        if piece.step.gains and not (piece.step.watches and gains):
            gains[place] = piece.step.gains
    most = max(gains.values(), default=0)
    return [
        (turn, place)
        for turn in range(most)
        for place, count in gains.items()
        if turn < count
    ]


def exact_delay(described: Described) -> int:
    """Give the delay with which code is the simulation, or as near as it gets.

    Parameters
    ----------
    described : Described
        Of the model, without a delay.
    """
    return len(_turns(described.pieces))


def describe(model: Model, sampling: Sampling) -> Described:
    """Ask every block for its step.

    Raises
    ------
    InputError
        If the interval or the points make no sense, or a block cannot be exported.
    """
    _check_sampling(sampling)
    piece_of = pieces_of(model)
    makers: list[Maker] = [partial(piece_of, step) for step in model.steps]
    return arranged(model.name, model.input, model.output, makers, sampling)


def pieces_of(model: Model) -> Callable[[Any, Sampling], Piece]:
    """Give what makes the piece of any step of a model, and of what is inside it."""
    labels = labels_of(model)
    places = {id(block): place for place, block in enumerate(model.chain, start=1)}

    def of_block(
        block: Block | Dynamics, tells: Block | Driven, sampling: Sampling
    ) -> Piece:
        """Ask for the step of a block, alone or with the forces inside it."""
        with placed(f"chain: block {places[id(block)]}: "):
            step = tells.step(sampling)
            size = sum(step.states.values())
            if size > LARGEST_STATE:
                raise InputError(
                    f"{block.name}: code would keep {size:.3g} numbers at --dt "
                    f"{sampling.dt:g} s; expected at most {LARGEST_STATE}: a shorter "
                    "memory or a longer --dt"
                )
            return Piece(labels[id(block)], step)

    def of_step(step: Any, sampling: Sampling) -> Piece:
        if isinstance(step, Driven):
            return of_block(step.host, step, sampling)
        if not isinstance(step, Wrapped | Superposed):
            return of_block(step, step, sampling)
        around = of_step(step.by, sampling)
        if isinstance(step, Superposed):  # both get the same input, and stay in step
            beside = of_step(step.inner, sampling)
            gains = max(around.step.gains, beside.step.gains)
            both = replace(around.step, gains=gains)
            return replace(around, step=both, inner=beside)
        times = max(around.step.drives, 1)
        inner = of_step(step.inner, replace(sampling, dt=sampling.dt / times, ahead=0))
        return replace(around, inner=inner)

    return of_step


def labels_of(model: Model) -> dict[int, str]:
    """Give an identifier for each block, by the block's ``id``."""
    return {id(block): plain(label) for label, block in model.labelled()}


def arranged(
    name: str,
    enters: Channel,
    leaves: Channel,
    makers: Sequence[Maker],
    sampling: Sampling,
) -> Described:
    """Make the pieces of a chain, and divide its delay among them.

    Parameters
    ----------
    name : str
    enters, leaves : Channel
    makers : sequence of callable
        Each gives a piece, from what is known of the signal there.
    sampling : Sampling

    Raises
    ------
    InputError
        If the interval, the points or the delay make no sense.
    """
    _check_sampling(sampling)
    pieces = [make(sampling) for make in makers]
    if sampling.delay:
        shares, late = _shares(sampling.delay, pieces), 0
        plain, pieces = pieces, []
        for make, usual, share in zip(makers, plain, shares, strict=True):
            watches = usual.step.watches
            late += share
            own = make(replace(sampling, ahead=0 if watches else share, late=late))
            if watches and share:  # what enters it waits; what it looks at does not
                ring = Step("late", {"samples": share}, {"kept": share})
                pieces.append(Piece(f"{own.label}_late", ring, wait=late))
            pieces.append(replace(own, wait=late if share and not watches else 0))
    return Described(
        identifier(name),
        one_line(name) or "model",
        Channel(one_line(enters.name) or "input", one_line(enters.unit)),
        Channel(one_line(leaves.name) or "output", one_line(leaves.unit)),
        sampling,
        tuple(pieces),
    )


def _check_sampling(sampling: Sampling) -> None:
    if not 0 < sampling.dt < float("inf"):
        raise InputError(f"--dt: {sampling.dt:g} s; expected a time above 0")
    duration = sampling.duration_s
    if duration is not None and not 0 < duration < float("inf"):
        raise InputError(f"--duration: {duration:g} s; expected a time above 0")
    if not 2 <= sampling.points <= LARGEST_POINTS:
        raise InputError(
            f"--points: {sampling.points}; expected 2 to {LARGEST_POINTS} samples"
        )
    if sampling.delay < 0:
        raise InputError(f"--delay: {sampling.delay}; expected 0 or more samples")


def identifier(name: str) -> str:
    """Turn a name into an identifier of C and of Python, and into a file's name.

    Names of modules, headers, keywords and the like get an ending: a file ``math.py``
    would stand in the way of Python's own.
    """
    word = plain(name)
    return f"{word}_model" if word in TAKEN or word.startswith(OPENINGS) else word


def one_line(text: str) -> str:
    """Make a user's text one line without control or other unprintable characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def plain(name: str) -> str:
    """Write a name in small letters, digits and underscores, no digit first."""
    word = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_") or "model"
    return f"model_{word}" if word[0].isdigit() else word

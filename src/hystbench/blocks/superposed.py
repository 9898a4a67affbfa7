"""Blocks beside dynamics with forces: they have its input, and add to its output."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from hystbench.blocks.attached import (
    AttachedBlock,
    OthersOnRecords,
    Signals,
    Simulated,
    near,
    sent,
)
from hystbench.blocks.force import Driven, Force
from hystbench.blocks.forced import ForcedDynamics
from hystbench.errors import InputError
from hystbench.record import FloatArray

KEPT = 256
"""Responses that are kept, at most: of each mode to each record, quick and exact."""
_Response = tuple[FloatArray, FloatArray]
_KEPT: OrderedDict[tuple[int, float, Simulated], _Response] = OrderedDict()


class BesideBlock(AttachedBlock, place="inside"):
    """A block with the input of the dynamics before it, added to their output.

    In the chain it stands behind the forces inside them.
    """

    hosts = "mechanism, structure or a force inside one"

    def attach(self, before: Any) -> Superposed:
        """Add the response to the output of what stands before."""
        host = before.host if isinstance(before, Driven) else before
        if not isinstance(host, ForcedDynamics | Superposed):
            raise InputError(
                f"expected {self.hosts} just before it, got "
                f"{getattr(before, 'name', 'none')}"
            )
        return Superposed(before, self)


@dataclass(frozen=True)
class Superposed:
    """A mechanism with its forces, and another mode or all others beside it."""

    inner: Any
    by: Any
    """The block beside, or a mechanism beside with the forces inside it."""

    hysteretic = False
    name: ClassVar[str] = "mechanism and other modes"

    def taking(self, force: Force) -> Superposed:
        """Let a force act inside what was put beside last.

        Raises
        ------
        InputError
            If that is no mechanism.
        """
        return replace(self, by=force.attach(self.by))

    def in_pieces(self, pieces: float) -> Superposed:
        """Take so many steps in place of each, wherever forces act."""
        inner, by = (
            part.in_pieces(pieces) if hasattr(part, "in_pieces") else part
            for part in (self.inner, self.by)
        )
        return replace(self, inner=inner, by=by)

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""
        return self.simulate_records((z,), (dt,))[0]

    def simulate_records(self, signals: Signals, dts: Sequence[float]) -> Signals:
        """Compute the outputs of many records at once."""
        inner, by = (_kept(part, signals, dts) for part in (self.inner, self.by))
        return tuple(a + b for a, b in zip(inner, by, strict=True))

    def near_records(
        self, signals: Signals, dts: Sequence[float], others: OthersOnRecords
    ) -> list[Signals]:
        """Compute the outputs, and those of others with numbers near."""
        inner, by = (
            near(part, signals, signals, dts, own)
            for part, own in (
                (self.inner, [(x.inner, own) for x, own in others]),
                (self.by, [(x.by, own) for x, own in others]),
            )
        )
        return [
            tuple(a + b for a, b in zip(*both, strict=True))
            for both in zip(inner, by, strict=True)
        ]


def _kept(part: Simulated, signals: Signals, dts: Sequence[float]) -> Signals:
    """Compute the responses of a part, or give those that are kept.

    While the numbers of one mode are fitted, the others answer the same records with
    the same numbers again and again.
    """
    keys = [(id(z), dt, part) for z, dt in zip(signals, dts, strict=True)]
    new = [k for k, key in enumerate(keys) if key not in _KEPT]
    given = [signals[k] for k in new]
    responses = sent(part, given, given, [dts[k] for k in new]) if new else ()
    found = dict(zip(new, responses, strict=True))
    for k, y in found.items():
        if not signals[k].flags.writeable:
            y.setflags(write=False)
            _KEPT[keys[k]] = signals[k], y  # with z kept, no other has its identity
    for k, key in enumerate(keys):
        if k not in found:
            _KEPT.move_to_end(key)
            found[k] = _KEPT[key][1]
    while len(_KEPT) > KEPT:
        _KEPT.popitem(last=False)
    return tuple(found[k] for k in range(len(keys)))

"""Blocks beside a mechanism: they have its input and are added to its output."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from hystbench.blocks.attached import AttachedBlock, Others, Simulated, near
from hystbench.blocks.force import Driven, Force
from hystbench.blocks.mechanism import Mechanism
from hystbench.errors import InputError
from hystbench.record import FloatArray

KEPT = 256
"""Responses that are kept, at most: of each mode to each record, quick and exact."""
_Response = tuple[FloatArray, FloatArray]
_KEPT: OrderedDict[tuple[int, float, Simulated], _Response] = OrderedDict()


class BesideBlock(AttachedBlock, place="inside"):
    """A block with the input of the mechanism before it, added to its output.

    In the chain it stands behind the mechanism's forces.
    """

    hosts = "mechanism or a force inside one"

    def attach(self, before: Any) -> Superposed:
        """Add the response to the output of the mechanism before."""
        host = before.host if isinstance(before, Driven) else before
        if not isinstance(host, Mechanism | Superposed):
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
        return _kept(self.inner, z, u, dt) + _kept(self.by, z, u, dt)

    def near(
        self, z: FloatArray, u: FloatArray, dt: float, others: Others
    ) -> list[FloatArray]:
        """Compute the output, and those of others with numbers near."""
        inner = near(self.inner, z, u, dt, [(x.inner, own) for x, own in others])
        by = near(self.by, z, u, dt, [(x.by, own) for x, own in others])
        return [a + b for a, b in zip(inner, by, strict=True)]


def _kept(part: Simulated, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
    """Compute the response of a part, or give the one that is kept.

    While the numbers of one mode are fitted, the others answer the same records with
    the same numbers again and again.
    """
    if z.flags.writeable:
        return part.simulate(z, u, dt)
    key = (id(z), dt, part)
    if key not in _KEPT:
        y = part.simulate(z, u, dt)
        y.setflags(write=False)
        _KEPT[key] = z, y  # with z kept, no other array has its identity
        while len(_KEPT) > KEPT:
            _KEPT.popitem(last=False)
    _KEPT.move_to_end(key)
    return _KEPT[key][1]

"""Block ``other-modes``: what else a force moves beside a mechanism."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from hystbench.blocks.attached import AttachedBlock, near
from hystbench.blocks.base import Block
from hystbench.blocks.force import Driven
from hystbench.blocks.mechanism import Mechanism
from hystbench.blocks.transfer_function import TransferFunction
from hystbench.errors import InputError
from hystbench.record import FloatArray

KEPT = 256
"""Responses that are kept, at most: of each mode to each record, quick and exact."""
_Response = tuple[FloatArray, FloatArray]
_KEPT: OrderedDict[tuple[int, float, Hashable], _Response] = OrderedDict()


@dataclass(frozen=True)
class OtherModes(TransferFunction, AttachedBlock):
    """Linear response to what drives the mechanism before it, added to its output.

    A structure of several modes is a ``mechanism`` for one of them, in which forces
    may act, and the transfer function of all others here (modal superposition [1]_).
    In the chain it stands behind the mechanism's forces.

    References
    ----------
    .. [1] D. J. Ewins, Modal Testing: Theory, Practice and Application, 2nd ed.,
       Research Studies Press, 2000, chapter 2.
    """

    name: ClassVar = "other-modes"
    place: ClassVar = "inside"
    hosts: ClassVar = "mechanism or a force inside one"

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
    """A mechanism with its forces, and other modes beside it."""

    inner: Block | Driven | Superposed
    by: OtherModes

    hysteretic: ClassVar[bool] = False
    name: ClassVar[str] = "mechanism and other modes"

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Compute the output, as :meth:`Block.simulate` does."""
        return _kept(self.inner, z, u, dt) + _kept(self.by, z, u, dt)

    def near(
        self,
        z: FloatArray,
        u: FloatArray,
        dt: float,
        others: Sequence[tuple[Superposed, FloatArray]],
    ) -> list[FloatArray]:
        """Compute the output, and those of others with numbers near."""
        inner = near(self.inner, z, u, dt, [(x.inner, own) for x, own in others])
        by = near(self.by, z, u, dt, [(x.by, own) for x, own in others])
        return [a + b for a, b in zip(inner, by, strict=True)]


def _kept(
    part: Block | Driven | Superposed, z: FloatArray, u: FloatArray, dt: float
) -> FloatArray:
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

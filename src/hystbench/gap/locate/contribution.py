"""What a named effect adds to the output, and the view in which it shows."""

from __future__ import annotations

from dataclasses import dataclass

from hystbench.gap.view_kinds import ViewKind
from hystbench.record import FloatArray


@dataclass(frozen=True)
class Contribution:
    """What a named effect adds to the output of the base on each record.

    Parameters
    ----------
    effect : str
    view : str, optional
        Where it shows, what an engineer looks at first; None where that is not known.
    added : tuple of ndarray, shape (n,)
        In the unit of the output, a record each.
    freedom : float
        Numbers that were fitted for it.
    """

    effect: str
    view: ViewKind | None
    added: tuple[FloatArray, ...]
    freedom: float = 1.0

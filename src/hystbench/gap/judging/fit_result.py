"""What the fit records fix of a decision."""

from __future__ import annotations

from dataclasses import dataclass

from hystbench.gap.fitting.own_values import NONE, OwnValues
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.naming.ladder import Rung
from hystbench.gap.records.black_box import BlackBox
from hystbench.gap.records.floor import Floor
from hystbench.model import Model


@dataclass(frozen=True)
class FitResult:
    """What the fit records fix; hold-out records are compared with it."""

    base: Model
    state: ModelState
    """The model with all effects that were added, on the fit records."""
    floor: Floor
    black_box: BlackBox
    """Fitted to what the base leaves on the fit records."""
    rungs: tuple[Rung, ...]
    """The models on the way from the base to the last effect."""
    own: OwnValues = NONE
    """What some records have of their own: a hold-out record may have the same."""

"""``slider-with-gap``: dry friction in series with a clearance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hystbench.blocks.slider_with_gap import SliderWithGap as Block
from hystbench.gap.effects.effect import ForceEffect
from hystbench.gap.effects.law import Law, Moved


class SliderWithGap(ForceEffect):
    """A slider behind a clearance."""

    name = "slider-with-gap"
    shows = "branch"

    def in_mechanism(self, moved: Moved) -> Iterator[Law]:
        """Offer narrow and wide clearances."""
        names = ("contact_stiffness", "slip_force", "gap")
        for share in (0.03, 0.3):
            block = Block(
                contact_stiffness=3.0 * moved.force / moved.reach,
                slip_force=0.3 * moved.force,
                gap=share * moved.reach,
            )
            yield Law("", block, names)

    def vanishing(self, form: str) -> Mapping[str, float]:
        """Without its clearance it is dry friction."""
        return {"gap": 0.0}

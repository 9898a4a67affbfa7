"""``stiffness-hardening``: a spring that grows stiffer, or softer, with stroke."""

from __future__ import annotations

from collections.abc import Iterator

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects.base import Declined, Effect, Values, Variant
from hystbench.gap.scene import Scene


class StiffnessHardening(Effect):
    """A cubic spring in the place of the chain's linear mode."""

    name = "stiffness-hardening"
    place = "mechanics"

    def variants(self, scene: Scene) -> Iterator[Variant]:
        """Offer the spring for each mode of the chain."""
        modes = [k for k, item in enumerate(scene.chain) if item.name == "resonance"]
        if not modes:
            raise Declined("the chain has no mode whose spring could harden")
        for k in modes:
            mode, rest = scene.chain[k].to_mapping(), scene.chain[k + 1 :]
            own = {key: mode[key] for key in MODE if key in mode}

            def build(
                given: Values,
                own: dict[str, float] = own,
                rest: tuple[Block, ...] = rest,
            ) -> tuple[Block, ...]:
                block = registry()[self.name]
                return (block.from_mapping({**own, **given}), *rest)

            small = 1e-3 / scene.largest(k) ** 2
            yield Variant(
                self.name,
                self.place,
                "",
                k,
                build,
                (0,),
                unit={"coefficient": small},
                free=("coefficient",),
                replaces=True,
                neutral=False,
                zero={"coefficient": 0.0},
            )


MODE = ("frequency_hz", "damping_ratio", "participation")

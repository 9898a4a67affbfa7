"""Classes of how a mode moves with the level, and which named effects move it so."""

from __future__ import annotations

from collections.abc import Sequence

from hystbench.gap.locate.forms import SIGNIFICANT, View

CLASSES: dict[str, tuple[str, tuple[str, ...]]] = {
    "hardening": (
        "hardening, as of a spring that stiffens or a stop",
        ("stiffness-hardening", "stop"),
    ),
    "softening": (
        "softening, as of a spring that yields",
        ("stiffness-hardening", "hysteretic-force", "gravity"),
    ),
    "clearance": (
        "a clearance, as the frequency rises from the lowest levels",
        ("stop", "slider-with-gap", "backlash", "dead-zone"),
    ),
    "micro-slip or hysteresis": (
        "micro-slip or hysteresis, as of a joint that slips",
        ("hysteretic-force", "friction", "slider-with-gap", "hysteresis"),
    ),
    "Coulomb friction": (
        "Coulomb friction, which matters less in a larger motion",
        ("friction", "hysteretic-force", "slider-with-gap"),
    ),
    "damping that grows with speed": (
        "damping that grows with speed, as drag does",
        ("drag",),
    ),
    "a static curve before or behind": (
        "a static curve before or behind the dynamics",
        (
            *("saturation", "asymmetry", "sensor-nonlinearity"),
            *("drive-saturation", "dead-zone"),
        ),
    ),
    "none": ("a linear mode, as far as these levels show", ()),
}
"""Words of each class of what is missing, and the effects that move a mode so."""
IN_A_CHAIN = (
    *("stiffness-hardening", "backlash"),
    *CLASSES["a static curve before or behind"][1],
)
"""Those of them that do so in a chain as well."""


def beside_level(
    views: Sequence[View], named: Sequence[tuple[str, str]], little_left: bool = False
) -> str:
    """Hold the named effects against how modes move with the level.

    That is seen without any of their laws.

    Parameters
    ----------
    views : sequence of View
    named : sequence of (str, str)
        The named effects and their places. A force moves a mode inside the dynamics
        alone.
    little_left : bool
        Whether they leave nothing that matters. Of a mode that none of them moves
        nothing is said then: it was the gap that seemed to move it.

    Returns
    -------
    str
        Empty where no mode moves, or nothing was named.
    """
    sure = [view for view in views if view.p_value < SIGNIFICANT]
    kinds = [kind for view in sure for kind in view.kinds if kind != "none"]
    told = []
    for words, effects in (CLASSES[kind] for kind in kinds if named):
        fit = [
            name
            for name, place in named
            if name in effects and (place == "inside" or name in IN_A_CHAIN)
        ]
        who = " and ".join(fit) or ("" if little_left else "no named effect")
        if who:
            told.append(f"a mode moves with the level as of {words}: {who} can do so")
    return "; ".join(told)

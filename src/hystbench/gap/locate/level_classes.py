"""Classes of how a mode moves with the level: their words, and effects that do so."""

WORDS = {
    "hardening": "hardening, as of a spring that stiffens or a stop",
    "softening": "softening, as of a spring that yields",
    "clearance": "a clearance, as the frequency rises from the lowest levels",
    "micro-slip or hysteresis": "micro-slip or hysteresis, as of a joint that slips",
    "Coulomb friction": "Coulomb friction, which matters less in a larger motion",
    "damping that grows with speed": "damping that grows with speed, as drag does",
    "a static curve before or behind": "a static curve before or behind the dynamics",
    "none": "a linear mode, as far as these levels show",
}
"""Each class of what is missing, in words."""

MOVES = {
    "hardening": ("stiffness-hardening", "stop"),
    "softening": ("stiffness-hardening", "hysteretic-force", "gravity"),
    "clearance": ("stop", "slider-with-gap", "backlash", "dead-zone"),
    "micro-slip or hysteresis": (
        *("hysteretic-force", "friction", "slider-with-gap", "hysteresis"),
    ),
    "Coulomb friction": ("friction", "hysteretic-force", "slider-with-gap"),
    "damping that grows with speed": ("drag",),
    "a static curve before or behind": (
        *("saturation", "asymmetry", "sensor-nonlinearity"),
        *("drive-saturation", "dead-zone"),
    ),
}
"""Effects that move a mode as a class says."""
IN_A_CHAIN = (
    *("stiffness-hardening", "backlash"),
    *MOVES["a static curve before or behind"],
)
"""Those of them that do so in a chain as well."""

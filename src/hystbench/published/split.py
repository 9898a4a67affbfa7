"""Which signals of the tables a calibration may see."""

CALIBRATION_SIGNALS = (
    "sine-010hz",
    "sine-020hz",
    "sine-040hz",
    "sine-080hz",
    "sine-100hz",
    "sine-150hz",
    "multisine-10-30-50hz",
    "multisine-5-25-50-75-100hz",
)
"""To their published errors the twin and the convergence factors are fitted.

The other five of the tables (60, 120 and 200 Hz, the chirp and the random sum) are held
out. Both halves hold low, middle and high rates, and the held-out one two kinds of
signal that no fit has seen. The committed twin belongs to this split, so it is no
setting.
"""

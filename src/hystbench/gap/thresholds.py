"""What pays, what is near and what matters, in the units of the score."""

from __future__ import annotations

PAYS = 40.0
"""By how much an effect must lower the score to be named."""

NEAR = 80.0
"""Variants that score worse than the best by more are not searched further."""

STILL = 0.5
"""The same as a share of the best's gain: a grid's step may miss much of a gain."""

FINALISTS = 6
"""Effects that are added and refitted jointly before one is taken."""

TIE = 6.0
"""Effects whose score differs by less cannot be told apart."""

MOST = 4
"""Effects that are added, at most."""

WORSE = 0.1
"""Share by which an effect may widen the gap, where a wrong shape hides what it does.

Without this a gain near zero would leave all to the reshaping of the hysteresis.
"""

EXACT = 3
"""Of the finalists, those that are simulated exactly before one is taken."""

FURTHER = 100.0
"""By how much a further effect must lower the score."""

MATTERS = 0.01
"""Share of the gap's power that makes a further effect matter."""

CERTAIN = 200.0
"""By how much one that matters less must lower the score."""

BESIDE_SHAPE = 0.1
"""Share that matters beside a hysteresis of the wrong shape."""

MOST_OF_IT = 0.3
"""Share that makes a wrong shape of the hysteresis matter, dear as it is charged."""

SWAP = 3.0
"""By how much a rival must score better to take an effect's place."""

CLOSE = 0.6
"""Rivals are those with this share of the gain of the best of a round."""

UNNAMED_SHARE = 0.01
"""Share of the power of the gap that may stay unnamed: a tenth of its rms."""

ABOVE_NOISE = 0.5
"""Power above the floor, in floors, that makes what is left worth a word."""

SHAPE = "hysteresis-shape"

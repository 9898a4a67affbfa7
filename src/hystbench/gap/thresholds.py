"""Every number that can change a verdict, with its meaning.

How thoroughly is searched (points of grids, finalists, rounds) stands where the search
is: more of it finds the same name or a better one.
"""

from __future__ import annotations

SHAPE = "hysteresis-shape"
"""The effect that is a free correction of the base's own hysteresis."""

# What a fit is worth: the score, in units of twice a log-likelihood.

RECORD_WEIGHT = 50.0
"""Independent samples that a record counts as."""
LEAST_WEIGHT = 300.0
"""Of all records together, where there are few."""
PARAMETER = 4.0
"""Charge for a fitted parameter."""

# What is named: by how much an effect must lower the score.

PAYS = 40.0
"""The first effect."""
FURTHER = 100.0
"""A further effect that takes more of the gap than may stay unnamed."""
CERTAIN = 200.0
"""A further effect that takes less: it must be beyond doubt."""
TIE = 6.0
"""Effects whose score differs by less cannot be told apart."""
SWAP = 3.0
"""A rival, to take the place of an effect that was named before others."""
MOST = 4
"""Effects that are named, at most."""
UNKNOWN = 0.5
"""Standard error of an effect's size, as a share of it: two of them reach nothing."""

# Where the base's own hysteresis may be slightly wrong.

WORSE = 0.1
"""Share by which an effect may widen the gap, where a wrong shape hides what it does.

Without this a gain near zero would leave all to the reshaping of the hysteresis.
"""
BESIDE_SHAPE = 0.1
"""Share of the gap that matters beside a hysteresis of the wrong shape."""
MOST_OF_IT = 0.3
"""Share that makes a wrong shape of the hysteresis matter, dear as it is charged."""

# How much may stay without a name, as a share of the power of the gap.

UNNAMED_SHARE = 0.01
"""Of structure that no name accounts for: a tenth of the rms. A user may set it."""
LOOSE = 0.25
"""In all: half of the gap's rms."""

# With nothing named: whether there is a gap.

ABOVE_NOISE = 0.5
"""Power above the floor, in floors, that is not noise."""
SLIGHT = 0.015
"""RMS of what is left, over that of the output, that a fitted hysteresis may leave."""
WIDE = 3.0
"""Times as much in all, where most of it is what reshaping could do."""
RESHAPABLE = 0.3
"""Share of the gap that then has to lie in what a wrong shape of it could do."""
HALF = 0.5
"""The same, where what stays is no more than a slightly wrong shape leaves."""
LONE = 0.12
"""Power that stays in samples far off, over that of the gap, that is not noise."""
SOME = 0.03
"""Share of what is left that differs between periods, to be told from settling."""

# What takes a name back.

WORSE_HELD_OUT = 1.01
"""RMS on hold-out records over the base's.

Noise alone may move it by less, up or down: to withdraw a name for that would be to
toss a coin for it.
"""

# How sure a name is.

SCALE = 4.0
"""Difference in score that makes one name e times likelier than another."""
DISTRUST = 0.7
"""Share of the gap that stays, at which no name is believed."""
DOUBT = 0.02
"""That none of the vocabulary is right though one fits well."""

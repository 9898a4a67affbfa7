"""The numbers that decide a verdict and that several rooms share, with their meaning.

What one file alone decides by stands there with its reason, as the worth of a number of
a base in ``bases/orders.py``. How thoroughly is searched (points of grids, finalists,
rounds) stands where the search is: more of it finds the same name or a better one.
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
"""A further effect, which must also take more of the gap than may stay unnamed."""
CERTAIN = 200.0
"""Beyond doubt: what bends to much, beside a law of fewer numbers; on folds, an
effect whose size is not known."""
SCALE = 4.0
"""One name is e times likelier than another: by less they cannot be told apart."""
UNKNOWN = 0.5
"""Standard error of an effect's size, as a share of it: two of them reach nothing."""
DOUBT = 0.02
"""That none of the vocabulary is right though one fits well."""

# How much may stay without a name, as a share of the power of the gap.

UNNAMED_SHARE = 0.01
"""Of structure that no name accounts for: a tenth of the rms. A user may set it.

An effect that takes less does not matter, and where no more is left in all nothing
further is looked for.
"""
AS_GOOD = UNNAMED_SHARE
"""By no more two models differ that do the same, whatever a user allows.

So are compared: a host and the base that it stands for, a law and one of fewer numbers,
the base and a model that leaves more on hold-out records.
"""
LOOSE = 0.25
"""In all: half of the gap's rms.

Nor may an effect widen the gap by more, as it can where a wrong shape hides what it
does; and a hysteresis of the wrong shape matters where it takes more. Where forces
inside leave less, records have no numbers of their own.
"""

# With nothing named: whether there is a gap.

ABOVE_NOISE = 0.5
"""Power above the floor, in floors, that is not noise."""
SLIGHT = 0.015
"""RMS of what is left, over that of the output, that a fitted hysteresis may leave."""
WIDE = 3.0
"""Times as much in all, where most of it is what reshaping could do."""
FOREIGN = 0.05
"""Share that no effect does: of the gap in samples far off, of what is left in what
differs between periods."""

"""The numbers that decide a verdict or a base, with their meaning.

Fifteen of them are independent; where one is made of others, that is written. A
sixteenth, ``WORTH_A_WORD``, decides only what is told. How thoroughly is searched
(points of grids, finalists, rounds) stands where the search is: more of it finds the
same name or a better one. Which samples of a record are sound stands in ``records``.
"""

from __future__ import annotations

SHAPE = "hysteresis-shape"
"""The effect that is a free correction of the base's own hysteresis."""

# What a fit is worth: the score, in units of twice a log-likelihood.

RECORD_WEIGHT = 50.0
"""Independent samples that a record counts as."""
LEAST_WEIGHT = 6 * RECORD_WEIGHT
"""Independent samples that all records together count as, where there are few: as six
records."""
PARAMETER = 4.0
"""Charge for a fitted parameter."""

# What is named: by how much an effect must lower the score.

PAYS = 40.0
"""Gain that the first effect must reach, and whatever is to replace an answer that
stands: a re-tuned base, another timing, another host, values of single records."""
FURTHER = 100.0
"""Gain that a further effect must reach, and a host whose known numbers are refitted to
the records. In a chain a further effect must also take more of the gap than may stay
unnamed; a force that takes less must be beyond doubt."""
CERTAIN = 2 * FURTHER
"""A gain that is beyond doubt: of a law of many numbers over one of fewer; on folds, of
an effect whose size is not known; of a further force that takes little."""
SCALE = 4.0
"""One name is e times likelier than another: by less they cannot be told apart."""
BY_CHANCE = 0.05
"""Significance level of tests: what chance gives more often than this counts as
chance."""
UNKNOWN = 1 / 1.96
"""Standard error of an effect's size, as a share of it, from which its interval of 95 %
holds zero."""
DOUBT = 0.02
"""Probability that no name of the vocabulary is right though one fits well."""

# Shares of a power: of the gap, of what is left, or of what a lesser model leaves.

UNNAMED_SHARE = 0.01
"""Largest share of the gap's power that may stay unexplained: a tenth of the rms.

A user may set it. An effect that takes less does not matter, and the search ends where
no more is left.
"""
AS_GOOD = UNNAMED_SHARE
"""Two models that differ by no more than this are equally good.

It equals the default of `UNNAMED_SHARE`, and stays where a user sets another. It
compares a host with the base that it stands for, a law with one of fewer numbers, and
the base with a model that leaves more on hold-out records.
"""
WORTH_A_WORD = 0.1
"""Share that is told beside the verdict: a third of the rms."""
LOOSE = 0.25
"""Share that is too much to leave, or enough to matter: half of the rms.

- A name does not stand where more than this of the gap is left.
- An effect may not widen the gap by more, as it can where a wrong shape hides it.
- A wrong shape of the hysteresis matters where it takes more.
- Records get no numbers of their own where forces inside leave less.
- A curve between two filters must take as much, and one more degree of a path on
  hold-out records.
- What differs from period to period is noise only if no more than this of it repeats.
"""
MOST = 0.5
"""A majority: of a power or of a probability."""

# With nothing named: whether there is a gap.

ABOVE_NOISE = MOST
"""Power above the floor, in floors, that is not noise."""
SLIGHT = 0.015
"""RMS of what is left, over that of the output, that a fitted hysteresis may leave."""
WIDE = 3.0
"""Most of the whole residual, in multiples of `SLIGHT`, where reshaping could do most
of it. No noise of unknown colour is larger."""
FOREIGN = 0.05
"""Share that no effect does: of the gap in samples far off, of what is left in what
differs between periods."""

# A base that is identified from the records.

NUMBER_PAYS = 0.02
"""Share of the error, rms, that a further pole or zero takes."""
TIMING_PAYS = NUMBER_PAYS / 2
"""The same of another timing of the input: it is one of a few and no free number."""
ANOTHER_MODE = NUMBER_PAYS / 4
"""The same of a further one of many modes: it may take all of its own band while it
takes little of the whole."""

# The vocabulary.

SLIDES = AS_GOOD
"""A force that gives way within this share of the amplitude of the motion, half of its
range, is dry friction: it slides on nearly all of its way. What yields on a longer way
is a hysteretic force."""

ABOUT = 0.1
"""Share of itself by which a number of a base that nobody calls exact may be off, as in
a data sheet. If a host's number moves farther, that is told."""

"""The numbers that decide a verdict or a base: the meaning of each, and why its value.

Fifteen of them are independent; where one is made of others, that is written. A
sixteenth, ``WORTH_A_WORD``, decides only what is told.

Other numbers decide too, but each in one place, and stand there:

- How thoroughly is searched (points of grids, finalists, rounds; ``MOST_EFFECTS`` in
  ``naming/rounds.py``): more of it finds the same name or a better one.
- Which samples and records are sound: ``records``, as ``FAR_DEVIATIONS`` in
  ``lone_samples.py``.
- What a law is charged whose numbers are not what it should pay for: ``charge`` of a
  variant in ``effects``, as ``CURVE_CHARGE`` in ``sensor.py``. An offset that stands
  for a path pays as one (``naming/with_own_values.py``).
- How many numbers are more than one formula has: ``MANY_NUMBERS`` in
  ``fitting/state.py``.

A value that is called a convention follows from nothing: it was set on development
cases of the contest's plants.
"""

SHAPE = "hysteresis-shape"
"""The effect that is a free correction of the base's own hysteresis."""

# What a fit is worth: the score, in units of twice a log-likelihood.

RECORD_WEIGHT = 50.0
"""Independent samples that a record counts as.

A variance is known to 20 % from so many. A convention: the thousands of samples of a
record are a model error's few slow waves, and nobody counts those beforehand.
"""
LEAST_WEIGHT = 6 * RECORD_WEIGHT
"""Independent samples that all records together count as, where there are few: as six
records.

By its own weight one record would ask a first effect of one number to take 59 % of the
power. By this one it asks for 14 % (7 % of the rms), and a further effect for 29 %.
That it is six is a convention.
"""
PARAMETER = 4.0
"""Charge for a fitted parameter.

BIC's charge for a record's weight, log 50 = 3.9, and twice AIC's. A parameter that
means nothing gains more in one case of twenty (chi squared above 4: 4.6 %).
"""

# What is named: by how much an effect must lower the score.

PAYS = 40.0
"""Gain that the first effect must reach, and whatever is to replace an answer that
stands: a re-tuned base, another timing, another host, values of single records.

In units of `SCALE` odds of e^10, 22,000 to one. They have to be long: some 30 effects
with several laws and places each are tried, and a wrong base looks like some of them.
That the exponent is ten is a convention.
"""
FURTHER = 100.0
"""Gain that a further effect must reach, and a host whose known numbers are refitted to
the records. In a chain a further effect must also take more of the gap than may stay
unnamed; a force that takes less must be beyond doubt.

Odds of e^25. More than `PAYS`, as the first effect is not exactly right, and a second
one can make up for what it lacks. How much more is a convention.
"""
CERTAIN = 2 * FURTHER
"""A gain that is beyond doubt. It is asked of

- a form that bends to much, where a simpler law takes nearly as much;
- on folds, an effect whose size the records do not know;
- inside the dynamics, a further force that takes little of the gap, and numbers of a
  given base that were fitted and moved by more than `ABOUT`.

What is worse by as much is not judged on folds, nor fitted to the end. Of six records
it is half of the power that was left. A convention.
"""


def pay_of_further(effects: int) -> float:
    """Give what all effects but the first must gain together, of so many."""
    return FURTHER * max(effects - 1, 0)


SCALE = 4.0
"""One name is e times likelier than another: by less they cannot be told apart.

By Bayes' rule it were 2, as the score is twice a log-likelihood. Model errors are no
independent samples, so the evidence counts half. That it is a half is a convention;
how far the confidences are off by it is measured by the contest.
"""
BY_CHANCE = 0.05
"""Significance level of tests: what chance gives more often than this counts as
chance. A name that is less probable than that is next to excluded.

The usual level.
"""
UNKNOWN = 1 / 1.96
"""Standard error of an effect's size, as a share of it, from which its interval of 95 %
holds zero.

The level of `BY_CHANCE`.
"""
DOUBT = 0.02
"""Probability that no name of the vocabulary is right though one fits well.

One in fifty: no confidence is above 98 %. A convention, as unlisted causes are as
frequent as one chooses to make them.
"""

# Shares of a power: of the gap, of what is left, or of what a lesser model leaves.

UNNAMED_SHARE = 0.01
"""Largest share of the gap's power that may stay unexplained: a tenth of the rms.

A user may set it, for the verdict. For the search it is at most this: an effect that
takes less does not matter, and the search ends where no more is left. 20 dB below is
what is commonly neglected; how much matters is the user's to say.
"""
AS_GOOD = UNNAMED_SHARE
"""Two models that differ by no more than this are equally good.

It equals the default of `UNNAMED_SHARE`, and stays where a user sets another. It
compares a host with the base that it stands for, a law with one of fewer numbers, and
the base with a model that leaves more on hold-out records. Half a percent of an rms: of
white noise not even 7,000 samples tell it better than to 0.8 %.
"""
WORTH_A_WORD = 0.1
"""Share that is told beside the verdict: a third of the rms, 10 dB below."""
LOOSE = 0.25
"""Share that is too much to leave, or enough to matter: half of the rms, 6 dB.

- A name does not stand where more than this of the gap is left.
- An effect may not widen the gap by more, as it can where a wrong shape hides it.
- A wrong shape of the hysteresis matters where it takes more.
- Records get no numbers of their own where forces inside, or a chain, leave less.
- A curve between two filters must take as much, and one more degree of a path on
  hold-out records.
- Of what two filters leave without that curve, no linear model may spare more.
- What differs from period to period is noise only if no more than this of it repeats.

The name is to take the larger part of the rms, not of the power alone.
"""
MOST = 0.5
"""A majority: of a power or of a probability. By definition."""

# With nothing named: whether there is a gap.

ABOVE_NOISE = MOST
"""Power above the floor, in floors, that is not noise; the same of what differs between
the first periods of a steady motion, in powers of its noise.

An rms of 1.22 times the noise's, 1.8 dB. A power is known to 20 % from a record's
weight, so it is two and a half standard errors.
"""
SLIGHT = 0.015
"""RMS of what is left, over that of the output, that a fitted hysteresis may leave.

No model of a few plays fits a material's loop much better than to a percent. That it is
one and a half is a convention.
"""
WIDE = 3.0
"""Most of the whole residual, in multiples of `SLIGHT`, where reshaping could do most
of it. No noise of unknown colour is larger.

In all 4.5 % of the output's rms, a ratio of signal to noise of 27 dB: what is noisier
needs repeated periods or a declared noise. A convention.
"""
FOREIGN = 0.05
"""Share that no effect does: of the gap in lone samples, of what is left in what
differs between periods.

One part in twenty. A convention.
"""

# A base that is identified from the records.

NUMBER_PAYS = 0.02
"""Share of the error, rms, that a further pole or zero takes.

AIC's charge of two by one record's weight: 50 log(1 / .98^2) = 2.02. It has to be taken
on all records and on folds.
"""
TIMING_PAYS = NUMBER_PAYS / 2
"""The same of another timing of the input: it is one of a few and no free number.

What a number that means nothing takes of a record's weight by chance, on average.
"""
ANOTHER_MODE = NUMBER_PAYS / 4
"""The same of a further one of many modes: it may take all of its own band while it
takes little of the whole.

Of the power as much as the default of `UNNAMED_SHARE`.
"""

# The vocabulary.

SLIDES = AS_GOOD
"""A force that gives way within this share of the amplitude of the motion, half of its
range, is dry friction: it slides on nearly all of its way. What yields on a longer way
is a hysteretic force.

Drawn as a loop over the position, its flanks look vertical.
"""

ABOUT = 0.1
"""Share of itself by which a number of a base that nobody calls exact may be off, as in
a data sheet. If a host's number moves farther, that is told.

The common tolerance of 10 % of a stiffness, a resistance or a capacitance.
"""

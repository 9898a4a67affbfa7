"""What the base and what a model leaves, in noise floors, and whether it is noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.score import Score
from hystbench.gap.fitting.state import ModelState
from hystbench.gap.locate.forms import effective_count, f_test
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.lone_samples import much_stands_alone
from hystbench.gap.thresholds import (
    ABOVE_NOISE,
    AS_GOOD,
    BY_CHANCE,
    FOREIGN,
    LOOSE,
    SLIGHT,
    WIDE,
    WORTH_A_WORD,
)
from hystbench.record import FloatArray
from hystbench.sentences import finely, shortly


@dataclass(frozen=True)
class Leftover:
    """What a model leaves, in mean squares over the records."""

    before: float
    after: float
    """Power above the floor and beyond what a wrong shape of the hysteresis could
    leave, of the base and of the model with its effects, in floors."""
    all_before: float
    all_after: float
    """Power above the floor of the whole residual, in floors."""
    output: float = 0.0
    """Mean square of the measured output about its mean, in floors."""
    lone: float = 0.0
    """Share of the power of what is left that stands in lone samples."""
    unrepeated: float | None = None
    """Power of what is left that differs between periods of the same input, above the
    floor and in floors; none where no record repeats."""

    @property
    def slight(self) -> bool:
        """Whether no more is left than a hysteresis of a slightly wrong shape leaves.

        No model of a few play operators fits a material much better than to a percent
        of its output. So little tells of an effect only if most of it is nothing that
        reshaping the hysteresis could do.
        """
        return self._slight(self.after, self.all_after)

    @property
    def slight_before(self) -> bool:
        """Whether the base leaves no more than that."""
        return self._slight(self.before, self.all_before)

    @property
    def may_be_noise(self) -> bool:
        """Whether what is left may be noise of any colour: as little as that in all.

        With the floor, as one that is only an upper bound may hold a gap.
        """
        return 1.0 + self.all_after < (WIDE * SLIGHT) ** 2 * self.output

    def _slight(self, beyond: float, whole: float) -> bool:
        if whole <= ABOVE_NOISE:
            return True
        if whole >= (WIDE * SLIGHT) ** 2 * self.output:
            return False
        small = beyond < SLIGHT**2 * self.output
        return beyond <= ABOVE_NOISE or (small and beyond < (1 - LOOSE) * whole)

    @property
    def little_named(self) -> bool:
        """Whether effects leave most of what may be a slightly wrong shape alone."""
        return self.slight_before and self.share_left > LOOSE

    @property
    def share_left(self) -> float:
        """Share of the gap that no effect takes away.

        The lesser of two: of the whole residual, which a wrong base fills too, and of
        what lies beyond a wrong shape of the base, which may be little of an effect
        that looks like one.
        """
        beyond = max(self.after, 0.0) / max(self.before, self.after, 1e-9)
        return min(beyond, self.whole)

    @property
    def whole(self) -> float:
        """Share of the gap that stays of the whole residual."""
        return max(self.all_after, 0.0) / max(self.all_before, self.all_after, 1e-9)

    @property
    def sentence(self) -> str:
        """Say how much of the gap stays on the fit records, and of what it is a share.

        The part beyond a wrong shape, by which the verdict is given, is told where it
        is clearly another figure.
        """
        told = (
            f"on the fit records {finely(self.whole)} of the gap's power above the "
            "noise floor stays"
        )
        if self.whole - self.share_left < WORTH_A_WORD:
            return told
        return (
            f"{told}; of the part that no wrong shape of the hysteresis could leave, "
            f"{finely(self.share_left)}"
        )

    @property
    def may_be_of_base(self) -> bool:
        """Whether what names leave may all be the base's own error.

        With nothing named it would be no gap, so it cannot speak against a name.
        """
        return self.slight and not self.foreign

    @property
    def lone_matters(self) -> bool:
        """Whether much of what is left stands in lone samples."""
        return much_stands_alone(
            self.lone, after=1.0 + self.all_after, before=max(self.all_before, 1.0)
        )

    @property
    def is_new(self) -> bool:
        """Whether more than noise differs from period to period, and little repeats."""
        if (
            self.unrepeated is None
            or self.unrepeated <= ABOVE_NOISE
            or self.lone_matters
        ):
            return False
        repeats = self.all_after - self.unrepeated
        return repeats <= max(ABOVE_NOISE, LOOSE * self.unrepeated)

    @property
    def foreign(self) -> str:
        """Say what is left that no effect and no wrong hysteresis does, if any is."""
        if self.lone_matters:
            return (
                f"{100 * self.lone:.0f} % of the power that is left on the fit records "
                "stands in lone samples, far off the others, which no effect of "
                "the vocabulary does"
            )
        if self.unrepeated is None or self.unrepeated <= max(
            ABOVE_NOISE, FOREIGN * self.all_after
        ):
            return ""
        return (
            f"on the fit records {shortly(self.unrepeated, 2)} times the noise power "
            "is left that differs from one period of the same input to the next, which "
            "neither a named effect nor a wrong hysteresis does"
        )


def what_is_left(base: ModelState, state: ModelState, floor: Floor) -> Leftover:
    """Measure what the base and what a model leaves, each beside its directions."""
    square = floor.square
    before, after = (_beyond(x, make_score(x, floor)) for x in (base, state))
    return Leftover(
        before,
        after,
        base.power(square) / square,
        state.power(square) / square,
        float(np.var(base.measured)) / square,
    )


def _beyond(model: ModelState, score: Score) -> float:
    residual, beside = model.residual, model.beside_columns
    rest, _ = score.split(residual)
    if beside.shape[1]:
        columns = np.hstack([beside, score.directions])
        rest = residual - columns @ np.linalg.lstsq(columns, residual, rcond=1e-10)[0]
    squares = [float(np.mean(rest[part] ** 2)) for part in model.sample.slices]
    return float(np.mean(squares)) / score.floor - 1.0


def size_follows(state: ModelState) -> bool:
    """Tell whether the squares of a residual follow those of known signals.

    Noise of a sensor has its size whatever the device does. A gain that is modulated,
    or a disturbance that a motion makes, is larger where there is more of the motion,
    though it follows none. The squares of the input, of the simulated output and of
    their rates are fitted to those of the residual by least squares, all about their
    means in each record: levels that differ only between records are not seen. An F
    test at 5 % tells chance, for as many samples as are independent; of noise as slow
    as a record it lets more pass. A share that would be nothing of a gap is none here.
    """
    signals: list[list[FloatArray]] = [[] for _ in range(4)]
    for record, y in zip(state.records, state.exact, strict=True):
        u = record.u - np.mean(record.u)
        z = y - np.mean(y)
        for kind, own in zip(signals, (u, z, _rate(u), _rate(z)), strict=True):
            kind.append(own**2)
    taken = [state.sample.take(kind) for kind in signals]
    design = np.column_stack([state.sample.about_means(x) for x in taken])
    sizes = np.sqrt(np.mean(design**2, axis=0))
    # The square of a square wave does not vary.
    varies = sizes > 1e-6 * np.mean(taken, axis=1)
    design = design[:, varies] / sizes[varies]
    squares = state.sample.about_means(state.residual**2)
    weights, _, rank, _ = np.linalg.lstsq(design, squares, rcond=1e-8)
    fitted = design @ weights
    rest = squares - fitted
    power = float(squares @ squares)
    if rank == 0 or power == 0.0:
        return False
    share = 1.0 - float(rest @ rest) / power
    count = effective_count(state.sample.slices, rest, fitted)
    return share > AS_GOOD and f_test(share, float(rank), count) < BY_CHANCE


def _rate(signal: FloatArray) -> FloatArray:
    return np.gradient(signal) if len(signal) > 1 else np.zeros_like(signal)

"""Block ``rate-dependent-hysteresis``: the loop widens with the rate."""

import numpy as np

from hystbench import kernels
from hystbench.blocks.curve import (
    AHEAD,
    CENTRAL,
    POINTS,
    SHORT_STEPS,
    central_difference,
    finer,
    value_at,
    weighed,
)
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.parameter import choice, number
from hystbench.blocks.step import Sampling, Step, foretold, smooth_curve
from hystbench.blocks.wrapping import Growth, Wrappable, WrappingBlock
from hystbench.errors import InputError
from hystbench.record import FloatArray

FORMS = ("growing-thresholds", "excess-field", "acting-field")


class RateDependentHysteresis(
    HeldBlock, WrappingBlock, name="rate-dependent-hysteresis", place="material"
):
    """Hysteresis that depends on the rate of what enters it, v.

    With ``e = coefficient |dv/dt|^exponent``, or, with a ``knee``, ``e = coefficient
    knee^exponent asinh((|dv/dt| / knee)^exponent)``, which beyond it grows with the
    logarithm of the rate [3]_:

    - ``growing-thresholds`` [1]_: each threshold is ``r_i (1 + e)`` at each sample;
    - ``excess-field``: the hysteresis is driven by ``v - e sign(dv/dt)``;
    - ``acting-field`` [2]_: it is driven by g with ``v - g = coefficient
      |dg/dt|^exponent sign(dg/dt)``, g = v at the first sample. Where g hardly moves it
      is ``excess-field``, which takes the rate of v for that of g.

    The rate is a central difference, one-sided at the ends. Where v turns it is zero
    for an instant only, and the thresholds are narrow for as long: with a band-limited
    hold all are computed on a grid that is ``SHORT_STEPS`` times finer, the rate of
    the curve that leads up to each sample. With ``hold: linear`` v moves straight from
    sample to sample, and turns without ever being slow: the rate is that of the line.
    At the first sample none is known, and it is zero.

    References
    ----------
    .. [1] M. Al Janaideh, C.-Y. Su, S. Rakheja, "Development of the rate-dependent
       Prandtl-Ishlinskii model for smart actuators", Smart Materials and Structures
       17 (2008) 035026.
    .. [2] G. Bertotti, "General properties of power losses in soft ferromagnetic
       materials", IEEE Transactions on Magnetics 24 (1988) 621-630.
    .. [3] H. Eyring, "Viscosity, plasticity, and diffusion as examples of absolute
       reaction rates", J. Chemical Physics 4 (1936) 283-291: friction that is
       activated by heat. M. Al Janaideh, P. Krejci, "Inverse rate-dependent
       Prandtl-Ishlinskii model for feedforward compensation of hysteresis in a
       piezomicropositioning actuator", IEEE/ASME Trans. Mechatronics 18 (2013)
       1498-1507, has thresholds that grow with a logarithm of the rate.
    """

    smooths = False

    coefficient: float = number(
        "(s/U)^exponent",
        "growth at a rate of one; in U (s/U)^exponent for both fields",
        0.0,
    )
    exponent: float = number("-", "power of the rate", 0.01, 10.0)
    form: str = choice("what the rate changes", FORMS, FORMS[0])
    knee: float = number(
        "U/s",
        "rate beyond which the growth is logarithmic; with 0 it is a power throughout",
        0.0,
        default=0.0,
    )

    def check(self) -> None:
        """Refuse a knee where the field that acts is sought."""
        if self.knee and self.form == "acting-field":
            raise InputError("knee: none with 'form: acting-field'; expected 0")

    def check_inner(self, inner: Wrappable) -> None:
        """Refuse hysteresis without thresholds where thresholds are to grow."""
        if self.form == "growing-thresholds":
            inner.check_growth()

    def wrap(
        self, inner: Wrappable, v: FloatArray, u: FloatArray, dt: float, growth: Growth
    ) -> FloatArray:
        """Drive the hysteresis with larger thresholds or with less field."""
        fine = self._fine if len(v) > 2 else 1
        given = v
        if fine > 1:
            v = np.repeat(v, 2)[:-1] if self._straight else finer(v, fine)
            if growth is not None:
                place = np.arange(len(v)) / fine
                growth = np.interp(place, np.arange(len(growth)), growth)
        if self.form == "acting-field":
            v = self._acting(v, dt / fine)
        else:
            effect = self._effect_of(given, dt, fine)
            if self.form == "excess-field":
                v = v - effect
            else:
                growth = 1.0 + effect if growth is None else (1.0 + effect) * growth
        # Hysteresis does not look at the model's input: that is not made finer.
        return inner.grow(v, v, dt / fine, growth)[::fine].copy()

    def _effect_of(self, v: FloatArray, dt: float, fine: int) -> FloatArray:
        """Give e at all steps: of a field with the sign of its rate, else its size."""
        twice = fine > 1 and self._straight  # both ends of a line have its rate
        if fine == 1:
            rate = np.gradient(v, dt)
        elif twice:
            rate = np.diff(v) / dt
        else:
            rates = weighed(v, _rate_weights(POINTS, AHEAD, fine))
            rate = np.concatenate([rates[-1:, 0], rates.T[1:].ravel()]) / dt
        effect = self._effect(np.abs(rate))
        if self.form == "excess-field":
            effect = np.copysign(effect, rate)
        return np.append(0.0, np.repeat(effect, 2)) if twice else effect

    @property
    def _straight(self) -> bool:
        """Whether the rate is that of straight lines between samples.

        Where no hold is set v comes smoothly out of dynamics: it only looks straight.
        """
        return self.hold == "linear" and self.form != "acting-field"

    @property
    def _fine(self) -> int:
        """Steps of an interval; of a line its two ends, both with its rate."""
        if self._straight:
            return 2
        return SHORT_STEPS if self.holding == "band-limited" else 1

    def _effect(self, speed: FloatArray) -> FloatArray:
        """Give e of magnitudes of a rate."""
        if not self.knee:
            return np.asarray(self.coefficient * speed**self.exponent)
        most = self.coefficient * self.knee**self.exponent
        return np.asarray(most * np.arcsinh((speed / self.knee) ** self.exponent))

    def _acting(self, v: FloatArray, dt: float) -> FloatArray:
        """Give the field that acts behind the one that is applied."""
        if self.coefficient == 0.0:
            return v
        field = np.empty(len(v))
        given = (self.coefficient, self.exponent, dt, np.ascontiguousarray(v))
        kernels.call("hb_acting_field", len(v), *given, field)
        return field

    def step(self, sampling: Sampling) -> Step:
        """Take fields and rates from the curve through the newest samples.

        It gives the inner points of a band-limited field, and the sample after the
        newest, which a central difference needs.
        """
        points, fine, ahead = sampling.curve_points, self._fine, sampling.ahead
        samples = np.eye(points)
        if self._straight:
            values = samples[[ahead + 1, ahead]]
            rates = np.tile(samples[ahead] - samples[ahead + 1], (2, 1))
        else:
            places = np.arange(1 - fine, 1) / fine - ahead
            values = np.array([value_at(points, place) for place in places])
            rates = _rate_weights(points, ahead, fine)
        constants = {
            "form": FORMS.index(self.form),
            **self.constants("coefficient", "exponent", "knee"),
            "dt": sampling.dt / fine,
            "fine": fine,
            "points": points,
            "ahead": ahead,
            "values": values.ravel(),
            "rates": rates.ravel() / sampling.dt,
        }
        states = {"history": 1 + points, "growth_before": 1, "field": 2}
        function = "rate_dependent_hysteresis"
        curved = fine > 1 and not self._straight
        central = self.form != "acting-field" and not self._straight
        told = [smooth_curve(points, ahead)] if curved else []
        told += [foretold(CENTRAL, points, ahead)] if central else []
        return Step(
            function,
            constants,
            states,
            grows=True,
            drives=fine,
            gains=AHEAD if curved else int(central),
            rates=int(central),
            differs="; ".join(filter(None, told)),
        )


def _rate_weights(points: int, ahead: int, fine: int) -> FloatArray:
    """Weights of the samples for the rate at each step of an interval, per sample.

    Shape (fine, points); the last is for the interval's end.
    """
    places = np.arange(1 - fine, 1) / fine - ahead
    return np.array([central_difference(points, place, 1 / fine) for place in places])

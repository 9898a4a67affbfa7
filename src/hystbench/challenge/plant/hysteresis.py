"""Hysteresis of four families, each from its own definition.

Fields are currents in A, outputs are displacements in um that are zero at the start.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np

from hystbench.challenge import kernels
from hystbench.record import FloatArray

#: Largest current of any excitation; loops are scaled over it.
LARGEST_CURRENT = 0.6

#: Envelope functions printed in Zhang and Ma, Sensors 16(2), 205, 2016, section 4.
PUBLISHED = (1.2878, 0.36, 0.6025, -0.6671, 0.3223, 1.2233, 0.1104, -0.0248)


@dataclass(frozen=True)
class PlantLoop(ABC):
    """A quasi-static loop."""

    family: ClassVar[str]
    sizes: ClassVar[tuple[str, ...]]
    """Fields that its displacement is proportional to, together."""

    @abstractmethod
    def respond(self, v: FloatArray) -> FloatArray:
        """Compute the displacement in um for a current that starts at rest."""

    def scaled(self, factor: float) -> Self:
        """Multiply the displacement."""
        sizes = {name: getattr(self, name) * factor for name in self.sizes}
        return replace(self, **sizes)


@dataclass(frozen=True)
class GeneralizedPlays(PlantLoop):
    """Weighted generalized plays, each kept between two moved envelopes.

    References
    ----------
    .. [1] M. Al Janaideh, S. Rakheja, C.-Y. Su, IEEE/ASME Trans. Mechatronics 16
       (2011) 734-744.
    """

    envelope: tuple[float, ...]
    thresholds: FloatArray
    weights: FloatArray
    family = "gpi"
    sizes = ("weights",)

    def respond(self, v: FloatArray, growth: FloatArray | None = None) -> FloatArray:
        """Sum the plays; ``growth`` multiplies the thresholds sample by sample."""
        v = np.ascontiguousarray(v)
        a = self.envelope
        left = a[0] * np.tanh(a[1] * v + a[2]) + a[3]
        right = a[4] * np.tanh(a[5] * v + a[6]) + a[7]
        factor = np.ones_like(v) if growth is None else growth
        state, y = np.zeros(len(self.thresholds)), np.empty_like(v)
        kernels.call(
            "hc_generalized_plays",
            len(v),
            len(state),
            left,
            right,
            np.ascontiguousarray(factor),
            self.thresholds,
            self.weights,
            state,
            y,
        )
        return y


@dataclass(frozen=True)
class Everett(PlantLoop):
    """Preisach's operator by Everett's function and its memory of turning points.

    The density of relays is normal in their interaction field and lognormal in their
    coercive field; beside it stands a reversible part. It starts demagnetized, after
    turning points that alternate and shrink.

    References
    ----------
    .. [1] D. H. Everett, Trans. Faraday Soc. 51 (1955) 1551-1557.
    .. [2] I. D. Mayergoyz, Mathematical Models of Hysteresis, Springer, 1991.
    """

    interaction: float  # standard deviation of the interaction field, A
    centre: float  # its mean, A
    coercive: float  # median of the coercive field, A
    coercive_spread: float  # standard deviation of its logarithm
    irreversible: float  # um over the whole plane
    reversible: float  # um
    knee: float  # A
    limit: float = 1.0
    points: int = 601
    family = "preisach"
    sizes = ("irreversible", "reversible")

    @cached_property
    def table(self) -> FloatArray:
        """Everett's function E(a, b), a the rows and b the columns, in um.

        Swing of the output when the input goes from b up to a: the sum of the
        density's cells.
        """
        step = 2.0 * self.limit / (self.points - 1)
        middle = -self.limit + step * (np.arange(self.points - 1) + 0.5)
        half = 0.5 * (middle[:, None] - middle[None, :])
        centre = 0.5 * (middle[:, None] + middle[None, :]) - self.centre
        inside = np.where(half > 0, half, 1.0)
        logarithm = np.log(inside / self.coercive) / self.coercive_spread
        square = (centre / self.interaction) ** 2 + logarithm**2
        density = np.exp(-0.5 * square) / inside
        density[half <= 0] = 0.0
        mass = density * (self.irreversible / density.sum())
        out = np.zeros((self.points, self.points))
        out[1:, :-1] = np.cumsum(np.cumsum(mass, axis=0)[:, ::-1], axis=1)[:, ::-1]
        out.setflags(write=False)
        return out

    def history(self) -> FloatArray:
        """Turning points that demagnetize: alternating, shrinking."""
        sizes = self.limit * np.linspace(1.0, 0.0, 400)
        sizes[1::2] *= -1.0
        return sizes

    def respond(self, v: FloatArray) -> FloatArray:
        """Follow the input by the turning points that are not wiped out."""
        past = self.history()
        plane = (len(past), self.points, self.limit, self.table, past)
        start = kernels.run("hc_everett", *plane, over=np.zeros(1))[0]
        y = kernels.run("hc_everett", *plane, over=v) - start
        return np.asarray(y + self.reversible * np.tanh(v / self.knee))


@dataclass(frozen=True)
class JilesAthertonLoop(PlantLoop):
    """Equation of Jiles and Atherton about a bias, strain as magnetization squared.

    It starts on the bias, demagnetized there by cycles that shrink.

    References
    ----------
    .. [1] D. C. Jiles, D. L. Atherton, J. Magn. Magn. Mater. 61 (1986) 48-60.
    .. [2] D. C. Jiles, J. Phys. D 28 (1995) 1537-1546, for the strain.
    """

    bias: float  # A
    shape: float  # A
    coupling: float  # A
    pinning: float  # A
    reversible: float
    strain: float  # um at saturation
    family = "jiles-atherton"
    sizes = ("strain",)

    def respond(self, v: FloatArray) -> FloatArray:
        """Integrate the magnetization over the field, by Runge-Kutta."""
        piece = 0.01 * self.shape
        constants = (self.shape, self.coupling, self.pinning, self.reversible, piece)
        cycles = LARGEST_CURRENT * np.linspace(1.2, 0.0, 60)
        cycles[1::2] *= -1.0
        warm_up = self.bias + cycles
        state = np.zeros(2)
        out = np.empty_like(warm_up)
        kernels.call("hc_jiles_atherton", len(warm_up), *constants, warm_up, state, out)
        start = state[1]
        field = np.ascontiguousarray(self.bias + v)
        m = np.empty_like(field)
        kernels.call("hc_jiles_atherton", len(field), *constants, field, state, m)
        return np.asarray(self.strain * (m**2 - start**2))


@dataclass(frozen=True)
class Duhem(PlantLoop):
    """Duhem's equation as Coleman and Hodgdon write it.

    ``dy/dt = rate |dv/dt| (f(v) - y) + stiff f'(v) dv/dt``, with ``f(v)`` a tanh about
    a bias. It remembers its own output alone: a minor loop does not close where it
    began, as loops of plays, of Preisach's operator and of real magnets do.

    References
    ----------
    .. [1] B. D. Coleman, M. L. Hodgdon, "A constitutive relation for rate-independent
       hysteresis in ferromagnetically soft materials", International Journal of
       Engineering Science 24 (1986) 897-919.
    """

    rate: float  # 1/A
    stiff: float
    knee: float  # A
    bias: float  # A
    height: float  # um
    family = "duhem"
    sizes = ("height",)

    def respond(self, v: FloatArray) -> FloatArray:
        """Follow the equation in steps of the input, exactly for a straight f."""
        constants = (self.rate, self.stiff, self.knee, self.bias)
        return self.height * kernels.run("hc_duhem", *constants, over=v)


def draw_plays(random: np.random.Generator) -> GeneralizedPlays:
    """Draw generalized plays: by a coin of the published envelopes, or of others.

    Both envelopes are moved by one constant so that the output is zero at rest.
    """
    published = random.uniform() < 0.5
    while True:
        factors = np.exp(random.uniform(-0.2, 0.2, 8))
        a = np.array(PUBLISHED) * (1.0 if published else factors)
        v = np.linspace(-LARGEST_CURRENT, LARGEST_CURRENT, 201)
        left = a[0] * np.tanh(a[1] * v + a[2]) + a[3]
        right = a[4] * np.tanh(a[5] * v + a[6]) + a[7]
        middle = 0.5 * (left[100] + right[100])
        # as near to each other as the published ones, and in order about rest
        gap, rise = left - right, left[-1] - left[0]
        near = gap.min() > -0.01 * rise and gap.max() < 0.1 * rise
        if published or (near and gap[100] > 0.01 * rise):
            break
    a[[3, 7]] -= middle
    count = int(random.integers(12, 31))
    reach = float(max(left[-1], right[-1]) - middle)
    thresholds = np.arange(count) / count * reach
    weights = np.exp(random.uniform(-1.0, 2.0) * np.arange(count) / count)
    weights *= random.uniform(0.6, 1.6) / weights.sum()
    weights[0] += 1.0
    return GeneralizedPlays(tuple(map(float, a)), thresholds, weights)


def draw_everett(random: np.random.Generator) -> Everett:
    """Draw a Preisach plane."""
    share = random.uniform(0.25, 0.45)
    return Everett(
        interaction=random.uniform(0.28, 0.45),
        centre=random.uniform(-0.08, 0.08),
        coercive=random.uniform(0.06, 0.16),
        coercive_spread=random.uniform(0.35, 0.7),
        irreversible=share,
        reversible=1.0 - share,
        knee=random.uniform(0.5, 1.2),
    )


def draw_jiles_atherton(random: np.random.Generator) -> JilesAthertonLoop:
    """Draw a biased magnetostrictive rod."""
    shape = random.uniform(0.4, 0.6)
    return JilesAthertonLoop(
        bias=shape * random.uniform(1.6, 2.2),
        shape=shape,
        coupling=shape * random.uniform(0.1, 0.8),
        pinning=random.uniform(0.025, 0.055),
        reversible=random.uniform(0.15, 0.45),
        strain=1.0,
    )


def draw_duhem(random: np.random.Generator) -> Duhem:
    """Draw a material of Coleman and Hodgdon."""
    return Duhem(
        rate=random.uniform(5.0, 15.0),
        stiff=random.uniform(0.3, 0.7),
        knee=random.uniform(0.5, 1.0),
        bias=random.uniform(-0.15, 0.15),
        height=1.0,
    )


DRAWS: dict[str, Callable[[np.random.Generator], PlantLoop]] = {
    "gpi": draw_plays,
    "preisach": draw_everett,
    "jiles-atherton": draw_jiles_atherton,
    "duhem": draw_duhem,
}


def _cycle(hysteresis: PlantLoop, bias: float) -> FloatArray:
    """Displacement over the largest current, the second time around."""
    angle = np.linspace(0.0, 4.0 * np.pi, 4001)
    return hysteresis.respond(bias + LARGEST_CURRENT * np.sin(angle))[2001:]


def swing(hysteresis: PlantLoop) -> float:
    """Peak-to-peak displacement in um over the largest current."""
    return float(np.ptp(_cycle(hysteresis, 0.0)))


def middle(hysteresis: PlantLoop, bias: float) -> float:
    """Mean displacement in um over the largest current about a bias."""
    return float(np.mean(_cycle(hysteresis, bias)))


def draw(family: str, random: np.random.Generator) -> PlantLoop:
    """Draw a loop of a family whose full swing is 30 to 55 um."""
    loop = DRAWS[family](random)
    return loop.scaled(random.uniform(30.0, 55.0) / swing(loop))

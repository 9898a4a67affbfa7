"""One case: a plant, its records, the model that is handed over, and the truth."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from hystbench.blocks.base import Block
from hystbench.blocks.gain import Gain
from hystbench.blocks.gpi import GeneralizedPrandtlIshlinskii
from hystbench.blocks.resonance import Resonance
from hystbench.challenge.campaigns import CAMPAIGNS, RecordCommand
from hystbench.challenge.plant.actuator import Actuator, KnownMode
from hystbench.challenge.plant.effects import IN_ACTUATOR
from hystbench.challenge.plant.hysteresis import GeneralizedPlays, PlantLoop, draw
from hystbench.challenge.plant.kind import HiddenEffect, log_uniform
from hystbench.challenge.plant.kind import draw as draw_effect
from hystbench.challenge.spec import COMMANDS, EFFECTS, NOISE, PLANT, CaseSpec
from hystbench.challenge.where import where
from hystbench.identification import identify
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import Channel, FloatArray, Record, Use

INPUT, OUTPUT = Channel("current", "A"), Channel("displacement", "um")
#: Order of an identified base, and what its search may cost.
GPI_ORDER, GPI_ITERATIONS, GPI_STARTS = 20, 60, 2
#: Records that a quasi-static GPI is identified from, in either campaign.
QUASI_STATIC = ("slow-loop", "minor-loops", "triangle", "ringing", "biased-tones")
#: An effect's difference is to be within these shares of the output's rms on the fit
#: records; outside, its size is changed, within what physics allows. Where the base is
#: of another family its own error is 1 or 2 % of the output: an effect is to be larger.
SMALLEST_EFFECT = {
    "gpi": 0.012,
    "preisach": 0.03,
    "jiles-atherton": 0.03,
    "duhem": 0.03,
}
LARGEST_EFFECT = 0.12
#: Smallest step of what is written down, in um: a 16-bit converter over 65 um.
RESOLUTION_UM = 0.001
#: Where nothing is hidden the noise is drawn from this interval, in um.
PLAIN_NOISE_UM = (0.01, 0.1)


@dataclass(frozen=True)
class Case:
    """What a solver gets, and beside it what only the judge may see."""

    records: tuple[Record, ...]
    model: Model | None
    """The base model; None where the solver is to identify a linear one."""
    truth: dict[str, Any] = field(repr=False)
    """What is hidden, as docs/challenge.md tells."""


@dataclass(frozen=True)
class Plant:
    """All that the seed draws of a plant before any effect."""

    loop: PlantLoop
    hidden_loop: PlantLoop
    gain: float
    mode: KnownMode | None
    seed: int

    def actuator(self, effects: tuple[HiddenEffect, ...]) -> Actuator:
        """Build it with some of its effects."""
        names = [effect.kind.name for effect in effects]
        loop: PlantLoop | float = self.loop
        if self.gain:
            loop = self.loop if "hysteresis" in names else self.gain
        elif "hysteresis-shape" in names:
            loop = self.hidden_loop
        return Actuator(loop, self.mode, effects, self.seed)


def make_case(spec: CaseSpec) -> Case:
    """Make a case; the same spec gives the same numbers.

    Parameters
    ----------
    spec : CaseSpec

    Returns
    -------
    Case
    """
    commands = CAMPAIGNS[spec.campaign](spec.random(COMMANDS))
    plant, drawn = _draw(spec, commands)
    bare = Readings(plant.actuator(()), commands)
    size = rms(*bare.of("fit"))
    effects = tuple(_resized(plant, effect, bare, size) for effect in drawn)
    full = Readings(plant.actuator(effects), commands)
    rests = [tuple(x for x in effects if x is not own) for own in effects]
    without = [
        Readings(plant.actuator(rest), commands) if rest else bare for rest in rests
    ]
    differences = [full.minus(item, "fit") for item in without]
    random = spec.random(NOISE)
    noise = log_uniform(random, *PLAIN_NOISE_UM)
    if effects:
        noise = min(rms(*each) for each in differences) / 10.0 ** (spec.ratio_db / 20.0)
    records = tuple(
        _record(full, number, noise, random) for number in range(len(commands))
    )
    fit_records = [record for record in records if record.use == "fit"]
    linear = "hysteresis" in spec.effects
    model = _base_model(plant.loop, plant.mode, commands, linear)
    noise_rms = float(np.hypot(noise, RESOLUTION_UM / np.sqrt(12.0)))
    outputs = [item.of("fit") for item in without]
    gap = full.minus(bare, "fit")
    truth = told_of(spec, OUTPUT.unit, noise_rms, size) | {
        "mode": None if plant.mode is None else asdict(plant.mode),
        "effects": [
            effect_told(effect)
            | {
                "resized": effect is not first,
                "rms": rms(*difference),
                "ratio_db": _decibel(rms(*difference), noise),
                "ratio_retuned_db": _decibel(_retuned(difference, output), noise),
                "where": where(effect.kind, fit_records, difference, output),
            }
            for effect, first, difference, output in zip(
                effects, drawn, differences, outputs, strict=True
            )
        ],
        "ratio_all_db": _decibel(rms(*gap), noise) if effects else None,
        "ratio_all_retuned_db": _decibel(_retuned(gap, bare.of("fit")), noise),
        "hold_out": {
            "gap_rms": full.beside(model, "hold-out"),
            "explainable_rms": rms(*full.minus(bare, "hold-out")),
            "base_error_rms": bare.beside(model, "hold-out"),
        },
        "base_error_fit_rms": bare.beside(model, "fit"),
    }
    return Case(records, model, truth)


class Readings:
    """Noise-free readings of a plant on all records, each computed when it is needed.

    Parameters
    ----------
    actuator : Actuator
    commands : tuple of RecordCommand
        Of all records; a record's number is its place here.
    """

    def __init__(self, actuator: Actuator, commands: tuple[RecordCommand, ...]) -> None:
        self.actuator, self.commands = actuator, commands
        self._read: dict[int, FloatArray] = {}

    def raw(self, number: int) -> FloatArray:
        """Reading before the converter, computed once."""
        if number not in self._read:
            item = self.commands[number]
            reading = self.actuator.read(item, item.dt, item.samples, number)
            self._read[number] = reading
        return self._read[number]

    def of(self, use: Use) -> list[FloatArray]:
        """Readings of the records of a use as they are written down, but for noise."""
        return [
            self.actuator.convert(self.raw(number), item.dt, number)
            for number, item in enumerate(self.commands)
            if item.use == use
        ]

    def minus(self, less: Readings, use: Use) -> list[FloatArray]:
        """Difference to another plant's readings."""
        return [a - b for a, b in zip(self.of(use), less.of(use), strict=True)]

    def beside(self, model: Model, use: Use) -> float:
        """RMS of the difference to a model's output."""
        chosen = [item for item in self.commands if item.use == use]
        simulated = [model.simulate(item.sampled(), item.dt) for item in chosen]
        return rms(*(a - b for a, b in zip(self.of(use), simulated, strict=True)))


def _draw(
    spec: CaseSpec, commands: tuple[RecordCommand, ...]
) -> tuple[Plant, tuple[HiddenEffect, ...]]:
    random = spec.random(PLANT)
    loop = draw(spec.family, random)
    # both are drawn in any case, so that the mode does not hang on the effects
    known = random.uniform() < 0.5
    mode = KnownMode(
        frequency_hz=log_uniform(random, 70.0, 320.0),
        damping_ratio=log_uniform(random, 0.015, 0.06),
        participation=float(random.uniform(0.05, 0.3)),
    )
    has_mode = known or "stiffness-hardening" in spec.effects
    random = spec.random(EFFECTS)
    effects = []
    hidden: PlantLoop = loop
    gain = 0.0
    for name in spec.effects:
        kind = IN_ACTUATOR[name]
        effect = draw_effect(kind, random, spec.spread, _forms(name, spec))
        if name == "stiffness-hardening":
            values = {**effect.parameters, **asdict(mode)}
            effect = HiddenEffect(kind, effect.form, values)
        if name == "hysteresis-shape":
            hidden = _other_loop(effect.form, loop, commands, random)
        if name == "hysteresis":
            gain = _slope(loop, _quasi_static(commands))
        effects.append(effect)
    plant = Plant(loop, hidden, gain, mode if has_mode else None, spec.seed)
    return plant, tuple(effects)


def _forms(name: str, spec: CaseSpec) -> tuple[str, ...]:
    """Forms of an effect that the plant's family and the set can have."""
    if name == "rate-dependent-hysteresis":
        return ("growing-thresholds",) if spec.family == "gpi" else ("excess-field",)
    return spec.forms(IN_ACTUATOR[name])


def _other_loop(
    form: str,
    loop: PlantLoop,
    commands: tuple[RecordCommand, ...],
    random: np.random.Generator,
) -> PlantLoop:
    """Draw a loop of another shape and of the same mean gain."""
    other = draw("gpi" if form == "other-gpi" else form, random)
    u = _quasi_static(commands)
    mine, others = loop.respond(u), other.respond(u)
    return other.scaled(float(mine @ others / (others @ others)))


def _base_model(
    loop: PlantLoop,
    mode: KnownMode | None,
    records: tuple[RecordCommand, ...],
    linear: bool,
) -> Model:
    """Make the model that is handed over: the plant's own loop, or the best GPI.

    Plays are handed over as they are; of another family the best quasi-static GPI is
    identified from its slow loop and minor loops. A linear base has a gain instead.
    """
    u = _quasi_static(records)
    chain: list[Block] = []
    if linear:
        chain.append(Gain(value=_slope(loop, u), offset=0.0))
    else:
        plays = loop if isinstance(loop, GeneralizedPlays) else _nearest(loop, u)
        chain.append(
            GeneralizedPrandtlIshlinskii(
                envelope=plays.envelope,
                thresholds=tuple(map(float, plays.thresholds)),
                weights=tuple(map(float, plays.weights)),
            )
        )
    if mode is not None:
        chain.append(Resonance(hold="band-limited", **asdict(mode)))
    return Model("base", INPUT, OUTPUT, tuple(chain))


def _quasi_static(records: tuple[RecordCommand, ...]) -> FloatArray:
    """Commands of the slow records, one after the other.

    A loop does not depend on the rate, so the way from the last sample of one to the
    first of the next needs no samples between.
    """
    chosen = [item.sampled() for item in records if item.name in QUASI_STATIC]
    return np.concatenate(chosen)


def _slope(loop: PlantLoop, u: FloatArray) -> float:
    """Gain of the straight line nearest to a loop, in um/A."""
    y = loop.respond(u)
    return float(u @ y / (u @ u))


def _nearest(loop: PlantLoop, u: FloatArray) -> GeneralizedPlays:
    """Identify the plays that are nearest to a loop of another family."""
    found = identify(
        u,
        loop.respond(u),
        GPI_ORDER,
        offset=False,
        nonnegative=True,
        start="rest",
        starts=GPI_STARTS,
        max_iterations=GPI_ITERATIONS,
    )
    envelope = tuple(found.envelope.to_dict().values())
    return GeneralizedPlays(envelope, found.thresholds, found.weights)


def _resized(
    plant: Plant, effect: HiddenEffect, bare: Readings, size: float
) -> HiddenEffect:
    """Change the size of an effect that drowns, or drowns the rest."""

    def share(changed: HiddenEffect) -> float:
        readings = Readings(plant.actuator((changed,)), bare.commands)
        return rms(*readings.minus(bare, "fit")) / size

    within = SMALLEST_EFFECT[plant.loop.family], LARGEST_EFFECT
    return effect.resized(share, within, margin=0.1, most=16.0)


def _record(
    full: Readings, number: int, noise: float, random: np.random.Generator
) -> Record:
    """Add noise, convert and round as a laboratory's computer would."""
    item = full.commands[number]
    noisy = full.raw(number) + noise * random.standard_normal(item.samples)
    y = full.actuator.convert(noisy, item.dt, number)
    u = np.round(item.sampled(), 8)
    rounded = np.round(y / RESOLUTION_UM) * RESOLUTION_UM
    channels, period = (INPUT, OUTPUT), item.period_samples
    return Record(item.name, item.dt, u, rounded, *channels, "plant", item.use, period)


def told_of(
    spec: CaseSpec, unit: str, noise: float, size: float, **own: Any
) -> dict[str, Any]:
    """Give what the truth says of any case; ``own`` is what it says of this sort."""
    return {
        "seed": spec.seed,
        "kind": spec.kind,
        "family": spec.family,
        "spread": spec.spread,
        "campaign": spec.campaign,
        "unit": unit,
        **own,
        "noise_rms": noise,
        "noise_set_by": "the effect that shows least" if spec.effects else "drawn",
        "ratio_db": spec.ratio_db if spec.effects else None,
        "output_rms": size,
    }


def effect_told(effect: HiddenEffect, **own: Any) -> dict[str, Any]:
    """Give what the truth says of any effect; ``own`` is what it says of this sort."""
    form = effect.of_form
    return {
        "name": effect.kind.name,
        "form": effect.form,
        "place": effect.kind.place,
        "listed": effect.kind.listed,
        "parameters": form.told(effect.parameters),
        "units": {name: item.unit for name, item in form.ranges.items()},
        **own,
        "views": list(effect.kind.views),
    }


def _retuned(difference: list[FloatArray], output: list[FloatArray]) -> float:
    """What is left of a difference after the best gain and offset of the base."""
    d, y = np.concatenate(difference), np.concatenate(output)
    design = np.stack([y, np.ones_like(y)], axis=1)
    return rms(d - design @ np.linalg.lstsq(design, d)[0])


def _decibel(size: float, noise: float) -> float | None:
    """Ratio in dB; None for nothing at all."""
    return float(20.0 * np.log10(size / noise)) if size > 1e-9 * noise else None

"""One case: a plant, its records, the model that is handed over, and the truth."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from hystbench.challenge.base import INPUT, OUTPUT, base_model, quasi_static, slope
from hystbench.challenge.excitation import CAMPAIGNS, RecordCommand
from hystbench.challenge.plant.actuator import Actuator, KnownMode
from hystbench.challenge.plant.effects import IN_ACTUATOR
from hystbench.challenge.plant.hysteresis import PlantLoop, draw
from hystbench.challenge.plant.kind import HiddenEffect
from hystbench.challenge.plant.kind import draw as draw_effect
from hystbench.challenge.spec import CaseSpec
from hystbench.challenge.where import where
from hystbench.model import Model
from hystbench.record import FloatArray, Record

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
RESOLUTION = 0.001
#: Where nothing is hidden the noise is drawn from this interval, in um.
PLAIN_NOISE = (0.01, 0.1)
#: Streams of random numbers.
PLANT, EFFECTS, EXCITATION, NOISE = 1, 2, 3, 4


@dataclass(frozen=True)
class Case:
    """What a solver gets, and beside it what only the judge may see.

    Parameters
    ----------
    records : tuple of Record
    model : Model or None
        The base model; None where the solver is to identify a linear one.
    truth : mapping
        As docs/challenge.md tells.
    """

    records: tuple[Record, ...]
    model: Model | None
    truth: dict[str, Any] = field(repr=False)


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
    excitations = CAMPAIGNS[spec.campaign](spec.random(EXCITATION))
    fit = tuple(item for item in excitations if item.use == "fit")
    plant, drawn = _draw(spec, excitations)
    bare = Readings(plant.actuator(()), excitations)
    size = rms(bare.of(fit))
    effects = tuple(_resized(plant, effect, bare, fit, size) for effect in drawn)
    full = Readings(plant.actuator(effects), excitations)
    without = [
        bare
        if len(effects) == 1
        else Readings(plant.actuator((*effects[:k], *effects[k + 1 :])), excitations)
        for k in range(len(effects))
    ]
    sizes = [rms(full.minus(item, fit)) for item in without]
    random = spec.random(NOISE)
    noise = float(np.exp(random.uniform(*np.log(PLAIN_NOISE))))
    if effects:
        noise = min(sizes) / 10.0 ** (spec.ratio_db / 20.0)
    records = tuple(
        _record(full, number, noise, random) for number in range(len(excitations))
    )
    linear = "hysteresis" in spec.effects
    model = base_model(plant.loop, plant.mode, excitations, linear)
    noise_rms = float(np.hypot(noise, RESOLUTION / np.sqrt(12.0)))
    truth = told_of(spec, OUTPUT.unit, noise_rms, size)
    truth["mode"] = None if plant.mode is None else asdict(plant.mode)
    truth["effects"] = []
    fit_records = [record for record in records if record.use == "fit"]
    for k, effect in enumerate(effects):
        difference = full.minus(without[k], fit)
        truth["effects"].append(
            effect_told(effect)
            | {
                "resized": effect is not drawn[k],
                "rms": sizes[k],
                "ratio_db": _decibel(sizes[k], noise),
                "ratio_retuned_db": _decibel(
                    _retuned(difference, without[k].of(fit)), noise
                ),
                "where": where(
                    effect.kind, fit_records, difference, without[k].of(fit)
                ),
            }
        )
    gap = full.minus(bare, fit)
    truth["ratio_all_db"] = _decibel(rms(gap), noise) if effects else None
    truth["ratio_all_retuned_db"] = _decibel(_retuned(gap, bare.of(fit)), noise)
    held_out = tuple(item for item in excitations if item.use == "hold-out")
    truth["hold_out"] = _hold_out(full, bare, held_out, model)
    base_error = _minus(bare.of(fit), _simulated(model, fit))
    truth["base_error_fit_rms"] = rms(base_error)
    return Case(records, model, truth)


class Readings:
    """Noise-free readings of a plant on all records.

    Parameters
    ----------
    actuator : Actuator
    excitations : tuple of RecordCommand
        All records; a record's number is its place here.
    """

    def __init__(
        self, actuator: Actuator, excitations: tuple[RecordCommand, ...]
    ) -> None:
        self.actuator, self.excitations = actuator, excitations
        self._read: dict[str, FloatArray] = {}

    def raw(self, item: RecordCommand) -> FloatArray:
        """Reading before the converter, computed once."""
        if item.name not in self._read:
            number = self.excitations.index(item)
            self._read[item.name] = self.actuator.read(
                item, item.dt, item.samples, number
            )
        return self._read[item.name]

    def of(self, chosen: tuple[RecordCommand, ...]) -> list[FloatArray]:
        """Readings as they are written down, but for noise."""
        return [
            self.actuator.convert(self.raw(item), item.dt, self.excitations.index(item))
            for item in chosen
        ]

    def minus(
        self, less: Readings, chosen: tuple[RecordCommand, ...]
    ) -> list[FloatArray]:
        """Difference to another plant's readings."""
        return _minus(self.of(chosen), less.of(chosen))


def _draw(
    spec: CaseSpec, excitations: tuple[RecordCommand, ...]
) -> tuple[Plant, tuple[HiddenEffect, ...]]:
    random = spec.random(PLANT)
    loop = draw(spec.family, random)
    # both are drawn in any case, so that the mode does not hang on the effects
    known = random.uniform() < 0.5
    mode = KnownMode(
        frequency_hz=float(np.exp(random.uniform(*np.log([70.0, 320.0])))),
        damping_ratio=float(np.exp(random.uniform(*np.log([0.015, 0.06])))),
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
            hidden = _other_loop(effect.form, loop, excitations, random)
        if name == "hysteresis":
            gain = slope(loop, quasi_static(excitations))
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
    excitations: tuple[RecordCommand, ...],
    random: np.random.Generator,
) -> PlantLoop:
    """Draw a loop of another shape and of the same mean gain."""
    other = draw("gpi" if form == "other-gpi" else form, random)
    u = quasi_static(excitations)
    mine, others = loop.respond(u), other.respond(u)
    return other.scaled(float(mine @ others / (others @ others)))


def _resized(
    plant: Plant,
    effect: HiddenEffect,
    bare: Readings,
    fit: tuple[RecordCommand, ...],
    size: float,
) -> HiddenEffect:
    """Change the size of an effect that drowns, or drowns the rest."""

    def share(changed: HiddenEffect) -> float:
        readings = Readings(plant.actuator((changed,)), bare.excitations)
        return rms(readings.minus(bare, fit)) / size

    within = SMALLEST_EFFECT[plant.loop.family], LARGEST_EFFECT
    return effect.resized(share, within, margin=0.1, most=16.0)


def _record(
    full: Readings, number: int, noise: float, random: np.random.Generator
) -> Record:
    """Add noise, convert and round as a laboratory's computer would."""
    item = full.excitations[number]
    noisy = full.raw(item) + noise * random.standard_normal(item.samples)
    y = full.actuator.convert(noisy, item.dt, number)
    u = np.round(item.sampled(), 8)
    rounded = np.round(y / RESOLUTION) * RESOLUTION
    channels, period = (INPUT, OUTPUT), item.period_samples
    return Record(item.name, item.dt, u, rounded, *channels, "twin", item.use, period)


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
    form = effect.law
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


def _hold_out(
    full: Readings, bare: Readings, chosen: tuple[RecordCommand, ...], model: Model
) -> dict[str, float]:
    """Gap on the hold-out records: all of it, and what the effects explain."""
    base = _simulated(model, chosen)
    return {
        "gap_rms": rms(_minus(full.of(chosen), base)),
        "explainable_rms": rms(full.minus(bare, chosen)),
        "base_error_rms": rms(_minus(bare.of(chosen), base)),
    }


def _simulated(model: Model, chosen: tuple[RecordCommand, ...]) -> list[FloatArray]:
    return [model.simulate(item.sampled(), item.dt) for item in chosen]


def _minus(some: list[FloatArray], others: list[FloatArray]) -> list[FloatArray]:
    return [one - other for one, other in zip(some, others, strict=True)]


def _retuned(difference: list[FloatArray], output: list[FloatArray]) -> float:
    """What is left of a difference after the best gain and offset of the base."""
    d, y = np.concatenate(difference), np.concatenate(output)
    design = np.stack([y, np.ones_like(y)], axis=1)
    return float(np.sqrt(np.mean((d - design @ np.linalg.lstsq(design, d)[0]) ** 2)))


def rms(parts: list[FloatArray]) -> float:
    """RMS of all parts together."""
    pooled = np.concatenate(parts)
    return float(np.sqrt(np.mean(pooled**2)))


def _decibel(size: float, noise: float) -> float | None:
    """Ratio in dB; None for nothing at all."""
    return float(20.0 * np.log10(size / noise)) if size > 1e-9 * noise else None

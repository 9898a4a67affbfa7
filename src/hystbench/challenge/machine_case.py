"""A case of a machine: its records, the base that is handed over, and the truth."""

from typing import Any

import numpy as np

from hystbench.challenge.case import Case, effect_told, told_of
from hystbench.challenge.drawn_machine import (
    InputsAndOutputs,
    Machine,
    draw_machine,
    linear_parts,
    reach_of,
)
from hystbench.challenge.plant.effects import IN_MACHINE
from hystbench.challenge.plant.kind import HiddenEffect, Reach, draw, log_uniform
from hystbench.challenge.spec import BASE, EFFECTS, NOISE, PLANT, CaseSpec
from hystbench.metrics import rms
from hystbench.model import Model
from hystbench.record import FloatArray, Record
from hystbench.samples import between_periods

#: An effect is to be within these shares of the output's rms on the fit records;
#: outside, its size is changed.
EFFECT_SHARES = (0.04, 0.4)
#: Where nothing is hidden the noise is drawn from this interval of shares.
PLAIN_NOISE_SHARES = (0.002, 0.02)
#: Steps of the converter over both signs of the largest output, and a half more.
CONVERTER_STEPS = 65536
#: Of masses on a spring under a force so many are handed over as a model file.
SHARE_WITH_MODEL = 0.25
#: Share of its standard deviation by which an input that repeats may differ.
ALIKE = 0.1


def make_machine_case(spec: CaseSpec) -> Case:
    """Make a case of a machine; the same spec gives the same numbers."""
    outer = any(IN_MACHINE[name].place != "inside" for name in spec.effects)
    machine = draw_machine(spec.family, spec.random(PLANT), False if outer else None)
    reach = reach_of(machine)
    random = spec.random(EFFECTS)
    kinds = [IN_MACHINE[name] for name in spec.effects]
    hidden = tuple(draw(k, random, spec.spread, spec.forms(k)) for k in kinds)
    hidden = tuple(_resized(machine, item, reach) for item in hidden)
    fit = machine.read(hidden, reach, "fit")
    held_out = machine.read(hidden, reach, "hold-out")
    signals = [*fit, *held_out]
    output = rms(*(y - y.mean() for _, y in fit))
    rests = [tuple(x for x in hidden if x is not own) for own in hidden]
    sizes = [_size(machine, fit, rest, reach) for rest in rests]
    random = spec.random(NOISE)
    noise = output * log_uniform(random, *PLAIN_NOISE_SHARES)
    if hidden:
        noise = min(sizes) / 10.0 ** (spec.ratio_db / 20.0)
    step = 3.0 * max(float(np.max(np.abs(y))) for _, y in signals) / CONVERTER_STEPS
    records = []
    for item, (u, y) in zip(machine.records, signals, strict=True):
        noisy = y + noise * random.standard_normal(len(y))
        records.append(
            Record(
                item.name,
                1.0 / machine.rate_hz,
                np.array([float(f"{value:.8g}") for value in u]),
                np.round(noisy / step) * step,
                *machine.channels,
                "plant",
                item.use,
                _repeats(item.period_samples, u),
            )
        )
    model = _model(machine, spec)
    gap = _left(machine, held_out)
    noise_rms = float(np.hypot(noise, step / np.sqrt(12.0)))
    base = "linear" if model is None else "model-file"
    unit = machine.channels[1].unit
    own = {"closed_loop": machine.gains[0] > 0.0, "base": base}
    truth = told_of(spec, unit, noise_rms, output, **own) | {
        "linear": _linear(machine),
        "effects": [
            _told(item, size, noise_rms, reach)
            for item, size in zip(hidden, sizes, strict=True)
        ],
        "hold_out": {
            "gap_rms": gap,
            "explainable_rms": gap if hidden else 0.0,
            "base_error_rms": 0.0,
        },
        "base_error_fit_rms": 0.0,
    }
    return Case(tuple(records), model, truth)


def _repeats(period: int | None, u: FloatArray) -> int | None:
    """Give a period if the input has it: a controller's force repeats no other way.

    What changes in the machine from one period to the next changes that force.
    """
    if period is None or between_periods(u, period) > ALIKE * float(np.std(u)):
        return None
    return period


def _resized(machine: Machine, effect: HiddenEffect, reach: Reach) -> HiddenEffect:
    """Change the size of an effect that a linear machine hides, or that is all."""

    def share(changed: HiddenEffect) -> float:
        signals = machine.read((changed,), reach, "fit")
        output = rms(*(y - y.mean() for _, y in signals))
        return _size(machine, signals, (), reach) / output

    return effect.resized(share, EFFECT_SHARES, margin=0.2, most=8.0)


def _size(
    machine: Machine,
    full: InputsAndOutputs,
    others: tuple[HiddenEffect, ...],
    reach: Reach,
) -> float:
    """Measure how much an effect changes the output of the fit records.

    A single effect: what it leaves that no linear machine explains. Of several, and of
    a mass without a spring: what the output without it differs by. The others leave
    more, and a free mass adds up every small force, whatever a model has it do.
    """
    if not others and machine.family != "free-mass":
        return _left(machine, full)
    pairs = zip(full, machine.read(others, reach, "fit"), strict=True)
    return rms(*(y - other for (_, y), (_, other) in pairs))


def _left(machine: Machine, signals: InputsAndOutputs) -> float:
    return rms(*(y - fitted for y, fitted in linear_parts(machine, signals)))


def _model(machine: Machine, spec: CaseSpec) -> Model | None:
    """The machine without its effects as a model file, of a quarter of the masses."""
    asked = spec.random(BASE).uniform() < SHARE_WITH_MODEL
    if not asked or machine.part is None or machine.family != "mass-spring":
        return None
    from hystbench.blocks.mechanism import Mechanism  # late: one of four wants it

    block = Mechanism(**_linear(machine), hold="band-limited")
    return Model("base", *machine.channels, (block,))


def _linear(machine: Machine) -> dict[str, Any]:
    if machine.part is None:
        tank = machine.tanks[0]
        return {
            "tanks": len(machine.tanks),
            "area": tank.area,
            "coefficient": tank.coefficient,
        }
    part = machine.part
    return {
        "mass": part.mass,
        "damping": part.damping,
        "stiffness": part.stiffness,
        "output": machine.output,
    }


def _told(
    effect: HiddenEffect, size: float, noise: float, reach: Reach
) -> dict[str, Any]:
    form = effect.of_form
    ratio = float(20.0 * np.log10(max(size, 1e-12 * noise) / noise))
    physical = form.numbers(effect.parameters, reach) if form.numbers else {}
    return effect_told(effect, physical=physical) | {
        "rms": size,
        "ratio_db": ratio,
        "ratio_retuned_db": ratio,
        "where": [],
    }

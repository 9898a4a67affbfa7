"""What each effect would add to the output on given inputs, at points of its range."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hystbench.blocks.base import Block
from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Declined
from hystbench.gap.effects.variant import Variant
from hystbench.gap.fitting.added_signals import beside_columns
from hystbench.gap.fitting.state import ModelState
from hystbench.record import FloatArray

RANGE_POINTS = 6
"""Points of an effect's range that are looked at; two of each further number."""


@dataclass(frozen=True, eq=False)
class Shape:
    """What an effect adds at one point of its range."""

    effect: str
    form: str
    values: dict[str, float]
    """Numbers that are searched, such as a time constant."""
    scaled: str
    """The number that it is proportional to; empty where ``values`` alone say how
    strong it is."""
    block: Block | None
    """Block with ``scaled`` at its unit; None of a signal beside the chain."""
    columns: FloatArray
    """What it adds, shape (scored samples, k); k > 1 where each record has its own."""
    unit: float
    """The value of ``scaled`` at which it adds that."""
    charge: float
    """Numbers that it is charged for in the search for names."""


def shapes_of(state: ModelState) -> tuple[list[Shape], dict[str, str]]:
    """Simulate every effect of the vocabulary beside a base.

    Parameters
    ----------
    state : ModelState
        The base on the records.

    Returns
    -------
    shapes : list of Shape
    declined : dict of str to str
        Why an effect makes no sense beside this base or on these records.
    """
    shapes: list[Shape] = []
    declined: dict[str, str] = {}
    for name, effect in effects().items():
        try:
            variants = list(effect.every_variant(state.simulation))
        except Declined as why:
            declined[name] = str(why)
            continue
        found = [shape for item in variants for shape in _of_variant(state, item)]
        if not found:
            declined[name] = "it changes nothing on these records"
        shapes += found
    return shapes, declined


def _of_variant(state: ModelState, variant: Variant) -> Iterator[Shape]:
    """Give the shapes of one variant at a few points of its range."""
    for point in itertools.product(*_thinned(variant)):
        values = dict(zip(variant.grids, point, strict=True))
        try:
            yield from _at(state, variant, values)
        except InputError:
            continue  # the block refuses these values


def _thinned(variant: Variant) -> list[Sequence[float]]:
    """Give a few values of each number that is searched."""
    axes: list[Sequence[float]] = []
    for k, axis in enumerate(variant.grids.values()):
        count = min(RANGE_POINTS if k == 0 else 2, len(axis))
        places = np.linspace(0, len(axis) - 1, count).round().astype(int)
        axes.append([float(axis[place]) for place in places])
    return axes


def _at(
    state: ModelState, variant: Variant, values: dict[str, float]
) -> Iterator[Shape]:
    about = (variant.effect, variant.form, values)
    if variant.beside is not None:
        columns = beside_columns(state.records, state.sample, variant.beside, values)
        yield Shape(*about, "", None, columns, 1.0, variant.freedom)
        return
    take, tail = state.sample.take, state.simulation.tail

    def output(given: dict[str, float]) -> tuple[FloatArray, Block]:
        blocks = variant.build(given)
        return take(tail(variant.start, blocks)), blocks[variant.positions[0]]

    zero = {**values, **dict.fromkeys(variant.unit, 0.0)}
    if variant.zero is not None:
        now, _ = output({**zero, **variant.zero})
    elif variant.unit and not variant.neutral:
        now, _ = output(zero)
    else:
        now = take(state.simulation.output)
    for name, step in variant.unit.items() or ((("", 1.0)),):
        after, block = output({**zero, name: step} if name else zero)
        column = after - now
        if np.isfinite(column).all() and column.any():
            yield Shape(*about, name, block, column[:, None], step, variant.freedom)

"""The search for the parameters of a block."""

from collections.abc import Callable, Mapping

import numpy as np

from hystbench.blocks import block_class
from hystbench.blocks.attached import attached
from hystbench.blocks.base import Block
from hystbench.blocks.held import HeldBlock
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.model import Model
from hystbench.plain_fits.table import PROPORTIONAL_TO, Searched
from hystbench.plain_fits.task import EffectFit, Task, through
from hystbench.record import FloatArray

#: Evaluations of a search from one start, Jacobians not counted.
EVALUATIONS = 8
#: Starts that a search descends from, the best of those that there are.
DESCENTS = 2
_LISTS = ("magnitudes", "time_constants_s")


def _chain(
    task: Task, effect: str, place: int, values: Mapping[str, float], form: str = ""
) -> tuple[Block, ...]:
    chain = list(task.model.chain)
    block = block_class(effect)
    given: dict[str, object] = {
        key: (value,) if key in _LISTS else value for key, value in values.items()
    }
    if issubclass(block, HeldBlock):
        given["hold"] = "band-limited"
    if form:
        given["form"] = form
    if effect == "stiffness-hardening" and place < len(chain):
        mode = chain[place].to_mapping()
        chain[place] = block.from_mapping({**mode, **given})
    else:
        chain.insert(place, block.from_mapping(given))
    return tuple(chain)


def search(
    task: Task,
    effect: str,
    place: int,
    searched: Mapping[str, Searched],
    form: str = "",
) -> EffectFit:
    """Fit the parameters of an effect's block to all records at once.

    Parameters
    ----------
    task : Task
    effect, form : str
        The block, and its form where it has several.
    place : int
        Of the block in the chain.
    searched : mapping of str to Searched
        Its parameters.
    """
    from scipy.optimize import least_squares  # late: imported by jobs that fit only

    names = list(searched)
    items = list(searched.values())
    before = _before(task, place, block_class(effect))

    def values(x: FloatArray) -> dict[str, float]:
        return {
            name: item.outer(v) for name, item, v in zip(names, items, x, strict=True)
        }

    def residual(x: FloatArray) -> FloatArray:
        chain = _chain(task, effect, place, values(x), form)
        error = _behind(task, chain, place, before) - task.measured
        # a mode that ran away has no output; the search is to turn back
        return np.nan_to_num(error, nan=task.size, posinf=task.size, neginf=-task.size)

    low = np.array([item.inner(item.low) for item in items])
    high = np.array([item.inner(item.high) for item in items])
    starts = [
        np.clip(
            [
                item.inner(item.starts[min(number, len(item.starts) - 1)])
                for item in items
            ],
            low,
            high,
        )
        for number in range(max(len(item.starts) for item in items))
    ]
    if effect in PROPORTIONAL_TO:
        number = names.index(PROPORTIONAL_TO[effect])
        starts = _scaled(task, starts, number, residual, low[number], high[number])
    found = [
        least_squares(
            residual, x, bounds=(low, high), max_nfev=EVALUATIONS, diff_step=1e-4
        )
        for x in starts[:DESCENTS]
    ]
    best = min(found, key=lambda item: float(item.cost))
    chosen = values(best.x)
    chain = _chain(task, effect, place, chosen, form)
    model = Model("fitted", task.model.input, task.model.output, chain)
    return EffectFit(
        effect,
        residual(best.x) + task.measured,
        2.0 * float(best.cost) / len(task.measured),
        len(names),
        chosen,
        lambda record: model.simulate(record.u, record.dt),
    )


def _scaled(
    task: Task,
    starts: list[FloatArray],
    number: int,
    residual: Callable[[FloatArray], FloatArray],
    low: float,
    high: float,
) -> list[FloatArray]:
    """Solve at each start for the parameter that scales the effect; the best first."""
    missing = task.measured - task.base
    rated = []
    for x in starts:
        added = residual(x) + missing
        square = float(added @ added) or 1.0
        factor = float(added @ missing) / square
        scaled = x.copy()
        scaled[number] = np.clip(factor * x[number], low, high)
        rated.append((factor**2 * square, tuple(scaled)))
    return [np.array(x) for _, x in sorted(rated, reverse=True)]


def _before(task: Task, place: int, block: type[Block]) -> list[FloatArray] | None:
    """Signals that enter a block, which do not change with its parameters."""
    if place == 0 or issubclass(block, WrappingBlock):
        return None
    head = Model("head", task.model.input, task.model.output, task.model.chain[:place])
    return [head.simulate(record.u, record.dt) for record in task.records]


def _behind(
    task: Task, chain: tuple[Block, ...], place: int, before: list[FloatArray] | None
) -> FloatArray:
    if before is None:
        model = Model("whole", task.model.input, task.model.output, chain)
        return task.output(model)
    rest = attached(chain[place:])
    entered = zip(before, task.records, strict=True)
    return np.concatenate([through(rest, y, record) for y, record in entered])

"""``hystbench job figure``: draw one figure from files of results."""

import inspect
from typing import Any

from hystbench.errors import InputError
from hystbench.figures import drawer
from hystbench.options import In, Out, command


@command
def figure(
    name: str,
    *,
    records: tuple[In, ...] = (),
    runs: tuple[In, ...] = (),
    table: In | None = None,
    identified: In | None = None,
    outs: tuple[Out, ...],
) -> None:
    """Draw the figure NAME and write it to every --out, a PNG or SVG file.

    The arrays of a run lie beside it.
    """
    draw = drawer(name)
    from hystbench.figures import style

    given = {"records": records, "runs": runs, "table": table, "identified": identified}
    with style.in_style():
        drawn = draw(**_inputs(name, inspect.signature(draw), given))
        for out in outs:
            style.save(drawn, out)


def _inputs(
    name: str, signature: inspect.Signature, given: dict[str, Any]
) -> dict[str, Any]:
    """Take what a figure is drawn from, and refuse what it does not use."""
    for key, value in given.items():
        option = f"--{key.removesuffix('s')}"
        if value and key not in signature.parameters:
            raise InputError(f"figure {name}: does not use {option}; leave it out")
        if not value and key in signature.parameters:
            raise InputError(f"figure {name}: expected {option}")
    return {key: given[key] for key in signature.parameters}

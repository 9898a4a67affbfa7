"""``hystbench identify``: Algorithm 1 on a slow record."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from hystbench import options
from hystbench.files import write_json
from hystbench.identification import identify as run_algorithm
from hystbench.identification.shape import envelope_scale
from hystbench.operators import PUBLISHED_ENVELOPE
from hystbench.record import load_record


@click.command()
@click.argument("record", type=options.FILE)
@options.settings
@options.out
def identify(record: Path, settings: dict[str, Any], out: Path) -> None:
    """Identify envelope functions, thresholds and weights on the slow RECORD.

    On the twin the published envelopes are fitted beside the identified ones, and
    these get the same scale: data cannot tell it, and the GPO filter's convergence
    factor depends on it.
    """
    slow = load_record(record)
    tolerable = settings["tolerable_relative_error"]
    twin = slow.origin == "twin"
    span = float(slow.u.min()), float(slow.u.max())
    found = run_algorithm(
        slow.u,
        slow.y,
        settings["order"],
        epsilon=tolerable**2 * float(np.sum(slow.y**2)),
        max_iterations=settings["max_iterations"],
        starts=settings["starts"],
        seed=settings["seed"],
        scale=envelope_scale(PUBLISHED_ENVELOPE, *span) if twin else None,
        published=PUBLISHED_ENVELOPE if twin else None,
        progress=_tell,
    )
    write_json(out, found.to_dict() | {"signal": slow.name})
    click.echo(found.message, err=True)


def _tell(iteration: int, cost: float) -> None:
    if iteration % 25 == 0:
        click.echo(f"iteration {iteration}: least J = {cost:.6g}", err=True)

"""``hystbench job identify``: Algorithm 1 on a slow record."""

import click

from hystbench.files import write_json
from hystbench.identification.algorithm import identify_slow_loop
from hystbench.options import In, Out, Settings, command
from hystbench.record import load_record


@command
def identify(record: In, *, settings: Settings, out: Out) -> None:
    """Identify envelope functions, thresholds and weights on the slow RECORD."""
    slow = load_record(record)
    found = identify_slow_loop(slow, settings, _tell)
    write_json(out, found.to_dict() | {"signal": slow.name})
    click.echo(found.message, err=True)


def _tell(iteration: int, cost: float) -> None:
    if iteration % 25 == 0:
        click.echo(f"iteration {iteration}: least J = {cost:.6g}", err=True)

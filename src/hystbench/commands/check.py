"""``hystbench check``: what records are like, and which effects they can reveal."""

from pathlib import Path
from typing import Annotated

import click

from hystbench import options
from hystbench.dataset import load_dataset
from hystbench.files import write_text
from hystbench.inspection import screen
from hystbench.inspection.check import check as look
from hystbench.options import DatasetFile, command


@command
def check(
    dataset: DatasetFile,
    *,
    out: Annotated[Path | None, options.NEW_FILE, "Write a page (HTML) too."] = None,
    effects: Annotated[
        bool, "Whether to simulate effects; long records take minutes."
    ] = True,
    model: Annotated[
        str | None,
        "What 'hystbench gap --model' shall take: it is run on all records, and "
        "effects are judged beside it. By default beside a loop that does not depend "
        "on the rate.",
    ] = None,
) -> None:
    """Say what the records of DATASET are like and which effects they can reveal.

    Prints one screen: rates, jitter, periods, stuck channels, missing samples, delays,
    noise, bands and levels; what is wrong, with the line for dataset.yaml that mends
    it; and how strong each effect must be to be seen, and told from the others, beside
    a model ('--model') or else beside a loop that does not depend on the rate.
    """
    found = look(load_dataset(dataset), effects, model or "")
    for line in screen.lines(found):
        click.echo(line)
    if out is not None:
        from hystbench.inspection.page import page  # late: it draws

        write_text(out, page(found))
        click.echo(f"{out}: the same as a page")

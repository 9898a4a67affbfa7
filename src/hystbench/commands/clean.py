"""``hystbench clean``: remove what hystbench wrote, and nothing else."""

import click

from hystbench.options import Folder, command
from hystbench.written import remove_below

#: Files that stay and are named; the others are counted.
NAMED = 3


@command
def clean(folders: tuple[Folder, ...]) -> None:
    """Remove all in FOLDERS that hystbench wrote and that nobody changed since.

    Folders that are empty then go as well. What stays is told.
    """
    for folder in folders:
        left = remove_below(folder)
        if left:
            told = ", ".join(map(str, left[:NAMED]))
            more = f" and {len(left) - NAMED} more" if len(left) > NAMED else ""
            click.echo(
                f"{folder}: not written by hystbench, or changed since, so it stays: "
                f"{told}{more}"
            )

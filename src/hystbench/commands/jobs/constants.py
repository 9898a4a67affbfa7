"""``hystbench job constants``: the ranking with other constants."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.compare.constants import Row, write_constants
from hystbench.files import read_json
from hystbench.pressure.constants import vary_constants
from hystbench.pressure.twins import read_twins
from hystbench.published import load


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.identified
@options.settings
@options.out
def constants(
    twins: tuple[Path, ...],
    identified: Path | None,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Rank the filters on TWINS with other zero errors and with a constant tap."""
    envelopes = {} if identified is None else read_json(identified)
    published = {(p.signal, p.model): p.mse.value for p in load()}
    calibrated = set(settings["calibrated"])
    rows = []
    for twin in read_twins(twins):
        for each in vary_constants(twin, settings, envelopes, published):
            halves = [
                each.pairs([s for s in each.signals if (s in calibrated) is inside])
                for inside in (True, False)
            ]
            others = [f"{s}: {m}" for s, m in each.first.items() if m != "gpo"]
            rows.append(
                Row(
                    twin=each.twin,
                    family=each.family,
                    zero_error=each.zero_error,
                    constant_tap=each.constant_tap,
                    configured=each.configured,
                    signals=len(each.signals),
                    gpo_first=each.gpo_first,
                    not_first="; ".join(others),
                    pairs_calibrated=halves[0],
                    pairs_held_out=halves[1],
                    diverged=each.diverged,
                    mean={
                        m: each.mean(m) for m in dict.fromkeys(m for _, m in each.mse)
                    },
                )
            )
    write_constants(rows, out)

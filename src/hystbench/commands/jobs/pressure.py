"""``hystbench job pressure``: the claims on many twins, step sizes and seeds."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.compare.claims.claim import Claim
from hystbench.compare.comparison import held_out_signals
from hystbench.files import whole_folder
from hystbench.pressure.ensemble import run_ensemble, step_choices
from hystbench.pressure.fits import fit_rdgpi
from hystbench.pressure.judging import Count, count, press, pressed_claims
from hystbench.pressure.report import WRITTEN, write_pressure
from hystbench.pressure.runs import filter_jobs
from hystbench.pressure.twins import read_twins
from hystbench.written import check_free


@click.command()
@click.argument("twins", type=options.FILE, nargs=-1, required=True)
@options.settings
@options.out_folder
def pressure(twins: tuple[Path, ...], settings: dict[str, Any], out: Path) -> None:
    """Judge the claims on TWINS with several seeds and step sizes."""
    for name in WRITTEN:
        check_free(out / name)
    design = settings["design"]
    factors, filters = design["step_factors"], list(filter_jobs(settings))
    held_out = held_out_signals(settings["calibrated"])
    read = read_twins(twins)
    claims: tuple[Claim, ...] = ()
    counts: list[Count] = []
    for twin in read:
        click.echo(f"twin {twin.name} ({twin.family})", err=True)
        rdgpi = fit_rdgpi(twin, settings)
        for seed in range(design["seeds"]):
            ensemble = run_ensemble(twin, settings, rdgpi, seed, factors)
            draw = [settings["measure"]["seed"], seed, *twin.name.encode()]
            choices = step_choices(filters, factors, design["step_choices"], draw)
            claims = claims or pressed_claims(ensemble.evidence(choices[0]))
            counts += count(ensemble, claims, choices, held_out)
    possible = len(factors) ** len(filters)
    told = {
        "twins": dict(Counter(twin.family for twin in read)),
        "seeds": design["seeds"],
        "step_factors": factors,
        "step_choices": min(design["step_choices"], possible),
        "step_choices_possible": possible,
    }
    with whole_folder(out, WRITTEN) as fresh:
        write_pressure(press(counts, claims), counts, told, fresh)

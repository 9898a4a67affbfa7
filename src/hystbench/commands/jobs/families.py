"""``hystbench job families``: twins with other hysteresis than the twin's own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from hystbench import options
from hystbench.files import whole_folder, write_json
from hystbench.model import load_model
from hystbench.signals import load_signal
from hystbench.twins.families import FAMILIES, FamilyTask
from hystbench.twins.family_fit import fit_family, judge
from hystbench.twins.targets import targets


@click.command()
@click.argument("signals", type=options.FILE, nargs=-1, required=True)
@click.option("--model", type=options.FILE, required=True, help="The twin (YAML).")
@click.option("--loop", type=options.FILE, required=True, help="The slow signal.")
@options.settings
@options.out_folder
def families(
    signals: tuple[Path, ...],
    model: Path,
    loop: Path,
    settings: dict[str, Any],
    out: Path,
) -> None:
    """Fit Preisach and Jiles-Atherton twins to the MODEL's loop and published RMS.

    SIGNALS are calibration signals; the tables' implied RMS displacement of each is a
    target. Writes a model file a family, and ``families.json``: the relative error of
    the loop and the errors of the RMS, the first twin's own beside them.
    """
    excitations = tuple(load_signal(path) for path in signals)
    wanted = targets(signal.name for signal in excitations)
    task = FamilyTask(
        load_model(model),
        load_signal(loop),
        excitations,
        tuple(target.rms for target in wanted),
        settings["seed"],
    )
    report = {task.model.name: judge(task, task.model)}
    with whole_folder(out, ("families.json", "*.yaml")) as fresh:
        for family in FAMILIES.values():
            fit = fit_family(family, task, tell=lambda line: click.echo(line, err=True))
            fit.twin.save(fresh / f"{fit.twin.name}.yaml")
            report[fit.twin.name] = {
                **judge(task, fit.twin),
                "at_bounds": list(fit.at_bounds),
            }
        write_json(fresh / "families.json", report)

"""``hystbench job families``: twins with other hysteresis than the twin's own."""

import click

from hystbench.files import whole_folder, write_json
from hystbench.job import In, OutFolder, Settings, job
from hystbench.model import load_model
from hystbench.signals import load_signal
from hystbench.twins.families import FAMILIES, FamilyTask
from hystbench.twins.family_fit import fit_family, judge
from hystbench.twins.targets import targets


@job
def families(
    signals: tuple[In, ...],
    *,
    model: In,
    loop: In,
    settings: Settings,
    out: OutFolder,
) -> None:
    """Fit Preisach and Jiles-Atherton twins to the MODEL's loop and published RMS.

    SIGNALS are calibration signals; the tables' implied RMS displacement of each is a
    target. LOOP is the slow signal. Writes a model file a family, and
    ``families.json``: the relative error of the loop and the errors of the RMS, the
    first twin's own beside them.
    """
    excitations = tuple(map(load_signal, signals))
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

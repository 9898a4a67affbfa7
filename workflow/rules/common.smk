# What all rules share: checked settings, and the source files that a job depends on.
import inspect
import json
import os
import re
import shlex
import sys
from pathlib import Path

import grimp

import hystbench
from hystbench.errors import InputError
from hystbench.figures import module_of
from hystbench.filters import filter_class, registry
from hystbench.registered import with_installed
from hystbench.settings import read_settings
from hystbench.waveforms import waveforms
from hystbench.command_files import check_replaceable
from hystbench.written import claim_logs

# Jobs call `hystbench`: the one of the interpreter that runs Snakemake.
shell.prefix(f"PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; ")

PACKAGE = Path(os.path.relpath(Path(hystbench.__file__).parent))
GRAPH = grimp.build_graph(
    "hystbench", cache_dir=".snakemake/imports", exclude_type_checking_imports=True
)
SCHEMA = workflow.source_path("../schemas/config.schema.yaml")
# Where a mistake in the config may be.
PLACE = ", ".join(
    dict.fromkeys(
        ["config.yaml", *map(str, workflow.overwrite_configfiles or [])]
        + ["--config"] * bool(workflow.config_settings.config)
    )
)


KERNELS = sorted(PACKAGE.glob("kernels/*.so"))

try:
    for folder in ("kernels", "challenge/kernels"):
        built = [file.stat().st_mtime for file in PACKAGE.glob(f"{folder}/*.so")]
        if not built:
            raise InputError(
                f"{PACKAGE}/{folder}: not compiled; expected 'make' to have run"
            )
        for source in PACKAGE.glob(f"{folder}/*.[ch]"):
            if source.stat().st_mtime > min(built):
                raise InputError(
                    f"{source}: newer than the compiled kernels; run 'make'"
                )
    SETTINGS = read_settings(config, SCHEMA, PLACE)
    # What installed packages add, by the package of ours to which they add it.
    INSTALLED = {
        package: list(with_installed({}, group, object).values())
        for package, group in (
            ("hystbench.blocks", "hystbench.blocks"),
            ("hystbench.gap.effects", "hystbench.effects"),
        )
    }
    # Snakemake itself would name no rule and no nearest name.
    for argument in sys.argv[1:]:
        SETTINGS.check_target(argument)
except InputError as error:
    refuse(error)
for line in SETTINGS.warnings:
    print(f"hystbench: warning: {line}", file=sys.stderr)


def keep_out(key, files):
    """Refuse inputs in results/: all in there can be made again, and may be removed."""
    results = Path("results")
    for file in files:
        places = {Path(file).absolute(), Path(file).resolve()}
        if any(
            place.is_relative_to(folder)
            for place in places
            for folder in (results.absolute(), results.resolve())
        ):
            sys.exit(
                f"hystbench: {PLACE}: {key}: {file} lies in results/, where all may be "
                "written anew; expected a file outside it"
            )


if SETTINGS.dataset is None:
    keep_out("twin: model", [SETTINGS.model_file])
    keep_out("pressure: twins", SETTINGS.twin_files)
    keep_out("constants: twins", SETTINGS.constants_files)
else:
    keep_out("source", [SETTINGS.dataset.path, *SETTINGS.dataset.record_files.values()])


def keep_others_files(dag):
    """Refuse to start where a job would remove or write over a file that is not ours.

    Snakemake removes what a job declares before the job runs.
    """
    waiting = list(dag.needrun_jobs())
    outputs = {str(file) for job in waiting for file in job.output}
    made = {str(file) for job in dag.jobs for file in job.output}
    inputs = {str(file) for job in waiting for file in job.input} - made
    logs = {}
    for job in waiting:
        for file in filter(None, [*job.log, job.benchmark]):
            above = [path for path in Path(str(file)).parents if path.name == "logs"]
            logs.setdefault(above[-1], []).append(str(file))
    try:
        check_replaceable(sorted(outputs), sorted(inputs))
        for folder, files in sorted(logs.items()):
            claim_logs(folder, sorted(files))
    except InputError as error:
        sys.exit(f"hystbench: {error}")


RESULTS = SETTINGS.results
COMPARE = f"{RESULTS}/compare"
TWIN = SETTINGS.dataset is None


def code(*modules):
    """Files of modules and of all that they import, with tables, words and kernels.

    As inputs of a rule they make an edited module rerun what depends on it.
    """
    names = set(modules).union(*(GRAPH.find_upstream_modules(name) for name in modules))
    for package in ("hystbench.blocks", "hystbench.formats", "hystbench.waveforms"):
        if package in names:
            # Blocks, formats and waveforms are found by name, so that no import tells of them.
            own = GRAPH.find_children(package)
            names |= own.union(*(GRAPH.find_upstream_modules(name) for name in own))
    files = []
    for name in sorted(names):
        path = PACKAGE.joinpath(*name.split(".")[1:])
        files.append(path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))
        # A table of a module, or of a package, stands in it under its name.
        table = path / path.name if path.is_dir() else path
        files.extend(filter(Path.is_file, [table.with_suffix(".yaml")]))
    if "hystbench.compare.verdict" in names:
        files.extend(sorted(PACKAGE.glob("compare/*.j2")))
    if "hystbench.kernels" in names:
        files.extend(KERNELS)
    for package, added in INSTALLED.items():
        if package in names:
            files.extend(files_outside(added))
    if "hystbench.waveforms" in names:
        kinds = [next(iter(each)) for each in config["excitations"].values()]
        files.extend(files_outside(waveforms(kind)[kind] for kind in kinds))
    return [str(file) for file in files]


def files_outside(found):
    """Files of those classes that are of installed packages."""
    names = {each.__module__ for each in found if not is_ours(each)}
    return sorted(os.path.relpath(inspect.getfile(sys.modules[name])) for name in names)


def is_ours(found):
    """Whether a class is hystbench's own."""
    return found.__module__.startswith("hystbench.")


def code_with(found, *modules):
    """Files of modules and of classes that are found by name, so no import tells."""
    listed = list(found)
    own = [each.__module__ for each in listed if is_ours(each)]
    return code(*modules, *own) + files_outside(listed)


def settings_text(settings):
    """Settings of a job as one word for the shell, the same for the same settings."""
    return json.dumps(settings, sort_keys=True)


def record(name):
    """Archive of a record."""
    return f"{RESULTS}/records/{name}.npz"


def run(signal, model, suffix="json"):
    """Result of a model on a signal."""
    return f"{RESULTS}/filters/{signal}/{model}.{suffix}"


def runs(suffix="json"):
    """Results of all models on all signals that the settings ask for."""
    return [
        run(signal, model, suffix)
        for signal in SETTINGS.signals
        for model in SETTINGS.models
    ]


def identified(wildcards):
    """The identified envelope functions, for the filter that uses them."""
    takes = filter_class(wildcards.filter).takes_envelopes
    if takes and SETTINGS.envelopes == "identified":
        return rules.identify.output
    return []


def figure(name, suffix):
    """Picture of a figure; those of the identification lie beside its numbers."""
    shown = {"identification", "figure-03-play", "figure-04-generalized-play"}
    folder = "identify" if name in shown else "figures"
    return f"{RESULTS}/{folder}/{name}.{suffix}"


def options(name, files):
    """An option of the command line, once for each file."""
    return " ".join(f"{name} {shlex.quote(str(file))}" for file in files)


# The paper's own numbers, an input of all that is compared with them.
PUBLISHED = sorted(
    str(file)
    for file in PACKAGE.glob("published/*")
    if file.suffix in {".csv", ".yaml"}
)

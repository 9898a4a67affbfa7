# The blind contest: `snakemake blind`. Data are made, solved and thrown away chunk by
# chunk. A solver's job has the data as its only input; the truth is in no file until
# the judge, who has the answers as input, makes it anew from the seeds.
import importlib.util

from hystbench.challenge.contest.plan import chunks, plan
from hystbench.errors import nearest

BLIND = "results/blind"
CONTEST = config["blind"]
PLANT_KERNELS = sorted(map(str, PACKAGE.glob("challenge/kernels/*.so")))
# Solvers that need a package that is not there, and those that enter.
MISSING = {
    name: [needed for needed in about["needs"] if not importlib.util.find_spec(needed)]
    for name, about in CONTEST["solvers"].items()
}
SKIPPED = {
    name: f"not entered: needs {' and '.join(needed)} (pip install hystbench[rivals])"
    for name, needed in MISSING.items()
    if needed
}
ENTERED = [name for name in CONTEST["solvers"] if name not in SKIPPED]
# The set that is judged, with all solvers, and the transfer set, with one.
BLIND_SOLVERS = {CONTEST["set"]: ENTERED}
if CONTEST["transfer"]:
    BLIND_SOLVERS["transfer"] = list(
        dict.fromkeys(BLIND_SOLVERS.get("transfer", []) + [CONTEST["solver"]])
    )
if CONTEST["solver"] not in CONTEST["solvers"]:
    sys.exit(
        f"hystbench: {PLACE}: blind: solver: {CONTEST['solver']!r}; "
        + nearest(CONTEST["solver"], CONTEST["solvers"])
    )


def blind_chunks(name):
    """Numbers of the chunks of a set."""
    return list(chunks(plan(name, CONTEST["scale"]), CONTEST["chunk"]))


def blind_case_settings(wildcards):
    """Which cases a chunk holds."""
    return settings_text(
        {
            "set": wildcards.set,
            "scale": CONTEST["scale"],
            "size": CONTEST["chunk"],
            "chunk": wildcards.chunk,
        }
    )


def blind_solver_settings(wildcards):
    """How a solver is run."""
    about = CONTEST["solvers"][wildcards.solver]
    return settings_text(
        {
            "name": wildcards.solver,
            "command": about["command"],
            "time_limit_s": about["time_limit_s"],
            "keep": CONTEST["keep"],
        }
    )


def blind_solver_code(wildcards):
    """Source of a solver of hystbench's own; of others only the command is known."""
    command = CONTEST["solvers"][wildcards.solver]["command"]
    modules = ["hystbench.commands.blind_solve"]
    if command[0] == "hystbench":
        called = f"hystbench.commands.{command[1].replace('-', '_')}"
        modules += [called] if called in GRAPH.modules else []
        if command[1] == "gap":
            # Effects are found by name, so that no import tells of them.
            modules += sorted(GRAPH.find_descendants("hystbench.gap"))
    return code(*modules)


def blind_data(path):
    """Thrown away when solved, unless the settings keep it."""
    return directory(path) if CONTEST["keep_data"] else temp(directory(path))


rule blind_make:
    input:
        code=code("hystbench.commands.blind_make"),
        kernels=PLANT_KERNELS,
    output:
        blind_data(f"{BLIND}/data/{{set}}/{{chunk}}"),
    log:
        f"{BLIND}/logs/make-{{set}}-{{chunk}}.log",
    wildcard_constraints:
        chunk=r"\d+",
    params:
        settings=blind_case_settings,
    message:
        "blind: cases {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench blind-make --settings {params.settings:q} --out {output:q} 2> {log:q}"


rule blind_solve:
    input:
        data=rules.blind_make.output,
        code=blind_solver_code,
    output:
        f"{BLIND}/answers/{{set}}/{{solver}}/{{chunk}}.json",
    log:
        f"{BLIND}/logs/solve-{{set}}-{{solver}}-{{chunk}}.log",
    wildcard_constraints:
        chunk=r"\d+",
    params:
        settings=blind_solver_settings,
    message:
        "blind: {wildcards.solver} on {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench blind-solve {input.data:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


rule blind_judge:
    input:
        answers=lambda wildcards: [
            f"{BLIND}/answers/{wildcards.set}/{solver}/{wildcards.chunk}.json"
            for solver in BLIND_SOLVERS[wildcards.set]
        ],
        code=code("hystbench.commands.blind_judge"),
        kernels=PLANT_KERNELS,
    output:
        f"{BLIND}/judged/{{set}}/{{chunk}}.csv",
    log:
        f"{BLIND}/logs/judge-{{set}}-{{chunk}}.log",
    wildcard_constraints:
        chunk=r"\d+",
    params:
        settings=blind_case_settings,
    message:
        "blind: judging {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench blind-judge {input.answers:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


rule blind_summary:
    input:
        judged=[
            f"{BLIND}/judged/{CONTEST['set']}/{chunk}.csv"
            for chunk in blind_chunks(CONTEST["set"])
        ],
        transfer=(
            [
                f"{BLIND}/judged/transfer/{chunk}.csv"
                for chunk in blind_chunks("transfer")
            ]
            if CONTEST["transfer"]
            else []
        ),
        code=code("hystbench.commands.blind_summary"),
    output:
        summary=f"{BLIND}/summary.json",
        tables=[
            f"{BLIND}/{name}.csv"
            for name in (
                "reach",
                "cases",
                "transfer-cases",
                "confusion",
                "confused",
                "effects",
                "power",
                "reliability",
                "rivals",
            )
        ],
    log:
        f"{BLIND}/logs/summary.log",
    params:
        settings=settings_text(
            {
                "set": CONTEST["set"],
                "scale": CONTEST["scale"],
                "solver": CONTEST["solver"],
                "skipped": SKIPPED,
            }
        ),
        transfer=lambda wildcards, input: options("--transfer", input.transfer),
        folder=subpath(output.summary, parent=True),
    message:
        "blind: the score"
    shell:
        "hystbench blind-summary {input.judged:q} {params.transfer}"
        " --settings {params.settings:q} --out {params.folder:q} 2> {log:q}"


BLIND_FIGURES = {
    "blind-confusion": "confusion",
    "blind-effects": "effects",
    "blind-power": "power",
    "blind-reliability": "reliability",
    "blind-where": "effects",
}

for NAME, TABLE in BLIND_FIGURES.items():

    rule:
        name:
            f"draw_{NAME.replace('-', '_')}"
        input:
            table=f"{BLIND}/{TABLE}.csv",
            code=code(
                "hystbench.commands.figure",
                f"hystbench.figures.{NAME.replace('-', '_')}",
            ),
            style=PACKAGE / "figures" / "hystbench.mplstyle",
        output:
            png=f"{BLIND}/figures/{NAME}.png",
            svg=f"{BLIND}/figures/{NAME}.svg",
        log:
            f"{BLIND}/logs/{NAME}.log",
        params:
            name=NAME,
        message:
            f"figure {NAME}"
        shell:
            "hystbench figure {params.name:q} --table {input.table:q}"
            " --out {output.png:q} --out {output.svg:q} 2> {log:q}"


# `all` leaves it out for its time.
rule blind:
    input:
        rules.blind_summary.output,
        [
            f"{BLIND}/figures/{name}.{suffix}"
            for name in BLIND_FIGURES
            for suffix in ("png", "svg")
        ],
    message:
        f"{BLIND} is up to date"

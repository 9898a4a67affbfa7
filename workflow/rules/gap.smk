# The gap: where a simulator and measurements disagree, and what the simulator lacks.
# `snakemake gap` runs the worked example (config: gap: twin) and the datasets listed
# there; `all` leaves it out for its time.
from hystbench.dataset import load_dataset
from hystbench.gap.bases.kinds import check_base
from hystbench.gap.vocabulary import Vocabulary

GAP = f"{RESULTS}/gap"
GAP_CASE = f"{GAP}/{{case}}"
STAGES = f"{GAP_CASE}/stages"
# The next experiment as a signal; an empty folder where none is needed.
GAP_EXPERIMENT = (
    f"{GAP_CASE}/next-experiment" if config["gap"].get("write_experiment") else ""
)
# Effects are found by name, so that no import tells of them.
EFFECTS = sorted(GRAPH.find_children("hystbench.gap.effects"))
# What each case is made of. Fit records are inputs of all jobs, hold-out records of
# `gap_check` and `gap_show` alone (and of the job that writes the twin's dataset).
GAP_CASES = {}

if TWIN:
    GAP_FOLDER = f"{GAP}/twin/dataset"
    GAP_CASES["twin"] = {
        "dataset": f"{GAP_FOLDER}/dataset.yaml",
        "fit": [f"{GAP_FOLDER}/{name}.csv" for name in config["gap"]["twin"]["fit"]],
        "hold_out": [
            f"{GAP_FOLDER}/{name}.csv" for name in config["gap"]["twin"]["hold_out"]
        ],
        "model": f"{GAP}/twin/base.yaml",
        "limits": config["gap"]["twin"].get("limits", {}),
    }

    rule gap_twin:
        input:
            fit=[record(signal) for signal in config["gap"]["twin"]["fit"]],
            hold_out=[record(signal) for signal in config["gap"]["twin"]["hold_out"]],
            identified=rules.identify.output,
            code=code("hystbench.commands.jobs.gap_twin"),
        output:
            dataset=GAP_CASES["twin"]["dataset"],
            records=[*GAP_CASES["twin"]["fit"], *GAP_CASES["twin"]["hold_out"]],
            base=GAP_CASES["twin"]["model"],
        log:
            f"{RESULTS}/logs/gap/twin/dataset.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/gap/twin/dataset.tsv"
        params:
            fit=lambda wildcards, input: options("--fit", input.fit),
            hold_out=lambda wildcards, input: options("--hold-out", input.hold_out),
            # A record that changes its role is still the same input.
            roles=[config["gap"]["twin"][role] for role in ("fit", "hold_out")],
            folder=subpath(output.base, parent=True),
        message:
            "the twin's records and the model of its slow loop"
        shell:
            "hystbench job gap-twin {params.fit} {params.hold_out}"
            " --identified {input.identified:q} --out {params.folder:q} 2> {log:q}"


for GIVEN in config["gap"]["datasets"]:
    try:
        GAP_DATASET = load_dataset(GIVEN["dataset"])
        if GAP_DATASET.name in GAP_CASES:
            raise InputError(f"a second dataset {GAP_DATASET.name!r}; expected one")
        check_base(GIVEN["model"])
        Vocabulary.of(GIVEN.get("without", ()), GIVEN.get("with", ()))
    except InputError as error:
        refuse(f"{PLACE}: gap: datasets: {error}")
    GAP_CASES[GAP_DATASET.name] = {
        "dataset": str(GAP_DATASET.path),
        "fit": [
            str(file)
            for name, file in GAP_DATASET.record_files.items()
            if GAP_DATASET.use(name) == "fit"
        ],
        "hold_out": [
            str(file)
            for name, file in GAP_DATASET.record_files.items()
            if GAP_DATASET.use(name) == "hold-out"
        ],
        "model": GIVEN["model"],
        "limits": GIVEN.get("limits", {}),
        "without": GIVEN.get("without", []),
        "with": GIVEN.get("with", []),
    }
    keep_out("gap: datasets", [GAP_DATASET.path, *GAP_DATASET.record_files.values()])
    keep_out("gap: datasets: model", model_files(GIVEN["model"]))


wildcard_constraints:
    case="|".join(map(re.escape, GAP_CASES)) or "none",


# Whether all files can be used, before a search is paid: it goes first, and where it
# fails nothing else is started. What decides does not wait for it, so that no hold-out
# file is upstream of that; and it tells nothing but that it passed.
rule gap_check:
    input:
        dataset=of_case("dataset"),
        fit=of_case("fit"),
        hold_out=of_case("hold_out"),
        model=model_of_case,
        code=code("hystbench.commands.jobs.gap_check"),
    output:
        f"{STAGES}/checked",
    log:
        f"{RESULTS}/logs/gap/{{case}}/check.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/gap/{{case}}/check.tsv"
    priority: 2
    params:
        model=of_case("model"),
    message:
        "files of {wildcards.case}"
    shell:
        "hystbench job gap-check {input.dataset:q} --model {params.model:q} --out {output:q}"
        " 2> {log:q}"


# What is named, from the fit records alone.
rule gap_decide:
    input:
        dataset=of_case("dataset"),
        fit=of_case("fit"),
        model=model_of_case,
        code=code("hystbench.commands.jobs.gap_decide", *EFFECTS),
    output:
        base=f"{STAGES}/base.yaml",
        curves=f"{GAP_CASE}/curves.json",
        named=f"{STAGES}/named.json",
        decision=f"{STAGES}/decision.json",
        took=f"{STAGES}/decide-took.csv",
        experiment=[directory(GAP_EXPERIMENT)] if GAP_EXPERIMENT else [],
    log:
        f"{RESULTS}/logs/gap/{{case}}/decide.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/gap/{{case}}/decide.tsv"
    # Cases take less time beside each other than each on all cores.
    threads: max(1, (workflow.cores or 1) // max(1, len(GAP_CASES)))
    params:
        model=of_case("model"),
        limits=limits_of_case,
        effects=effects_of_case,
        unnamed_share=config["gap"]["unnamed_share"],
        experiment=lambda wildcards, output: (
            options("--write-experiment", [Path(output.experiment[0], "signal.csv")])
            if GAP_EXPERIMENT
            else ""
        ),
        folder=subpath(output.curves, parent=True),
    message:
        "verdict on {wildcards.case}"
    shell:
        "hystbench job gap-decide {input.dataset:q} --model {params.model:q}"
        " {params.limits} {params.effects} --unnamed-share {params.unnamed_share}"
        " {params.experiment} --cores {threads}"
        " --out {params.folder:q} --took {output.took:q} 2> {log:q}"


# The one job that shows hold-out records: all is chosen. It may take names back, so
# that it writes the model.
rule gap_show:
    input:
        checked=rules.gap_check.output,
        dataset=of_case("dataset"),
        fit=of_case("fit"),
        hold_out=of_case("hold_out"),
        base=rules.gap_decide.output.base,
        named=rules.gap_decide.output.named,
        decision=rules.gap_decide.output.decision,
        code=code("hystbench.commands.jobs.gap_show", *EFFECTS),
    output:
        gap=f"{GAP_CASE}/gap.json",
        model=f"{GAP_CASE}/model.yaml",
        hold_out=directory(f"{GAP_CASE}/holdout"),
        took=f"{STAGES}/show-took.csv",
    log:
        f"{RESULTS}/logs/gap/{{case}}/show.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/gap/{{case}}/show.tsv"
    params:
        folder=subpath(output.gap, parent=True),
    message:
        "hold-out records of {wildcards.case}"
    shell:
        "hystbench job gap-show {input.dataset:q} --base {input.base:q}"
        " --out {params.folder:q} --took {output.took:q} 2> {log:q}"


PICTURES = ("model", "residual", "where")


# The page; and what a page of several devices shows of each.
rule gap_report:
    input:
        gap=rules.gap_show.output.gap,
        model=rules.gap_show.output.model,
        hold_out=rules.gap_show.output.hold_out,
        curves=rules.gap_decide.output.curves,
        code=code("hystbench.commands.jobs.gap_report"),
        page=PACKAGE / "gap/report/report.html.j2",
        style=PACKAGE / "figures" / "hystbench.mplstyle",
    output:
        page=f"{GAP_CASE}/report.html",
        verdict=f"{GAP_CASE}/verdict.md",
        host=f"{GAP_CASE}/host.csv",
        pictures=multiext(
            f"{GAP_CASE}/",
            *(f"{name}.{kind}" for name in PICTURES for kind in ("svg", "png")),
        ),
    log:
        f"{RESULTS}/logs/gap/{{case}}/report.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/gap/{{case}}/report.tsv"
    params:
        folder=subpath(input.gap, parent=True),
    message:
        "page of {wildcards.case}"
    shell:
        "hystbench job gap-report {params.folder:q} 2> {log:q}"


if TWIN:
    # The last sine that is held out, before and after.
    SHOWN = [
        *config["gap"]["twin"]["hold_out"][:1],
        *(name for name in config["gap"]["twin"]["hold_out"] if "sine-" in name[:5]),
    ][-1]

    rule draw_gap_loop:
        input:
            record=record(SHOWN),
            gap=f"{GAP}/twin/gap.json",
            hold_out=f"{GAP}/twin/holdout",
            code=code("hystbench.commands.jobs.figure", module_of("gap-loop")),
            style=PACKAGE / "figures" / "hystbench.mplstyle",
        output:
            png=f"{GAP}/gap-loop.png",
            svg=f"{GAP}/gap-loop.svg",
        log:
            f"{RESULTS}/logs/gap/gap-loop.log",
        params:
            table=f"{GAP}/twin/holdout/{SHOWN}.csv",
        message:
            f"{SHOWN} before and after"
        shell:
            "hystbench job figure gap-loop --record {input.record:q}"
            " --table {params.table:q} --out {output.png:q} --out {output.svg:q}"
            " 2> {log:q}"


# Verdicts side by side, and what the twin's model file adds to its hysteresis: no
# other job reads that file.
rule gap_summary:
    input:
        gaps=expand(rules.gap_show.output.gap, case=GAP_CASES),
        took=expand(
            [rules.gap_decide.output.took, rules.gap_show.output.took], case=GAP_CASES
        ),
        twin=SETTINGS.model_file if TWIN else [],
        code=code("hystbench.commands.jobs.gap_summary"),
    output:
        summary=f"{GAP}/summary.csv",
        effects=f"{GAP}/effects.csv",
        records=f"{GAP}/records.csv",
        sentences=f"{GAP}/sentences.csv",
        seconds=f"{GAP}/seconds.csv",
        adds=[f"{GAP}/twin-adds.csv"] if TWIN else [],
    log:
        f"{RESULTS}/logs/gap/summary.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/gap/summary.tsv"
    params:
        took=lambda wildcards, input: options("--took", input.took),
        twin=lambda wildcards, input, output: (
            f"--twin {shlex.quote(input.twin)} --adds {shlex.quote(output.adds[0])}"
            if TWIN
            else ""
        ),
    message:
        "verdicts side by side"
    shell:
        "hystbench job gap-summary {input.gaps:q} {params.twin}"
        " --effects {output.effects:q} --records {output.records:q}"
        " --sentences {output.sentences:q} {params.took} --seconds {output.seconds:q}"
        " --out {output.summary:q} 2> {log:q}"


rule gap:
    input:
        rules.gap_summary.output,
        expand(rules.gap_report.output, case=GAP_CASES),
        rules.draw_gap_loop.output if TWIN else [],
    message:
        f"{GAP} is up to date"

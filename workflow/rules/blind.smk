# The jobs of the blind contest; its plan is in blind_plan.smk.
rule blind_make:
    input:
        code=code("hystbench.commands.jobs.blind_make"),
        kernels=PLANT_KERNELS,
    output:
        blind_data(f"{BLIND}/data/{{set}}/{{chunk}}"),
    log:
        f"{BLIND}/logs/make-{{set}}-{{chunk}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/blind/make-{{set}}-{{chunk}}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    params:
        settings=blind_case_settings,
    message:
        "blind: cases {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench job blind-make --settings {params.settings:q} --out {output:q} 2> {log:q}"


rule blind_solve:
    input:
        data=rules.blind_make.output,
        code=blind_solver_code,
    output:
        f"{BLIND}/answers/{{set}}/{{solver}}/{{chunk}}.json",
    log:
        f"{BLIND}/logs/solve-{{set}}-{{solver}}-{{chunk}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/blind/solve-{{set}}-{{solver}}-{{chunk}}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    # Minutes, if every case takes its whole time; ten for the rest.
    resources:
        runtime=blind_solver_minutes,
    params:
        settings=blind_solver_settings,
    message:
        "blind: {wildcards.solver} on {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench job blind-solve {input.data:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


rule blind_judge:
    input:
        answers=lambda wildcards: [
            f"{BLIND}/answers/{wildcards.set}/{solver}/{wildcards.chunk}.json"
            for solver in blind_entrants(wildcards)
        ],
        code=code("hystbench.commands.jobs.blind_judge"),
        kernels=PLANT_KERNELS,
    output:
        f"{BLIND}/judged/{{set}}/{{chunk}}.csv",
    log:
        f"{BLIND}/logs/judge-{{set}}-{{chunk}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/blind/judge-{{set}}-{{chunk}}.tsv"
    wildcard_constraints:
        chunk=r"\d+",
    params:
        settings=blind_case_settings,
    message:
        "blind: judging {wildcards.set} {wildcards.chunk}"
    shell:
        "hystbench job blind-judge {input.answers:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


rule blind_summary:
    input:
        judged=[
            f"{BLIND}/judged/{CONTEST['set']}/{chunk}.csv"
            for chunk in blind_chunks(CONTEST["set"])
        ],
        transfer=(
            [
                f"{BLIND}/judged/{TRANSFER}/{chunk}.csv"
                for chunk in blind_chunks(TRANSFER)
            ]
            if CONTEST["transfer_scale"]
            else []
        ),
        code=code("hystbench.commands.jobs.blind_summary"),
    output:
        summary=f"{BLIND}/summary.json",
        tables=[
            f"{BLIND}/{name}.csv"
            for name in (
                "in-words",
                "contest",
                "kept",
                "reach",
                "further",
                "transfer",
                "cases",
                "transfer-cases",
                "confusion",
                "never-seen",
                "confused",
                "effects",
                "retuned",
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
                "plan": blind_cases(CONTEST["set"]),
                "transfer_set": TRANSFER,
                "transfer_scale": CONTEST["transfer_scale"],
                "solver": CONTEST["solver"],
            }
        ),
        transfer=lambda wildcards, input: options("--transfer", input.transfer),
        folder=subpath(output.summary, parent=True),
    message:
        "blind: the score"
    shell:
        "hystbench job blind-summary {input.judged:q} {params.transfer}"
        " --settings {params.settings:q} --out {params.folder:q} 2> {log:q}"


rule blind_left_out:
    input:
        judged=[
            f"{BLIND}/judged/{name}/{chunk}.csv"
            for name in LEFT_OUT
            for chunk in blind_chunks(name)
        ],
        code=code("hystbench.commands.jobs.blind_left_out"),
    output:
        f"{BLIND}/left-out.csv",
    log:
        f"{BLIND}/logs/left-out.log",
    message:
        "blind: what could not be named"
    shell:
        "hystbench job blind-left-out {input.judged:q} --out {output:q} 2> {log:q}"


BLIND_FIGURES = {
    "blind-confusion": "confusion",
    "blind-effects": "effects",
    "blind-power": "power",
    "blind-reliability": "reliability",
    # Of machines no view is judged.
    **({} if OF_MACHINES else {"blind-where": "effects"}),
}

for NAME, TABLE in BLIND_FIGURES.items():

    rule:
        name:
            f"draw_{NAME.replace('-', '_')}"
        input:
            table=f"{BLIND}/{TABLE}.csv",
            code=code(
                "hystbench.commands.jobs.figure",
                module_of(NAME),
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
            "hystbench job figure {params.name:q} --table {input.table:q}"
            " --out {output.png:q} --out {output.svg:q} 2> {log:q}"


# `all` leaves it out for its time.
rule blind:
    input:
        rules.blind_summary.output,
        rules.blind_left_out.output if LEFT_OUT else [],
        [
            f"{BLIND}/figures/{name}.{suffix}"
            for name in BLIND_FIGURES
            for suffix in ("png", "svg")
        ],
    message:
        f"{BLIND} is up to date"

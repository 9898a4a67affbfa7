# How far exported code is from the simulation, by `snakemake export_errors`: it needs no
# record, and `all` leaves it out as no other page wants it.


rule export_errors:
    input:
        code=code("hystbench.commands.jobs.export_errors"),
        # Copied into what is exported, and not imported.
        steps=PACKAGE / "export/steps.py",
    output:
        "results/export/errors.csv",
    log:
        "results/logs/export/errors.log",
    message:
        "exported code beside the simulation"
    shell:
        "hystbench job export-errors --out {output:q} 2> {log:q}"


# The models that `snakemake gap` wrote, by `snakemake export_gap`.
rule export_gap:
    input:
        models=expand(rules.gap_show.output.model, case=GAP_CASES),
        datasets=[case["dataset"] for case in GAP_CASES.values()],
        hold_out=[file for case in GAP_CASES.values() for file in case["hold_out"]],
        code=code("hystbench.commands.jobs.export_gap"),
        # Copied into what is exported, and not imported.
        steps=[PACKAGE / f"export/{name}.py" for name in ("steps", "inside")],
    output:
        f"{RESULTS}/export/gap.csv",
    log:
        f"{RESULTS}/logs/export/gap.log",
    params:
        cases=lambda wildcards, input: " ".join(
            f"--case {shlex.quote(str(dataset))} {shlex.quote(str(model))}"
            for dataset, model in zip(input.datasets, input.models)
        ),
    message:
        "models of the gap as code, beside their simulation"
    shell:
        "hystbench job export-gap {params.cases} --out {output:q} 2> {log:q}"

rule rdgpi_identify:
    input:
        records=[record(signal) for signal in SETTINGS.rdgpi_fit_signals],
        code=code("hystbench.commands.jobs.rdgpi_identify"),
    output:
        f"{RESULTS}/rdgpi/identified.json",
    log:
        f"{RESULTS}/logs/rdgpi/identify.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/rdgpi_identify.tsv"
    params:
        settings=settings_text(SETTINGS.rdgpi_job),
    message:
        "identification of the RDGPI model"
    shell:
        "hystbench job rdgpi-identify {input.records:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


rule rdgpi:
    input:
        record=record("{signal}"),
        identified=rules.rdgpi_identify.output,
        code=code("hystbench.commands.jobs.rdgpi"),
    output:
        run=run("{signal}", "rdgpi"),
        arrays=run("{signal}", "rdgpi", "npz"),
    log:
        f"{RESULTS}/logs/rdgpi/{{signal}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/rdgpi/{{signal}}.tsv"
    params:
        settings=settings_text(SETTINGS.error_job),
    message:
        "rdgpi on {wildcards.signal}"
    shell:
        "hystbench job rdgpi {input.record:q} --identified {input.identified:q}"
        " --settings {params.settings:q}"
        " --out {output.run:q} --arrays {output.arrays:q} 2> {log:q}"


# The eleven published values under our reading of the model, whatever comes out.
rule rdgpi_published:
    input:
        records=[record(signal) for signal in SETTINGS.signals],
        code=code("hystbench.commands.jobs.rdgpi_published"),
    output:
        report(
            f"{RESULTS}/rdgpi/published-parameters.csv",
            caption="../report/rdgpi-published.rst",
            category="Comparison",
        ),
    log:
        f"{RESULTS}/logs/rdgpi/published.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/rdgpi_published.tsv"
    message:
        "RDGPI model with the published parameters"
    shell:
        "hystbench job rdgpi-published {input.records:q} --out {output:q} 2> {log:q}"

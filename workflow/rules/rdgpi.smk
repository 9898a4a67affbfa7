rule rdgpi_identify:
    input:
        records=[record(signal) for signal in SETTINGS.rdgpi_fit_signals],
        code=code("hystbench.commands.rdgpi_identify"),
    output:
        f"{RESULTS}/rdgpi/identified.json",
    log:
        f"{RESULTS}/logs/rdgpi/identify.log",
    params:
        settings=settings_text(SETTINGS.rdgpi_job),
    message:
        "identification of the RDGPI model"
    shell:
        "hystbench rdgpi-identify {input.records} --settings {params.settings:q}"
        " --out {output} 2> {log}"


rule rdgpi:
    input:
        record=record("{signal}"),
        identified=rules.rdgpi_identify.output,
        code=code("hystbench.commands.rdgpi"),
    output:
        run=run("{signal}", "rdgpi"),
        arrays=run("{signal}", "rdgpi", "npz"),
    log:
        f"{RESULTS}/logs/rdgpi/{{signal}}.log",
    params:
        settings=settings_text(SETTINGS.error_job),
    message:
        "rdgpi on {wildcards.signal}"
    shell:
        "hystbench rdgpi {input.record} --identified {input.identified}"
        " --settings {params.settings:q}"
        " --out {output.run} --arrays {output.arrays} 2> {log}"


# The eleven published values under our reading of the model, whatever comes out.
rule rdgpi_published:
    input:
        records=[record(signal) for signal in SETTINGS.signals],
        code=code("hystbench.commands.rdgpi_published"),
    output:
        f"{RESULTS}/rdgpi/published-parameters.csv",
    log:
        f"{RESULTS}/logs/rdgpi/published.log",
    message:
        "RDGPI model with the published parameters"
    shell:
        "hystbench rdgpi-published {input.records} --out {output} 2> {log}"

rule identify:
    input:
        record=record(SETTINGS.identification_signal),
        code=code("hystbench.commands.jobs.identify"),
    output:
        f"{RESULTS}/identify/identified.json",
    log:
        f"{RESULTS}/logs/identify/identify.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/identify.tsv"
    params:
        settings=settings_text(SETTINGS.identification_job),
    message:
        "identification by Algorithm 1"
    shell:
        "hystbench job identify {input.record:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"


# The GPO filter with the identified and with the published envelope functions.
rule envelopes:
    input:
        records=[record(signal) for signal in SETTINGS.signals],
        identified=rules.identify.output,
        code=code("hystbench.commands.jobs.envelopes", "hystbench.filters.gpo"),
    output:
        report(
            f"{RESULTS}/identify/envelopes.csv",
            caption="../report/envelopes.rst",
            category="Comparison",
        ),
    log:
        f"{RESULTS}/logs/identify/envelopes.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/envelopes.tsv"
    params:
        settings=settings_text(SETTINGS.filter_job("gpo")),
    message:
        "GPO filter with identified and published envelopes"
    shell:
        "hystbench job envelopes {input.records:q} --identified {input.identified:q}"
        " --settings {params.settings:q} --out {output:q} 2> {log:q}"

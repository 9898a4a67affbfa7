# One job a signal and filter, so that any cell of the tables can be made again alone.
rule filter:
    input:
        record=record("{signal}"),
        identified=identified,
        code=lambda wildcards: code_with(
            [filter_class(wildcards.filter)], "hystbench.commands.jobs.filter"
        ),
    output:
        run=run("{signal}", "{filter}"),
        arrays=run("{signal}", "{filter}", "npz"),
    log:
        f"{RESULTS}/logs/filter/{{signal}}-{{filter}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/filter/{{signal}}-{{filter}}.tsv"
    params:
        settings=lambda wildcards: settings_text(SETTINGS.filter_job(wildcards.filter)),
        identified=lambda wildcards, input: (
            f"--identified {input.identified}" if input.identified else ""
        ),
    message:
        "{wildcards.filter} on {wildcards.signal}"
    shell:
        "hystbench job filter {input.record:q} --model {wildcards.filter:q}"
        " {params.identified} --settings {params.settings:q}"
        " --out {output.run:q} --arrays {output.arrays:q} 2> {log:q}"


# Figure 7: the error against the order, all filters in one job.
rule order_sweep:
    input:
        record=record(SETTINGS.order_sweep_signal),
        identified=rules.identify.output,
        code=code_with(
            map(filter_class, SETTINGS.filters), "hystbench.commands.jobs.order_sweep"
        ),
    output:
        configured=f"{RESULTS}/order-sweep/errors.csv",
        other=f"{RESULTS}/order-sweep/other-rule.csv",
    log:
        f"{RESULTS}/logs/order-sweep.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/order_sweep.tsv"
    params:
        settings=settings_text(SETTINGS.order_sweep_job),
    message:
        "error against order"
    shell:
        "hystbench job order-sweep {input.record:q} --identified {input.identified:q}"
        " --settings {params.settings:q} --threads {threads}"
        " --out {output.configured:q} --other {output.other:q} 2> {log:q}"

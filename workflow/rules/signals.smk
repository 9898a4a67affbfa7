rule signal:
    input:
        code=code("hystbench.commands.jobs.signal"),
    output:
        f"{RESULTS}/signals/{{signal}}.npz",
    log:
        f"{RESULTS}/logs/signal/{{signal}}.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/signal/{{signal}}.tsv"
    params:
        settings=lambda wildcards: settings_text(SETTINGS.signal_job(wildcards.signal)),
    message:
        "signal {wildcards.signal}"
    shell:
        "hystbench job signal {wildcards.signal:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"

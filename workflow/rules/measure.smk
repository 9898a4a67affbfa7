# The twin and a measured dataset give the same records.
if TWIN:

    rule measure:
        input:
            signal=rules.signal.output,
            model=SETTINGS.model_file,
            code=code("hystbench.commands.jobs.measure"),
        output:
            f"{RESULTS}/records/{{signal}}.npz",
        log:
            f"{RESULTS}/logs/measure/{{signal}}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/measure/{{signal}}.tsv"
        params:
            settings=settings_text(SETTINGS.measure_job),
        message:
            "record {wildcards.signal}"
        shell:
            "hystbench job measure {input.signal:q} --model {input.model:q}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

else:

    rule measure:
        input:
            dataset=str(SETTINGS.dataset.path),
            file=lambda wildcards: str(SETTINGS.dataset.record_files[wildcards.signal]),
            code=code("hystbench.commands.load"),
        output:
            f"{RESULTS}/records/{{signal}}.npz",
        log:
            f"{RESULTS}/logs/measure/{{signal}}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/measure/{{signal}}.tsv"
        message:
            "record {wildcards.signal}"
        shell:
            "hystbench load {input.dataset:q} {wildcards.signal:q} --out {output:q} 2> {log:q}"

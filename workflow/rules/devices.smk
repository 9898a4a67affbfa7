# The paper's models on the measured datasets of the gap: `snakemake devices`.
DEVICES = f"{RESULTS}/devices"
DEVICE_CASES = {name: case for name, case in GAP_CASES.items() if name != "twin"}

if DEVICE_CASES:

    rule device_errors:
        input:
            datasets=[case["dataset"] for case in DEVICE_CASES.values()],
            records=[
                file
                for case in DEVICE_CASES.values()
                for file in (*case["fit"], *case["hold_out"])
            ],
            gaps=rules.gap_summary.output.summary,
            published=PACKAGE / "published/baselines.csv",
            code=code_with(PAPER_FILTERS, "hystbench.commands.jobs.devices"),
        output:
            expand(
                f"{DEVICES}/{{name}}",
                name=[
                    "errors.csv",
                    "tracking.csv",
                    "simulation.csv",
                    "beside.csv",
                    "verdict.md",
                ],
            ),
        log:
            f"{RESULTS}/logs/devices.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/devices.tsv"
        params:
            settings=settings_text(SETTINGS.devices_job),
            folder=DEVICES,
        message:
            "the paper's models on measured devices"
        shell:
            "hystbench job devices {input.datasets:q} --gaps {input.gaps:q}"
            " --settings {params.settings:q} --out {params.folder:q} 2> {log:q}"


rule devices:
    input:
        rules.device_errors.output if DEVICE_CASES else [],
    message:
        (
            f"{DEVICES} is up to date"
            if DEVICE_CASES
            else "no measured datasets: list them in config.yaml under gap: datasets"
        )

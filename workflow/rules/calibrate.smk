# The twin itself. `snakemake calibrate` fits it to the published tables and puts it into
# the package; it is committed there, so no other target makes it. The step sizes, the
# zero error and the input noise that belong to it are printed, for config.yaml.
if TWIN:
    CALIBRATION = f"{RESULTS}/calibration"
    # Found by name, so that no import tells of them.
    CALIBRATED_FILTERS = sorted(GRAPH.find_children("hystbench.filters"))

    # What the calibration found, for docs/.
    rule found:
        input:
            twin=PACKAGE / "plants/gma.yaml",
            others=sorted(PACKAGE.glob("plants/uncertainty/gma-*.yaml")),
            code=code("hystbench.commands.jobs.found"),
        output:
            f"{COMPARE}/found.csv",
        log:
            f"{RESULTS}/logs/found.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/found.tsv"
        message:
            "what the calibration found"
        shell:
            "hystbench job found {input.twin:q} {input.others:q} --out {output:q}"
            " 2> {log:q}"

    rule calibration:
        input:
            published=PUBLISHED,
            code=code("hystbench.commands.jobs.calibrate", *CALIBRATED_FILTERS),
        output:
            model=f"{CALIBRATION}/gma.yaml",
            uncertainty=[
                f"{CALIBRATION}/uncertainty/gma-{number:02d}.yaml"
                for number in range(1, config["calibration"]["twins"] + 1)
            ],
            report=f"{CALIBRATION}/report.json",
        log:
            f"{RESULTS}/logs/calibration/fit.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/calibration.tsv"
        params:
            settings=settings_text(SETTINGS.calibration_job),
            folder=subpath(output.report, parent=True),
        message:
            "calibration of the twin"
        shell:
            # Shown while it runs: it takes a minute or more.
            "hystbench job calibrate --settings {params.settings:q}"
            " --out {params.folder:q} 2>&1 | tee {log:q}"

    rule calibrate:
        input:
            model=rules.calibration.output.model,
            uncertainty=rules.calibration.output.uncertainty,
        log:
            f"{RESULTS}/logs/calibration/copy.log",
        params:
            folder=PACKAGE / "plants",
        message:
            "{params.folder} holds the twin and its like"
        shell:
            f"{{{{ {COMMITTED}"
            "cp {input.model:q} {params.folder:q}"
            " && rm -f {params.folder:q}/uncertainty/gma-*.yaml"
            " && cp {input.uncertainty:q} {params.folder:q}/uncertainty; }} 2> {log:q}"

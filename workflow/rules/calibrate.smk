# The twin itself. `snakemake calibrate` fits it to the published tables and puts it into
# the package; it is committed there, so no other target makes it. The step sizes, the
# zero error and the input noise that belong to it are printed, for config.yaml.
if TWIN:
    CALIBRATION = f"{RESULTS}/calibration"
    # Found by name, so that no import tells of them.
    CALIBRATED_FILTERS = sorted(GRAPH.find_children("hystbench.filters"))

    # What the calibration tried and found, for docs/.
    rule tried:
        input:
            first_round=PACKAGE / "calibration/first_round.yaml",
            twin=PACKAGE / "plants/gma.yaml",
            others=sorted(PACKAGE.glob("plants/uncertainty/gma-*.yaml")),
            code=code("hystbench.commands.jobs.tried"),
        output:
            tried=f"{COMPARE}/tried.csv",
            found=f"{COMPARE}/found.csv",
        log:
            f"{RESULTS}/logs/tried.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/tried.tsv"
        message:
            "what the calibration tried and found"
        shell:
            "hystbench job tried {input.twin:q} {input.others:q} --tried {output.tried:q}"
            " --found {output.found:q} 2> {log:q}"

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

    # Structures and readings beside one another; `all` leaves them out for their time.
    rule structure:
        input:
            published=PUBLISHED,
            code=code("hystbench.commands.jobs.structure", *CALIBRATED_FILTERS),
        output:
            f"{RESULTS}/structures/{{structure}}.json",
        log:
            f"{RESULTS}/logs/structures/{{structure}}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/structure/{{structure}}.tsv"
        params:
            settings=settings_text(SETTINGS.structure_job),
        message:
            "structure {wildcards.structure}"
        shell:
            "hystbench job structure {wildcards.structure}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

    rule structures:
        input:
            tried=structures_tried,
            code=code("hystbench.commands.jobs.structures"),
        output:
            tried=f"{RESULTS}/structures/tried.csv",
            choice=f"{RESULTS}/structures/choice.yaml",
        log:
            f"{RESULTS}/logs/structures/tried.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/structures.tsv"
        message:
            "structures that were tried"
        shell:
            "hystbench job structures {input.tried:q} --out {output.tried:q}"
            " --choice {output.choice:q} 2> {log:q}"

    # After the choice: all structures on the held-out signals, by one rule.
    rule held_out:
        input:
            tried=structures_tried,
            choice=PACKAGE / "plants/choice.yaml",
            published=PUBLISHED,
            code=code("hystbench.commands.jobs.held_out", *CALIBRATED_FILTERS),
        output:
            f"{RESULTS}/structures/held-out.csv",
        log:
            f"{RESULTS}/logs/structures/held-out.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/held_out.tsv"
        params:
            settings=settings_text(SETTINGS.held_out_job),
        message:
            "structures on the held-out signals"
        shell:
            "hystbench job held-out {input.tried:q} --choice {input.choice:q}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

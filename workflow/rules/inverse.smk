# Open-loop tracking on the twin with and without the inverse, by `snakemake inverse`: it
# takes the model that `snakemake gap` finds, so that `all` leaves it out.
INVERSE = f"{RESULTS}/inverse"

if TWIN:

    # One job: the references take a second or two each.
    rule tracking:
        input:
            signals=[f"{RESULTS}/signals/{signal}.npz" for signal in SETTINGS.signals],
            slow=f"{RESULTS}/signals/{SETTINGS.identification_signal}.npz",
            plant=SETTINGS.model_file,
            base=rules.gap_twin.output.base,
            augmented=f"{GAP}/twin/model.yaml",
            rate_dependent=rules.rdgpi_identify.output,
            code=code("hystbench.commands.jobs.tracking"),
        output:
            table=f"{INVERSE}/tracking.csv",
            raster=f"{INVERSE}/raster.csv",
            page=f"{INVERSE}/tracking.md",
            verdict=f"{INVERSE}/verdict.md",
        log:
            f"{RESULTS}/logs/inverse/tracking.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/tracking.tsv"
        params:
            settings=settings_text(SETTINGS.tracking_job),
            folder=subpath(output.table, parent=True),
        message:
            "open-loop tracking with and without the inverse"
        shell:
            "hystbench job tracking {input.signals:q} --slow {input.slow:q}"
            " --plant {input.plant:q} --base {input.base:q}"
            " --augmented {input.augmented:q} --rate-dependent {input.rate_dependent:q}"
            " --settings {params.settings:q}"
            " --out {params.folder:q} 2> {log:q}"

    rule draw_tracking_errors:
        input:
            table=rules.tracking.output.table,
            raster=rules.tracking.output.raster,
            code=code("hystbench.commands.jobs.figure", module_of("tracking-errors")),
            style=PACKAGE / "figures" / "hystbench.mplstyle",
        output:
            png=f"{INVERSE}/tracking-errors.png",
            svg=f"{INVERSE}/tracking-errors.svg",
        log:
            f"{RESULTS}/logs/inverse/figure.log",
        message:
            "figure tracking-errors"
        shell:
            "hystbench job figure tracking-errors --table {input.table:q}"
            " --out {output.png:q} --out {output.svg:q} 2> {log:q}"


rule inverse:
    input:
        [*rules.tracking.output, *rules.draw_tracking_errors.output] if TWIN else [],
    message:
        f"{INVERSE} is up to date"

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
            code=code("hystbench.commands.tracking"),
        output:
            table=f"{INVERSE}/tracking.csv",
            page=f"{INVERSE}/tracking.md",
            verdict=f"{INVERSE}/verdict.md",
            png=f"{INVERSE}/tracking.png",
            svg=f"{INVERSE}/tracking.svg",
        log:
            f"{RESULTS}/logs/inverse.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/inverse.tsv"
        params:
            settings=settings_text(SETTINGS.tracking_job),
            folder=subpath(output.table, parent=True),
        message:
            "open-loop tracking with and without the inverse"
        shell:
            "hystbench tracking {input.signals:q} --slow {input.slow:q}"
            " --plant {input.plant:q} --base {input.base:q}"
            " --augmented {input.augmented:q} --settings {params.settings:q}"
            " --out {params.folder:q} 2> {log:q}"


rule inverse:
    input:
        rules.tracking.output if TWIN else [],
    message:
        f"{INVERSE} is up to date"

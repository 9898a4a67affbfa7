# The claims on other twins, with other step sizes and seeds, and the fair contest.
# One job runs all models on all twins in memory: a file for each run would cost more
# than the runs.
PRESSURE = f"{RESULTS}/pressure"
# The filters are found by name, so that no import tells of them.
FILTER_MODULES = [f"hystbench.filters.{name}" for name in SETTINGS.filters]

if TWIN:

    # As configured, for the spread of each cell and for where each claim holds. A
    # changed step size runs its filter again on the twins, and no other. What takes
    # longest goes first, so that no core waits for it at the end.
    rule twin_fits:
        input:
            twins=SETTINGS.twin_files,
            code=code("hystbench.commands.twin_fits"),
        output:
            f"{RESULTS}/twins/fits.json",
        log:
            f"{RESULTS}/logs/twins/fits.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/twin_fits.tsv"
        priority: 1
        params:
            settings=settings_text(SETTINGS.twin_fits_job),
        message:
            "identification and RDGPI model on each twin"
        shell:
            "hystbench twin-fits {input.twins:q} --settings {params.settings:q}"
            " --out {output:q} 2> {log:q}"

    rule twin_runs:
        input:
            twins=SETTINGS.twin_files,
            fits=rules.twin_fits.output,
            code=lambda wildcards: code(
                "hystbench.commands.twin_runs", f"hystbench.filters.{wildcards.filter}"
            ),
        output:
            f"{RESULTS}/twins/{{filter}}.json",
        log:
            f"{RESULTS}/logs/twins/{{filter}}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/twin_runs/{{filter}}.tsv"
        priority: 1
        params:
            settings=lambda wildcards: settings_text(
                SETTINGS.twin_runs_job(wildcards.filter)
            ),
        message:
            "{wildcards.filter} on each twin"
        shell:
            "hystbench twin-runs {input.twins:q} --fits {input.fits:q}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

    rule twins:
        input:
            twins=SETTINGS.twin_files,
            fits=rules.twin_fits.output,
            runs=[f"{RESULTS}/twins/{name}.json" for name in SETTINGS.filters],
            code=code("hystbench.commands.twins"),
        output:
            errors=f"{RESULTS}/twins/errors.csv",
            claims=f"{RESULTS}/twins/claims.csv",
        log:
            f"{RESULTS}/logs/twins/claims.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/twins.tsv"
        priority: 1
        params:
            settings=settings_text(SETTINGS.twins_job),
            runs=lambda wildcards, input: options("--runs", input.runs),
        message:
            "all models on each twin"
        shell:
            "hystbench twins {input.twins:q} --fits {input.fits:q} {params.runs}"
            " --settings {params.settings:q}"
            " --errors {output.errors:q} --claims {output.claims:q} 2> {log:q}"

    rule press:
        input:
            twins=SETTINGS.twin_files,
            code=code("hystbench.commands.pressure", *FILTER_MODULES),
        output:
            claims=f"{PRESSURE}/claims.csv",
            by_twin=f"{PRESSURE}/by-twin.csv",
            summary=f"{PRESSURE}/summary.json",
            markdown=f"{PRESSURE}/claims.md",
        log:
            f"{RESULTS}/logs/pressure/claims.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/press.tsv"
        params:
            settings=settings_text(SETTINGS.pressure_job),
            folder=lambda wildcards, output: Path(output.claims).parent,
        message:
            "claims on many twins, step sizes and seeds"
        shell:
            "hystbench pressure {input.twins:q} --settings {params.settings:q}"
            " --out {params.folder:q} 2> {log:q}"

    rule contest:
        input:
            twins=SETTINGS.contest_files,
            published=PUBLISHED,
            code=code("hystbench.commands.contest", *FILTER_MODULES),
        output:
            table=f"{PRESSURE}/contest.csv",
            ranking=f"{PRESSURE}/ranking.csv",
            markdown=f"{PRESSURE}/contest.md",
        log:
            f"{RESULTS}/logs/pressure/contest.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/contest.tsv"
        params:
            settings=settings_text(SETTINGS.contest_job),
            folder=lambda wildcards, output: Path(output.table).parent,
        message:
            "each filter with its best step size"
        shell:
            "hystbench contest {input.twins:q} --settings {params.settings:q}"
            " --out {params.folder:q} 2> {log:q}"

    rule draw_contest:
        input:
            table=rules.contest.output.table,
            code=code("hystbench.commands.figure", "hystbench.figures.contest"),
            style=PACKAGE / "figures" / "hystbench.mplstyle",
        output:
            png=report(
                figure("contest", "png"),
                caption="../report/contest.rst",
                category="Figures",
            ),
            svg=figure("contest", "svg"),
        log:
            f"{RESULTS}/logs/figures/contest.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/draw_contest.tsv"
        message:
            "figure contest"
        shell:
            "hystbench figure contest --table {input.table:q}"
            " --out {output.png:q} --out {output.svg:q} 2> {log:q}"

    # `snakemake pressure`; `all` leaves it out for its time.
    rule pressure:
        input:
            rules.press.output,
            rules.contest.output,
            rules.draw_contest.output,
        message:
            f"{PRESSURE} is up to date"

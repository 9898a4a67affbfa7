# The claims on other twins, with other step sizes and seeds, and the fair contest.
# One job runs all models on all twins in memory: a file for each run would cost more
# than the runs.
PRESSURE = f"{RESULTS}/pressure"
# The filters are found by name, so that no import tells of them.
FILTER_MODULES = [f"hystbench.filters.{name}" for name in SETTINGS.filters]

if TWIN:

    # As configured, for the spread of each cell and for where each claim holds.
    rule twins:
        input:
            twins=SETTINGS.twin_files,
            code=code("hystbench.commands.twins", *FILTER_MODULES),
        output:
            errors=f"{RESULTS}/twins/errors.csv",
            claims=f"{RESULTS}/twins/claims.csv",
        log:
            f"{RESULTS}/logs/twins.log",
        params:
            settings=settings_text(SETTINGS.ensemble_job),
        message:
            "all models on each twin"
        shell:
            "hystbench twins {input.twins:q} --settings {params.settings:q}"
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

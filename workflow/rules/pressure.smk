# The claims on other twins and in other experiments, and what else could be otherwise.
# One job runs all models on all twins in memory: a file for each run would cost more
# than the runs.
PRESSURE = f"{RESULTS}/pressure"
PAPER_FILTERS = [filter_class(name) for name in SETTINGS.paper_filters]

if TWIN:

    # The random sum drawn anew: its cells are medians over the draws.
    rule random_sum:
        input:
            twin=SETTINGS.model_file,
            identified=rules.identify.output,
            rdgpi=rules.rdgpi_identify.output if "rdgpi" in SETTINGS.models else [],
            published=PUBLISHED,
            code=code_with(PAPER_FILTERS, "hystbench.commands.jobs.random_sum"),
        output:
            draws=f"{RESULTS}/random-sum/draws.csv",
            readings=f"{RESULTS}/random-sum/readings.csv",
        log:
            f"{RESULTS}/logs/random-sum.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/random_sum.tsv"
        params:
            settings=settings_text(SETTINGS.random_sum_job),
            rdgpi=lambda wildcards, input: options("--rdgpi", input.rdgpi),
        message:
            "draws of the random sum"
        shell:
            "hystbench job random-sum {input.twin:q} --identified {input.identified:q}"
            " {params.rdgpi} --settings {params.settings:q}"
            " --draws {output.draws:q} --readings {output.readings:q} 2> {log:q}"

    # How far each step size can go, beside Eq. 19's bound.
    rule step_sweep:
        input:
            records=[record(signal) for signal in SETTINGS.signals],
            identified=rules.identify.output,
            code=code_with(
                map(filter_class, SETTINGS.filters),
                "hystbench.commands.jobs.step_sweep",
            ),
        output:
            edges=f"{RESULTS}/step-sweep/edges.csv",
            points=f"{RESULTS}/step-sweep/points.csv",
        log:
            f"{RESULTS}/logs/step-sweep.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/step_sweep.tsv"
        params:
            settings=settings_text(SETTINGS.step_sweep_job),
        message:
            "how far each step size can go"
        shell:
            "hystbench job step-sweep {input.records:q} --identified {input.identified:q}"
            " --settings {params.settings:q}"
            " --edges {output.edges:q} --points {output.points:q} 2> {log:q}"

    # The ranking with other zero errors, and with a constant tap.
    rule constants:
        input:
            twins=SETTINGS.constants_files,
            identified=rules.identify.output,
            published=PUBLISHED,
            code=code_with(PAPER_FILTERS, "hystbench.commands.jobs.constants"),
        output:
            f"{PRESSURE}/constants.csv",
        log:
            f"{RESULTS}/logs/pressure/constants.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/constants.tsv"
        params:
            settings=settings_text(SETTINGS.constants_job),
        message:
            "the ranking with other constants"
        shell:
            "hystbench job constants {input.twins:q} --identified {input.identified:q}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

    # As configured, for the spread of each cell and for where each claim holds. A
    # changed step size runs its filter again on the twins, and no other. What takes
    # longest goes first, so that no core waits for it at the end.
    rule twin_fits:
        input:
            twins=SETTINGS.twin_files,
            code=code("hystbench.commands.jobs.twin_fits"),
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
            "hystbench job twin-fits {input.twins:q} --settings {params.settings:q}"
            " --out {output:q} 2> {log:q}"

    rule twin_runs:
        input:
            twins=SETTINGS.twin_files,
            fits=rules.twin_fits.output,
            code=lambda wildcards: code_with(
                [filter_class(wildcards.filter)], "hystbench.commands.jobs.twin_runs"
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
            "hystbench job twin-runs {input.twins:q} --fits {input.fits:q}"
            " --settings {params.settings:q} --out {output:q} 2> {log:q}"

    rule twins:
        input:
            twins=SETTINGS.twin_files,
            fits=rules.twin_fits.output,
            runs=[f"{RESULTS}/twins/{name}.json" for name in SETTINGS.paper_filters],
            code=code("hystbench.commands.jobs.twins"),
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
            runs=lambda wildcards, input: options("--run", input.runs),
        message:
            "all models on each twin"
        shell:
            "hystbench job twins {input.twins:q} --fits {input.fits:q} {params.runs}"
            " --settings {params.settings:q}"
            " --errors {output.errors:q} --claims {output.claims:q} 2> {log:q}"

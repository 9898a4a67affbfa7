# Ours beside the paper's: cells, claims, audit and tables. A measured dataset has no
# published numbers, so its errors stand alone.
# Filters and signals that the paper does not have stand in a table of their own.
TABLES = [f"table-{number}" for number in (1, 2, 3, 4)]
ADDED = []
if SETTINGS.added:
    TABLES.append("added")
    ADDED.append(f"{COMPARE}/added.csv")

if TWIN:

    rule tables:
        input:
            runs=runs(),
            records=[record(signal) for signal in SETTINGS.signals],
            order_sweep=rules.order_sweep.output.configured,
            order_sweep_other=rules.order_sweep.output.other,
            identified=rules.identify.output,
            envelopes=rules.envelopes.output,
            draws=rules.random_sum.output.draws,
            edges=rules.step_sweep.output.edges,
            constants=rules.constants.output,
            twin_errors=rules.twins.output.errors,
            twin_claims=rules.twins.output.claims,
            published=PUBLISHED,
            code=code("hystbench.commands.jobs.compare"),
        output:
            cells=report(
                f"{COMPARE}/cells.csv",
                caption="../report/cells.rst",
                category="Comparison",
            ),
            claims=report(
                f"{COMPARE}/claims.csv",
                caption="../report/claims.rst",
                category="Comparison",
            ),
            audit=report(
                f"{COMPARE}/audit.csv",
                caption="../report/audit.rst",
                category="Comparison",
            ),
            off=report(
                f"{COMPARE}/off.csv",
                caption="../report/off.rst",
                category="Comparison",
            ),
            summary=f"{COMPARE}/summary.json",
            verdict=f"{COMPARE}/verdict.rst",
            page=f"{COMPARE}/verdict.md",
            first=f"{COMPARE}/first.md",
            margins=f"{COMPARE}/margins.csv",
            text=f"{COMPARE}/tables.txt",
            tables=report(
                expand(f"{COMPARE}/tables/{{name}}.csv", name=TABLES),
                caption="../report/tables.rst",
                category="Tables",
            ),
            markdown=expand(f"{COMPARE}/tables/{{name}}.md", name=TABLES),
            latex=expand(f"{COMPARE}/tables/{{name}}.tex", name=TABLES),
            added=ADDED,
        log:
            f"{RESULTS}/logs/tables.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/tables.tsv"
        params:
            runs=lambda wildcards, input: options("--run", input.runs),
            records=lambda wildcards, input: options("--record", input.records),
            settings=settings_text(SETTINGS.compare_job),
            folder=lambda wildcards, output: Path(output.verdict).parent,
        message:
            "tables, claims and audit"
        shell:
            "hystbench job compare {params.runs} {params.records}"
            " --order-sweep {input.order_sweep:q} --identified {input.identified:q}"
            " --order-sweep-other {input.order_sweep_other:q} --draws {input.draws:q}"
            " --edges {input.edges:q} --constants {input.constants:q}"
            " --envelopes {input.envelopes:q} --twin-errors {input.twin_errors:q}"
            " --twin-claims {input.twin_claims:q} --settings {params.settings:q}"
            " --out {params.folder:q} 2> {log:q}"

else:

    rule tables:
        input:
            runs=runs(),
            envelopes=rules.envelopes.output,
            order_sweep=rules.order_sweep.output.configured,
            code=code("hystbench.commands.jobs.compare_measured"),
        output:
            errors=report(
                f"{COMPARE}/errors.csv",
                caption="../report/errors.rst",
                category="Comparison",
            ),
            verdict=f"{COMPARE}/verdict.rst",
            text=f"{COMPARE}/tables.txt",
            tables=expand(
                f"{COMPARE}/tables/errors.{{suffix}}", suffix=["csv", "md", "tex"]
            ),
        log:
            f"{RESULTS}/logs/tables.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/tables.tsv"
        params:
            runs=lambda wildcards, input: options("--run", input.runs),
            dataset=SETTINGS.name,
            folder=lambda wildcards, output: Path(output.verdict).parent,
        message:
            "tables, claims and audit"
        shell:
            "hystbench job compare-measured {params.dataset:q} {params.runs}"
            " --out {params.folder:q} 2> {log:q}"


# `snakemake compare` prints ours beside theirs, whether anything was to do or not.
rule compare:
    input:
        rules.tables.output.text,
    log:
        f"{RESULTS}/logs/compare.log",
    message:
        "ours beside theirs"
    shell:
        "cat {input:q} 2> {log:q}"

# The front page: one file that stands alone. It is told what this run made, so that
# pictures of an earlier run with other signals are not shown.
PAGE_TABLES = [*rules.envelopes.output]
if TWIN and "rdgpi" in SETTINGS.models:
    PAGE_TABLES += rules.rdgpi_published.output
if TWIN:
    PAGE_TABLES += ADDED
# `snakemake --report` takes the same captions.
CAPTIONS = Path(os.path.relpath(Path(workflow.current_basedir, "../report")))


rule page:
    input:
        compared=rules.tables.output,
        figures=[figure(name, "svg") for name in FIGURE_INPUTS],
        # The page links them.
        pictures=[figure(name, "png") for name in FIGURE_INPUTS],
        tables=PAGE_TABLES,
        captions=sorted(str(file) for file in CAPTIONS.glob("*.rst")),
        code=code("hystbench.commands.jobs.report"),
        look=sorted(
            str(file)
            for suffix in ("j2", "css", "js", "yaml")
            for file in PACKAGE.glob(f"report/**/*.{suffix}")
        ),
    output:
        f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/page.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/page.tsv"
    params:
        compare=lambda wildcards, input: os.path.dirname(input.compared[0]),
        figures=lambda wildcards, input: options("--figure", input.figures),
        tables=lambda wildcards, input: options("--table", input.tables),
        captions=lambda wildcards, input: os.path.dirname(input.captions[0]),
        settings=settings_text(SETTINGS.page_job),
    message:
        "front page"
    shell:
        "hystbench job report {params.compare:q} {params.figures} {params.tables}"
        " --captions {params.captions:q} --settings {params.settings:q}"
        " --out {output:q} 2> {log:q}"

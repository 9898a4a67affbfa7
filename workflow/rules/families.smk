from hystbench.published.split import CALIBRATION_SIGNALS

# Twins with other hysteresis than the twin's own. `snakemake families` fits them and
# puts them into the package; they are committed there, so no other target makes them.
FAMILY_TWINS = [
    f"{RESULTS}/families/gma-{family}.yaml" for family in ("preisach", "jiles-atherton")
]
FAMILY_SIGNALS = CALIBRATION_SIGNALS


rule family_twins:
    input:
        signals=[f"{RESULTS}/signals/{signal}.npz" for signal in FAMILY_SIGNALS],
        loop=f"{RESULTS}/signals/{config['identification']['signal']}.npz",
        model=PACKAGE / "plants/gma.yaml",
        published=PUBLISHED,
        code=code("hystbench.commands.jobs.families"),
    output:
        twins=FAMILY_TWINS,
        report=f"{RESULTS}/families/families.json",
    log:
        f"{RESULTS}/logs/families/fit.log",
    benchmark:
        f"{RESULTS}/logs/benchmarks/family_twins.tsv"
    params:
        settings=settings_text(SETTINGS.measure_job),
        folder=subpath(output.report, parent=True),
    message:
        "twins with Preisach and Jiles-Atherton hysteresis"
    shell:
        "hystbench job families {input.signals:q} --model {input.model:q} --loop {input.loop:q}"
        " --settings {params.settings:q} --out {params.folder:q} 2> {log:q}"


rule families:
    input:
        FAMILY_TWINS,
    log:
        f"{RESULTS}/logs/families/copy.log",
    params:
        folder=PACKAGE / "plants",
    message:
        "{params.folder} holds the twins of other families"
    shell:
        f"{{{{ {COMMITTED}" "cp {input:q} {params.folder:q}; }} 2> {log:q}"

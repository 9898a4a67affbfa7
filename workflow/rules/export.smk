# How far exported code is from the simulation, by `snakemake export_errors`: it needs no
# record, and `all` leaves it out as no other page wants it.


rule export_errors:
    input:
        code=code("hystbench.commands.jobs.export_errors"),
        # Copied into what is exported, and not imported.
        steps=PACKAGE / "export/steps.py",
    output:
        "results/export/errors.csv",
    log:
        "results/logs/export/errors.log",
    message:
        "exported code beside the simulation"
    shell:
        "hystbench job export-errors --out {output:q} 2> {log:q}"

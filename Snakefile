# The workflow lives in workflow/; this file lets bare `snakemake` find it.
include: "workflow/Snakefile"


# An include resets the default target.
workflow.default_target = "all"

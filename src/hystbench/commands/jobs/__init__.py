"""``hystbench job NAME``: what the rules of the workflow call, one file a job."""

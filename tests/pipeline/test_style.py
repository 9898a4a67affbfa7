"""`snakemake --lint` has nothing to say but for the environment."""

from __future__ import annotations

import json

# The environment is .venv, made by make from requirements.txt with hashes.
ACCEPTED = {"Specify a conda environment or container for each rule."}


def test_snakemake_lint(finished):
    result = finished.snakemake("--lint", "json")
    told = json.loads(result.stdout[result.stdout.index("{") :])
    titles = {
        lint["title"]
        for kind in ("rules", "snakefiles")
        for item in told[kind]
        for lint in item["lints"]
    }
    assert titles == ACCEPTED

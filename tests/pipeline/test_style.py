"""`snakemake --lint` has nothing to say but for the environment; scheduling."""

import sys

import yaml

from hystbench.figures import FIGURES
from tests.conftest import ROOT, own_config

# The environment is .venv, made by make from requirements.txt with hashes.
ACCEPTED = {"Specify a conda environment or container for each rule."}


def test_snakemake_lint(finished):
    result = finished.snakemake("--lint")
    told = [line for line in result.stderr.splitlines() if line.startswith("    * ")]
    titles = {line.removeprefix("    * ").removesuffix(":") for line in told}
    assert titles == ACCEPTED


def test_no_job_waits_for_a_limit_on_submissions(workflow):
    """Snakemake tells how many jobs more may start: with a limit that is the limit."""
    one = ["--verbose", "--force", "results/signals/sine-100hz.npz"]
    assert f"'_job_count': {sys.maxsize}" in (told := workflow.snakemake(*one).stderr)
    assert "'_job_count': 100" not in told
    asked = workflow.snakemake(*one, "--max-jobs-per-timespan", "50/1s")
    assert "'_job_count': 50" in asked.stderr


def test_the_cluster_profile_names_rules_and_groups_that_exist(workflow):
    workflow.configure(own_config())
    listed = workflow.snakemake("--list-rules")
    assert listed.returncode == 0, listed.stderr
    # Rules of a dataset's figures are there where the settings name one.
    rules = set(listed.stdout.split()) | {
        f"draw_{name.replace('-', '_')}" for name in FIGURES
    }
    profile = yaml.safe_load((ROOT / "profiles" / "slurm" / "config.yaml").read_text())
    of_rule = dict(item.split("=") for item in profile["groups"])
    assert set(of_rule) | set(profile["set-resources"]) <= rules
    sizes = dict(item.split("=") for item in profile["group-components"])
    assert set(sizes) == set(of_rule.values())

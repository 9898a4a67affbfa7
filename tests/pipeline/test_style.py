"""`snakemake --lint` asks for an environment only; the cluster profile fits rules."""

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

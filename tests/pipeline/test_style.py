"""`snakemake --lint` has nothing to say but for the environment."""

# The environment is .venv, made by make from requirements.txt with hashes.
ACCEPTED = {"Specify a conda environment or container for each rule."}


def test_snakemake_lint(finished):
    result = finished.snakemake("--lint")
    told = [line for line in result.stderr.splitlines() if line.startswith("    * ")]
    titles = {line.removeprefix("    * ").removesuffix(":") for line in told}
    assert titles == ACCEPTED

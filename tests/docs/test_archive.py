"""An archived trial runs again with the code of its commit."""

import subprocess

from tests.conftest import ROOT

SCRIPT = ROOT / "docs" / "archive" / "again.sh"


def call(*words, cwd):
    return subprocess.run(
        ["sh", str(SCRIPT), *words], cwd=cwd, capture_output=True, text=True
    )


def test_the_old_commit_makes_its_environment_and_runs_its_targets(tmp_path):
    repository = tmp_path / "repository"
    repository.mkdir()

    def git(*words):
        who = ["-c", "user.name=a", "-c", "user.email=a@b.c"]
        done = subprocess.run(
            ["git", *who, *words], cwd=repository, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    git("init", "--quiet")
    # An environment whose snakemake tells what it was called with.
    (repository / "Makefile").write_text(
        ".venv/ready:\n"
        "\tmkdir -p .venv/bin\n"
        "\techo 'PATH=$$PWD/.venv/bin:$$PATH' > .venv/bin/activate\n"
        "\tprintf '#!/bin/sh\\necho old \"$$@\" > told\\n' > .venv/bin/snakemake\n"
        "\tchmod +x .venv/bin/snakemake\n"
    )
    git("add", "Makefile")
    git("commit", "--quiet", "-m", "old")
    old = git("rev-parse", "HEAD")
    git("rm", "--quiet", "Makefile")
    git("commit", "--quiet", "-m", "new")
    done = call(old, "../again", "structures", "held_out", cwd=repository)
    assert done.returncode == 0, done.stderr
    told = (tmp_path / "again" / "told").read_text()
    assert told == "old --cores all structures held_out\n"


def test_without_a_target_the_use_is_told_and_nothing_is_made(tmp_path):
    refused = call("afc1778", str(tmp_path / "again"), cwd=ROOT)
    assert refused.returncode == 2
    assert refused.stderr.startswith("usage:")
    assert not (tmp_path / "again").exists()

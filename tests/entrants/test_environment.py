"""Which solvers can enter: in this environment, and in another."""

import pytest

from hystbench.entrants.environment import begun_by, missing, not_entered


@pytest.fixture
def other(tmp_path):
    """Another environment, with one package, and hystbench."""
    package = tmp_path / "lib" / "python3.11" / "site-packages" / "only_there"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("raise RuntimeError('imported')")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "hystbench").touch()
    return tmp_path


def test_here():
    assert begun_by(None) == "hystbench"
    assert missing(["numpy", "no_such", "only_there"], None) == [
        "no_such",
        "only_there",
    ]
    assert not_entered(["numpy"], None) is None
    assert not_entered([], None) is None


def test_what_another_environment_holds_counts_and_not_ours(other):
    environment = str(other)
    assert begun_by(environment) == f"{other}/bin/hystbench"
    assert missing(["only_there"], environment) == []
    assert missing(["numpy", "only_there"], environment) == ["numpy"]
    assert not_entered(["only_there"], environment) is None


def test_another_environment_without_hystbench_cannot_run_a_job(other):
    (other / "bin" / "hystbench").unlink()
    assert missing(["only_there"], str(other)) == ["hystbench"]


def test_an_environment_that_is_not_there_is_told_in_one_line(tmp_path):
    told = not_entered(["a", "b"], f"{tmp_path}/none")
    assert told.startswith(f"not entered: needs a and b in {tmp_path}/none")
    assert "\n" not in told

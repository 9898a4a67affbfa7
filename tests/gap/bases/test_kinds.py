"""What ``--model`` may be, and what is said where it is something else."""

from hystbench.gap.bases.kinds import kind_of_base
from tests.messages import message

CODE = """
def lag(y, u, dt, tau): ...
def gain(u): ...
def _own(u, dt): ...
def scaled(u, *, by): ...
def simulate(u, dt): ...
def slow(u, dt, rate=2.0): ...
def any_of(*inputs): ...
"""


def test_functions_of_a_file_are_named_one_by_one_first_what_takes_u_and_dt(tmp_path):
    file = tmp_path / "model.py"
    file.write_text(CODE)
    said = message(lambda: kind_of_base(str(file)))
    assert (
        "here 'model:simulate' or 'model:slow' or 'model:any_of' or 'model:lag' "
        "or 'model:gain' or 'model:scaled', started in the folder"
    ) in said


def test_the_function_that_was_asked_for_is_named_alone(tmp_path):
    file = tmp_path / "model.py"
    file.write_text(CODE)
    said = message(lambda: kind_of_base(f"{file}:lag"))
    assert "here 'model:lag', started in the folder" in said

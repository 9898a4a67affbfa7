"""``hystbench job blind-solve``: one solver on the cases of a chunk."""

from hystbench.entrants.answers import Solver, answer_all
from hystbench.options import Folder, Out, Settings, command


@command
def blind_solve(cases: Folder, *, settings: Settings, out: Out) -> None:
    """Run a solver on each folder in CASES and write all its answers."""
    solver = Solver(
        settings["name"], tuple(settings["command"]), settings["time_limit_s"]
    )
    answer_all(solver, cases, out, settings["keep"])

"""``hystbench job blind-left-out``: the score of effects that could not be named."""

from hystbench.challenge.contest.never_seen import left_out
from hystbench.challenge.contest.tables import read_rows
from hystbench.files import atomic_path
from hystbench.options import In, Out, command


@command
def blind_left_out(judged: tuple[In, ...], *, out: Out) -> None:
    """Sum up JUDGED cases, each solved without the effect that is hidden in it."""
    with atomic_path(out) as fresh:
        left_out(read_rows(judged)).to_csv(fresh, index=False)

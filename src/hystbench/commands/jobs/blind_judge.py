"""``hystbench job blind-judge``: answers to a chunk against the truth."""

from hystbench.challenge.contest.chunk import judge_chunk
from hystbench.challenge.contest.plan import chunks, plan
from hystbench.challenge.contest.score import write_rows
from hystbench.gap.schema import SCHEMA
from hystbench.signature import Json, Out, Settings, command


@command
def blind_judge(answers: tuple[Json, ...], *, settings: Settings, out: Out) -> None:
    """Judge the ANSWERS of all solvers to a chunk, a row a case and solver."""
    entries = chunks(plan(**settings["plan"]), settings["size"])
    write_rows(out, list(judge_chunk(entries[settings["chunk"]], answers, SCHEMA)))

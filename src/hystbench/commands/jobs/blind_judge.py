"""``hystbench job blind-judge``: answers to a chunk against the truth.

A case follows from its seed alone. So the judge makes it anew when the answers are
there, and while solvers run there is no file of the truth at all.
"""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import Any

from hystbench.challenge.case import Case
from hystbench.challenge.contest.plan import Entry, chunks, plan
from hystbench.challenge.contest.score import Row, judge_answer, write_rows
from hystbench.challenge.make import make, write_folder
from hystbench.challenge.plant.effects import MACHINES
from hystbench.errors import InputError
from hystbench.files import digest
from hystbench.gap.schema import SCHEMA
from hystbench.options import Json, Out, Settings, command
from hystbench.plain_fits import within_noise
from hystbench.scratch import scratch_folder


@command
def blind_judge(answers: tuple[Json, ...], *, settings: Settings, out: Out) -> None:
    """Judge the ANSWERS of all solvers to a chunk, a row a case and solver."""
    entries = chunks(plan(**settings["plan"]), settings["size"])[settings["chunk"]]
    write_rows(out, list(_judged(entries, answers)))


def _judged(
    entries: Iterable[Entry], answers: Iterable[Mapping[str, Any]]
) -> Iterator[Row]:
    """Judge the answers of all solvers to some cases.

    Raises
    ------
    InputError
        If a solver was not asked a case, or was handed other data than the judge's.
    """
    for entry in entries:
        case = make(entry.spec)
        with scratch_folder("case-") as place:
            write_folder(case, place)
            handed = digest(place)
        for about in answers:
            answer = about["cases"].get(entry.name)
            if answer is None or answer["data"] != handed:
                raise InputError(
                    f"blind: {about['solver']}: {entry.name}: "
                    f"{'not asked' if answer is None else 'other data than now'}; "
                    "expected answers to this very case: solve it again"
                )
            confirm = partial(_confirmed, case)
            name = about["solver"]
            yield judge_answer(name, entry.name, case.truth, answer, SCHEMA, confirm)


def _confirmed(case: Case, names: tuple[str, ...]) -> tuple[str, ...]:
    """Members of a set that the judge's own fits find within the noise.

    All of them where there is no base to fit beside: effects inside a machine have no
    fits of the judge's own.
    """
    if case.model is None or case.truth["family"] in MACHINES:
        return names
    records = [record for record in case.records if record.use == "fit"]
    hidden = case.truth["effects"][0]["name"]
    noise = float(case.truth["noise_rms"])
    floor = noise**2 + float(case.truth["base_error_fit_rms"]) ** 2
    return within_noise(case.model, records, names, hidden, floor, noise)

"""A chunk of a contest: its cases, made again for the judge.

A case follows from its seed alone. So the judge makes it anew when the answers are
there, and while solvers run there is no file of the truth at all.
"""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import Any

from hystbench.challenge.case import Case
from hystbench.challenge.contest.plan import Entry
from hystbench.challenge.contest.score import Row, judge
from hystbench.challenge.make import make
from hystbench.challenge.plant.inside import MACHINES
from hystbench.challenge.writing import write_folder
from hystbench.errors import InputError
from hystbench.files import digest
from hystbench.plain_fits import within_noise
from hystbench.scratch import scratch_folder


def judge_chunk(
    entries: Iterable[Entry],
    answers: Iterable[Mapping[str, Any]],
    schema: Mapping[str, Any],
) -> Iterator[Row]:
    """Judge the answers of all solvers to some cases.

    Parameters
    ----------
    entries : iterable of Entry
    answers : iterable of mapping
        What each solver answered, as the runner writes it.
    schema : mapping
        Of gap.json.

    Raises
    ------
    InputError
        If a solver was not asked a case, or was handed other data than the judge's.
    """
    answers = list(answers)
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
            yield judge(name, entry.name, case.truth, answer, schema, confirm)


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

"""What the page says in words: the verdict in two sentences, and what is not there.

The sentences are in ``sentences.txt.j2`` and ``missing.txt.j2``.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from hystbench.compare.cells import ComparedCell
from hystbench.compare.summary import nearness
from hystbench.figures.style import look
from hystbench.report.reproduction.errors import within
from hystbench.report.reproduction.read import Row
from hystbench.templates import paragraphs

#: Kind of error of a model that is simulated.
FREE_RUN = "free-run simulation"


def of_twin(held: Sequence[ComparedCell], on_held_out: Sequence[Row]) -> list[str]:
    """Say how near held-out errors come, and what stands of the results there."""
    return _sentences(
        measured=False,
        errors=len(held),
        signals=len({cell.signal for cell in held}),
        near=within(held),
        typical=nearness(held)["median_abs_log10_ratio"],
        judged=len(on_held_out),
        standing=sum(row["verdict"] == "reproduced" for row in on_held_out),
    )


def of_measured(name: str, rows: Sequence[Row]) -> list[str]:
    """Say which filter does best, and which models diverge.

    The RDGPI model runs free, which is another task, so it is not ranked beside them.
    """
    ran = [row for row in rows if row["error_kind"] != FREE_RUN and row["re"]]
    records = dict.fromkeys(row["signal"] for row in rows)
    errors: dict[str, list[tuple[float, str]]] = {name: [] for name in records}
    for row in ran:
        errors[row["signal"]].append((float(row["re"]), row["model"]))
    best = Counter(min(found)[1] for found in errors.values() if found).most_common(1)
    lost = dict.fromkeys(row["model"] for row in rows if not row["re"])
    return _sentences(
        measured=True,
        dataset=name,
        records=len(records),
        models=len({row["model"] for row in rows}),
        lost=[look(model).label for model in lost],
        best=look(best[0][0]).label if best else "",
        often=best[0][1] if best else 0,
    )


def _sentences(**told: Any) -> list[str]:
    return paragraphs(__package__, "sentences.txt.j2", **told)


def missing(
    cells: Sequence[ComparedCell], drawn: Iterable[str], measured: bool
) -> list[str]:
    """Say what a full run would have computed and drawn beside these."""
    given = {"cells": cells, "drawn": list(drawn), "measured": measured}
    return paragraphs(__package__, "missing.txt.j2", **given)

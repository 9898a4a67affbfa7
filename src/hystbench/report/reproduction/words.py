"""The verdict in two sentences, and what is not there."""

from collections import Counter
from collections.abc import Collection, Iterable, Sequence

from hystbench.compare.cells import ComparedCell
from hystbench.compare.summary import nearness
from hystbench.figures.style import look
from hystbench.report.reproduction.errors import within
from hystbench.report.reproduction.read import Row
from hystbench.sentences import listed

#: Kind of error of a model that is simulated.
FREE_RUN = "free-run simulation"

#: Figures that a full run draws.
OF_TWIN = (
    "figure-03-play",
    "figure-04-generalized-play",
    "figure-07-order",
    "figure-08-loops",
    "figure-09-chirp",
    "figure-10-sum",
    "figure-11-sum",
    "figure-12-random-sum",
    "identification",
    "learning-curves",
    "errors-heat-map",
    "headline",
)
OF_MEASURED = (
    "headline",
    "identification",
    "figure-07-order",
    "learning-curves",
    "loops",
    "errors-by-record",
)


def of_errors(held: Sequence[ComparedCell]) -> str:
    """Say how near the held-out errors that were run come to the paper's."""
    if not held:
        return (
            "No filter was run on a signal that the twin was not fitted to, so nothing "
            "here is held out."
        )
    signals = len({cell.signal for cell in held})
    on = "the signal" if signals == 1 else f"the {signals} signals"
    median = nearness(held)["median_abs_log10_ratio"]
    typical = (
        "the typical run diverged"
        if median is None
        else f"the typical error is off by a factor of {10**median:.2f}"
    )
    return (
        f"On {on} that the twin was not fitted to, {within(held)} of {len(held)} "
        f"filter errors are within a factor of 2 of the paper's, and {typical}."
    )


def of_claims(on_held_out: Sequence[Row]) -> str:
    """Count what stands of the results that held-out signals alone can judge."""
    about = "of the paper that can be judged on held-out signals alone"
    if not on_held_out:
        return f"No result {about} was put to the test."
    standing = sum(row["verdict"] == "reproduced" for row in on_held_out)
    stand = "stands" if standing == 1 else "stand"
    results = "result" if len(on_held_out) == 1 else "results"
    return f"Of {len(on_held_out)} {results} {about}, {standing} {stand}."


def of_measured(name: str, rows: Sequence[Row]) -> list[str]:
    """Say which filter does best, and which models diverge.

    The RDGPI model runs free, which is another task, so it is not ranked beside them.
    """
    records = list(dict.fromkeys(row["signal"] for row in rows))
    models = list(dict.fromkeys(row["model"] for row in rows))
    best: Counter[str] = Counter()
    for record in records:
        errors = [
            (float(row["re"]), row["model"])
            for row in rows
            if row["signal"] == record and row["error_kind"] != FREE_RUN and row["re"]
        ]
        if errors:
            best[min(errors)[1]] += 1
    count = f"{len(records)} measured record{'s' if len(records) > 1 else ''}"
    if best:
        model, often = best.most_common(1)[0]
        said = (
            f"Of the filters, the {look(model).label} has the smallest relative error "
            f"on {often} of the {count} of {name}."
        )
    else:
        said = f"No filter came to an end on the {count} of {name}."
    lost = dict.fromkeys(row["model"] for row in rows if not row["re"])
    if not lost:
        one, many = "The one model that was run stays", f"All {len(models)} models stay"
        stay = one if len(models) == 1 else many
        return [said, f"{stay} finite on every record."]
    names = listed([look(model).label for model in lost])
    return [said, f"{len(lost)} of {len(models)} models diverged on a record: {names}."]


def not_drawn(expected: Iterable[str], there: Collection[str]) -> list[str]:
    """Say which figures a full run would have drawn beside these."""
    absent = [name for name in expected if name not in there]
    if not absent:
        return []
    return [f"Not drawn, as the run has not what they show: {listed(absent)}."]


def not_run(cells: Sequence[ComparedCell]) -> list[str]:
    """Say what of the benchmark was not run."""
    absent = [cell for cell in cells if not cell.ran]
    if not absent:
        return []
    said = [
        f"This is a part of the benchmark: {len(cells) - len(absent)} of the "
        f"{len(cells)} printed errors have one of ours beside them."
    ]
    for what, whole in (("signal", "signals"), ("model", "models")):
        ran = {getattr(cell, what) for cell in cells if cell.ran}
        none = dict.fromkeys(
            getattr(cell, what) for cell in absent if getattr(cell, what) not in ran
        )
        if none:
            said.append(f"Not run, of the {whole}: {listed(list(none))}.")
    if len(absent) == len(cells):
        said.append("No model was run on a signal of the paper's tables.")
    return said

"""The verdict in two sentences, and what is not there."""

from collections import Counter
from collections.abc import Iterable, Sequence

from hystbench.compare.cells import ComparedCell
from hystbench.compare.summary import nearness
from hystbench.figures.style import look
from hystbench.report.reproduction.errors import filter_cells, within
from hystbench.report.reproduction.read import Measured, Reproduction, Row
from hystbench.sentences import listed

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


def verdict(found: Reproduction | Measured) -> list[str]:
    """Give the verdict: a sentence on errors, one on claims or on divergence."""
    if isinstance(found, Measured):
        return _of_measured(found)
    return [_of_errors(found.cells), _of_claims(found.on_held_out)]


def _of_errors(cells: Sequence[ComparedCell]) -> str:
    held = [cell for cell in filter_cells(cells, "held-out") if cell.ran]
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


def _of_claims(on_held_out: Sequence[Row]) -> str:
    """Count what stands of the results that held-out signals alone can judge."""
    about = "of the paper that can be judged on held-out signals alone"
    if not on_held_out:
        return f"No result {about} was put to the test."
    standing = sum(row["verdict"] == "reproduced" for row in on_held_out)
    stand = "stands" if standing == 1 else "stand"
    results = "result" if len(on_held_out) == 1 else "results"
    return f"Of {len(on_held_out)} {results} {about}, {standing} {stand}."


def _of_measured(found: Measured) -> list[str]:
    """Say which filter does best, and which models diverge.

    The RDGPI model runs free, which is another task, so it is not ranked beside them.
    """
    records = list(dict.fromkeys(row["signal"] for row in found.errors))
    models = list(dict.fromkeys(row["model"] for row in found.errors))
    best: Counter[str] = Counter()
    for record in records:
        errors = [
            (float(row["re"]), row["model"])
            for row in found.errors
            if row["signal"] == record and row["error_kind"] != FREE_RUN and row["re"]
        ]
        if errors:
            best[min(errors)[1]] += 1
    count = f"{len(records)} measured record{'s' if len(records) > 1 else ''}"
    if best:
        model, often = best.most_common(1)[0]
        said = (
            f"Of the filters, the {look(model).label} has the smallest relative error "
            f"on {often} of the {count} of {found.name}."
        )
    else:
        said = f"No filter came to an end on the {count} of {found.name}."
    lost = dict.fromkeys(row["model"] for row in found.errors if not row["re"])
    if not lost:
        return [said, f"{_all(len(models))} finite on every record."]
    names = listed([look(model).label for model in lost])
    return [said, f"{len(lost)} of {len(models)} models diverged on a record: {names}."]


def _all(count: int) -> str:
    return (
        "The one model that was run stays" if count == 1 else f"All {count} models stay"
    )


def source(found: Reproduction | Measured) -> str:
    """Say what is compared with what."""
    if isinstance(found, Measured):
        return "The paper has no numbers for these records, so the errors stand alone."
    return (
        "The paper's numbers are of a measured actuator whose data are not public. "
        "Ours are of its twin, a simulation."
    )


def missing(found: Reproduction | Measured, figures: Iterable[str]) -> list[str]:
    """Say what a full run would have shown beside this."""
    there = set(figures)
    said = []
    if isinstance(found, Reproduction):
        said += _not_run(found.cells)
    expected = OF_MEASURED if isinstance(found, Measured) else OF_TWIN
    absent = [name for name in expected if name not in there]
    if absent:
        said.append(f"Not drawn, as the run has not what they show: {listed(absent)}.")
    return said


def _not_run(cells: Sequence[ComparedCell]) -> list[str]:
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

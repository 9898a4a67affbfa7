"""Putting the page together: which pictures there are, and what they show."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any

from hystbench.cores import each
from hystbench.figures.style import BLUE, COLUMN, GREY, in_style, unit_text
from hystbench.files import write_text
from hystbench.gap.report import diagram, pictures, words
from hystbench.gap.report.pictures import EmbeddedPicture, draw, embedded
from hystbench.gap.report.read import Content, HoldOut, read_content
from hystbench.gap.report.where_pictures import pictures_of
from hystbench.gap.schema import LEFT_OUT
from hystbench.gap.thresholds import BY_CHANCE
from hystbench.gap.vocabulary import for_readers
from hystbench.record import column_name
from hystbench.report.markup import one_micro
from hystbench.sentences import either, listed

TEMPLATE = "report.html.j2"
PICTURE_S = 0.2
"""Seconds that a picture takes, about."""
#: Functions of ``words`` that the template uses.
FILTERS = (
    *("number", "size", "with_error", "percent", "explained", "p_value", "bound"),
    *("sentence", "unit"),
)
#: Of the parts of gap.json with figures, where a bootstrap tells nothing.
INTERVALS = dict.fromkeys(("before_interval", "after_interval", "interval"))


def write_report(folder: str | Path) -> Path:
    """Write report.html from what the gap workflow left in a folder.

    The page stands alone: pictures are inside, there is no script, and nothing is
    fetched. It reads gap.json, model.yaml, the tables in holdout/ and curves.json.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        If one of these files is missing or cannot be read, or gap.json is not as its
        schema says.
    """
    path = Path(folder) / "report.html"
    write_text(path, page(read_content(Path(folder))))
    return path


def page(content: Content) -> str:
    """Make the page of what was read."""
    from hystbench.report.layout import page_environment

    environment = page_environment("hystbench.gap.report")
    environment.filters |= {name: getattr(words, name) for name in FILTERS}
    environment.filters |= {"listed": listed, "either": either}
    named = with_optional(content.gap)  # as the vocabulary has it
    gap = with_optional(for_readers(content.gap))
    # The slowest first, as each goes to the core that is free.
    pictured: list[Callable[[], Any]] = [
        partial(pictures_of, content.curves),
        partial(_series, content.hold_out),
        partial(headline, gap, content.hold_out),
        partial(_ranking, gap),
        partial(_ladder, gap),
        partial(_diagram, content),
    ]
    drawn = each(lambda one: one(), pictured, "pictures", seconds=PICTURE_S)
    (where, missing), series, glance, ranking, ladder, shown = drawn
    page = environment.get_template(TEMPLATE).render(
        gap=gap,
        sentence=words.verdict_sentence(named),
        y=unit_text(gap["unit"]),
        glance=glance,
        diagram=shown,
        reruns=words.rerun_commands(named),
        input_column=_input_column(gap),
        where_pictures=where,
        missing=missing,
        level=BY_CHANCE,
        ladder=ladder,
        ranking=ranking,
        ranked=_ranked(item for item in gap["ranking"] if not item["look"]),
        looks=_looks(gap),
        declined=_declined(gap),
        series=series,
        drawn=min(len(content.hold_out), pictures.MOST_RECORDS),
        held=len(content.hold_out),
    )
    return one_micro(page)


def with_optional(content: Mapping[str, Any]) -> dict[str, Any]:
    """Give what gap.json holds, with what it may leave out."""
    gap = LEFT_OUT | dict(content)
    gap["gap"] = INTERVALS | gap["gap"]
    gap["black_box"] = INTERVALS | gap["black_box"]
    return gap


def headline(gap: dict[str, Any], hold_out: Sequence[HoldOut]) -> list[EmbeddedPicture]:
    """Draw the headline: a stretch of a hold-out record, and the sizes of the gap."""
    after = "with effects" if gap["effects"] else "re-tuned"
    small: dict[str, Any] = {"height": 2.1, "width": COLUMN, "clear": True}
    same = gap["gap"]["after"] == gap["gap"]["before"]
    found = [
        draw(
            pictures.glimpse,
            table,
            None if same else after,
            words=f"A stretch of the hold-out record {table.name}: measured, the "
            f"simulator{'' if same else f', and {after}'}",
            **small,
        )
        for table in pictures.worst(hold_out, 1)
    ]
    rows = [("simulator", gap["gap"]["before"])]
    if not same:
        rows.append((after, gap["gap"]["after"]))
    if gap["withdrawn"]:
        rows.append(("withdrawn", gap["withdrawn"]["after"]))
    said = "; ".join(
        f"{name} {'unbounded' if size is None else f'{size:.3g}'}"
        for name, size in rows
    )
    words = (
        f"RMS residual on all hold-out records, in {unit_text(gap['unit'])}: {said}; "
        f"noise floor {gap['gap']['noise_floor']:.3g}"
    )
    return [*found, _sizes(gap, rows, words=words, **small)]


def _sizes(
    gap: dict[str, Any], rows: Sequence[tuple[str, float | None]], **look: Any
) -> EmbeddedPicture:
    """Draw sizes of the gap beside the noise floor."""
    about = gap["gap"]["noise_floor"], gap["unit"]
    return draw(pictures.sizes, rows, *about, **look)


def _diagram(content: Content) -> EmbeddedPicture:
    said = diagram.words_of(content.model, content.gap)
    with in_style():
        return embedded(diagram.figure_of(content.model, content.gap), said)


def _input_column(gap: dict[str, Any]) -> str:
    """Name the column of an input of one's own, as hystbench simulate reads it."""
    channel = gap["simulator"]["input"]
    return column_name(channel["name"], channel["unit"])


def _ranking(gap: dict[str, Any]) -> EmbeddedPicture | None:
    first = [x for x in gap["ranking"] if x["round"] == 1 and not x["look"]]
    ranked = [item for item in first if "gain" in item][: pictures.BARS]
    if not ranked:
        return None
    named = {(effect["name"], effect["place"]) for effect in gap["effects"]}
    names = [f"{item['name']} ({item['place']})" for item in ranked]
    picked = [(item["name"], item["place"]) in named for item in ranked]
    colors = [BLUE if each else GREY for each in picked]
    gains = [item["gain"] for item in ranked]
    return draw(
        pictures.bars,
        names,
        gains,
        "gain in the score that ranks",
        colors,
        words="Gain over the base of each effect, tried alone; named effects blue",
        height=0.6 + 0.2 * len(names),
    )


def _ranked(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Give the rows that have a score, in the order of their ranking."""
    return [item for item in rows if "declined" not in item]


def _looks(gap: dict[str, Any]) -> list[dict[str, Any]]:
    """Give the second looks, each with who was tried, who was taken, and its rows."""
    found = []
    seconds = (item for item in gap["ranking"] if item["look"])
    for _, group in groupby(seconds, key=lambda item: (item["round"], item["look"])):
        rows = list(group)
        gone = rows[0]["instead_of"]
        found.append(
            {
                **{key: rows[0][key] for key in ("round", "instead_of", "beside")},
                "own": next(item for item in rows if item["name"] == gone),
                "taken": [item["name"] for item in rows if item["taken"]],
                "rivals": len(rows) - 1,
                "rows": _ranked(rows),
            }
        )
    return found


def _declined(gap: dict[str, Any]) -> list[dict[str, Any]]:
    """Give what declined, each reason once though it may hold in every round."""
    found = {
        (item["name"], item["place"], item["declined"]): item
        for item in reversed(gap["ranking"])
        if "declined" in item and not item["look"]
    }
    return list(reversed(found.values()))


def _ladder(gap: dict[str, Any]) -> EmbeddedPicture:
    rungs = [
        (f"+ {item['name']}" if k else item["name"], item["rms"])
        for k, item in enumerate(gap["ladder"])
    ]
    words = "RMS residual on hold-out records after each effect was added"
    return _sizes(gap, rungs, words=words, height=0.8 + 0.35 * len(rungs))


def _series(hold_out: Sequence[HoldOut]) -> EmbeddedPicture | None:
    tables = pictures.worst(hold_out, pictures.MOST_RECORDS)
    if not tables:
        return None

    def paint(axes: Any) -> None:
        pictures.series(axes if len(tables) > 1 else [axes], tables)

    return draw(
        paint,
        words="Hold-out records: measured, before and after; residuals and spectra",
        height=1.75 * len(tables) + 0.2,
        panels=(len(tables), 3),
    )

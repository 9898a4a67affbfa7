"""The page of a check."""

from __future__ import annotations

import math

from hystbench.figures.style import COLUMN, PAGE, unit_text
from hystbench.gap.report.pictures import Picture, draw
from hystbench.inspection import pictures, words
from hystbench.inspection.check import Check
from hystbench.inspection.visible import TENTH
from hystbench.report.layout import page_environment
from hystbench.report.markup import one_micro
from hystbench.report.table import Body, Cell, Column, Table, number
from hystbench.report.table import words as cell


def page(found: Check) -> str:
    """Make the page, HTML in one file."""
    template = page_environment("hystbench.inspection").get_template("page.html.j2")
    record = found.records[0]
    unit = unit_text(record.output.unit)
    made = template.render(
        name=found.dataset.name,
        headline=words.headline(found),
        channels=f"{record.input.name} ({unit_text(record.input.unit)}) to "
        f"{record.output.name} ({unit})",
        noise=f"{words.quantity(found.floor.rms, record.output.unit)} rms, "
        f"{words.FLOORS[found.floor.method]}",
        left=f"{words.quantity(found.left, record.output.unit)} rms",
        findings=found.findings,
        kinds=words.KINDS,
        records=_records(found),
        pictures=_pictures(found),
        chart=_chart(found),
        revealed=_revealed(found),
        hidden=_hidden(found),
    )
    return one_micro(made)


def _records(found: Check) -> Table:
    record = found.records[0]
    columns = (
        Column("record"),
        Column("use"),
        Column("samples", True),
        Column("rate (Hz)", True),
        Column("jitter (%)", True),
        Column("input"),
        Column("period (samples)", True),
        Column("periods", True),
        Column("band"),
        Column(f"input ({unit_text(record.input.unit)})"),
        Column(f"output ({unit_text(record.output.unit)})"),
        Column("delay (ms)", True),
        Column("missing", True),
    )
    rows = [
        [
            cell(item.name),
            cell(item.use),
            number(item.samples, str(item.samples)),
            number(1 / item.dt, f"{1 / item.dt:.6g}"),
            number(
                item.jitter,
                "no clock"
                if item.jitter is None
                else words.jitter_text(item.jitter).removesuffix(" %"),
            ),
            cell(item.excitation.kind),
            number(item.period, str(item.period or "none")),
            number(item.periods, f"{item.periods:.3g}"),
            cell(words.band(item)),
            cell(f"{item.excitation.low:.3g} to {item.excitation.high:.3g}"),
            cell(f"{item.low:.3g} to {item.high:.3g}"),
            number(
                item.delay_s,
                f"{1e3 * item.delay_s:.3g} ± {1e3 * item.delay_error_s:.2g}",
            ),
            number(item.missing, str(item.missing)),
        ]
        for item in found.facts
    ]
    return Table(
        "records",
        "All records. The band holds 99 % of the input's power. The delay is that of "
        "the output behind the loop of play operators: a lag and a late trigger both "
        "show in it.",
        columns,
        (Body(rows),),
        dense=True,
    )


def _pictures(found: Check) -> list[Picture]:
    count = min(len(found.records), pictures.LOOPS)
    columns = min(count, pictures.ROW)
    rows = math.ceil(count / columns)
    more = len(found.records) - count
    rest = f"; {more} more are not drawn" if more else ""
    return [
        draw(
            pictures.loops,
            found,
            words=f"Output over input of each record{rest}",
            height=0.4 + 1.6 * rows,
            width=PAGE if columns > 1 else COLUMN,
            panels=(rows, columns),
        ),
        draw(
            pictures.bands,
            found,
            words="Band and swing of each record's input: between and beyond them "
            "nothing is known of the device",
            height=2.4,
        ),
    ]


def _chart(found: Check) -> Picture | None:
    shown = [item for item in found.effects if math.isfinite(item.seen_from)]
    if not shown:
        return None
    return draw(
        pictures.strengths,
        found.effects,
        words="How strong each effect must be to be seen, and to be told from every "
        f"other effect; beyond the dashed line, {100 * TENTH:g} % of the output, it "
        "counts as not revealed",
        height=0.8 + 0.2 * len(shown),
    )


def _revealed(found: Check) -> Table:
    record = found.records[0]
    rows = [
        [
            cell(item.effect),
            number(item.seen_from, words.percent(item.seen_from)),
            cell(words.strength(item, record.input.unit, record.output.unit)),
            cell(item.form.replace("_", " ")),
            cell(words.mistaken(item) or "nothing"),
        ]
        for item in found.revealed
    ]
    return _table(
        "revealed",
        f"Revealed: {len(rows)} of {len(found.effects)} effects. Until it is as strong "
        "as the last column says, it can be mistaken for another.",
        ("effect", "seen from", "that is", "in the form", "can be mistaken for"),
        rows,
    )


def _hidden(found: Check) -> Table:
    rows = [[cell(item.effect), cell(item.why)] for item in found.hidden]
    return _table(
        "hidden",
        f"Not revealed: {len(rows)} of {len(found.effects)} effects.",
        ("effect", "why"),
        rows,
    )


def _table(
    name: str, caption: str, titles: tuple[str, ...], rows: list[list[Cell]]
) -> Table:
    columns = tuple(Column(title, title == "seen from") for title in titles)
    return Table(name, caption, columns, (Body(rows),), cards=True)

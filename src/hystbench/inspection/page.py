"""The page of a check."""

import math
from collections.abc import Callable
from operator import attrgetter

from hystbench.figures.style import COLUMN, PAGE, unit_text
from hystbench.gap.report.pictures import EmbeddedPicture, draw
from hystbench.inspection import pictures, words
from hystbench.inspection.check import Check
from hystbench.inspection.facts import Facts
from hystbench.inspection.visible import REVEALED, SmallestSeen
from hystbench.report.layout import page_environment
from hystbench.report.markup import one_micro
from hystbench.report.table import Cell, Heading, PageTable, number, table_of


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


def _records(found: Check) -> PageTable:
    record = found.records[0]
    shown: dict[Heading, Callable[[Facts], Cell | str]] = {
        Heading("record"): attrgetter("name"),
        Heading("use"): attrgetter("use"),
        Heading("samples", True): lambda x: number(x.samples, str(x.samples)),
        Heading("rate (Hz)", True): lambda x: number(1 / x.dt, f"{1 / x.dt:.6g}"),
        Heading("jitter (%)", True): lambda x: number(x.jitter, _jitter(x)),
        Heading("input"): attrgetter("input.kind"),
        Heading("period (samples)", True): lambda x: number(
            x.period, str(x.period or "none")
        ),
        Heading("periods", True): lambda x: number(x.periods, f"{x.periods:.3g}"),
        Heading("band"): words.band,
        Heading(f"input ({unit_text(record.input.unit)})"): lambda x: (
            f"{x.input.low:.3g} to {x.input.high:.3g}"
        ),
        Heading(f"output ({unit_text(record.output.unit)})"): lambda x: (
            f"{x.low:.3g} to {x.high:.3g}"
        ),
        Heading("delay (ms)", True): lambda x: number(
            x.delay_s, f"{1e3 * x.delay_s:.3g} ± {1e3 * x.delay_error_s:.2g}"
        ),
        Heading("missing", True): lambda x: number(x.missing, str(x.missing)),
    }
    return table_of(
        "records",
        "All records. The band holds 99 % of the input's power. The delay is that of "
        "the output behind the loop of play operators: a lag and a late trigger both "
        "show in it.",
        found.facts,
        shown,
        dense=True,
    )


def _jitter(item: Facts) -> str:
    if item.jitter is None:
        return "no clock"
    return words.jitter_text(item.jitter).removesuffix(" %")


def _pictures(found: Check) -> list[EmbeddedPicture]:
    count = min(len(found.records), pictures.MOST_LOOPS)
    columns = min(count, pictures.LOOPS_IN_ROW)
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


def _chart(found: Check) -> EmbeddedPicture | None:
    shown = [item for item in found.effects if math.isfinite(item.seen_from)]
    if not shown:
        return None
    return draw(
        pictures.strengths,
        found.effects,
        words="How strong each effect must be to be seen, and to be told from every "
        f"other effect; beyond the dashed line, {100 * REVEALED:g} % of the output, it "
        "counts as not revealed",
        height=0.8 + 0.2 * len(shown),
    )


def _revealed(found: Check) -> PageTable:
    record = found.records[0]
    units = record.input.unit, record.output.unit
    shown: dict[Heading, Callable[[SmallestSeen], Cell | str]] = {
        Heading("effect"): attrgetter("effect"),
        Heading("seen from", True): lambda x: number(
            x.seen_from, words.percent(x.seen_from)
        ),
        Heading("that is"): lambda x: words.strength(x, *units),
        Heading("in the form"): lambda x: x.form.replace("_", " "),
        Heading("can be mistaken for"): lambda x: words.mistaken(x) or "nothing",
    }
    return table_of(
        "revealed",
        f"Revealed: {len(found.revealed)} of {len(found.effects)} effects. Until it is "
        "as strong as the last column says, it can be mistaken for another.",
        found.revealed,
        shown,
        cards=True,
    )


def _hidden(found: Check) -> PageTable:
    return table_of(
        "hidden",
        f"Not revealed: {len(found.hidden)} of {len(found.effects)} effects.",
        found.hidden,
        {Heading("effect"): attrgetter("effect"), Heading("why"): attrgetter("why")},
        cards=True,
    )

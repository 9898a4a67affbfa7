"""The verdict in a few sentences, for the report's first page and the terminal.

Every number comes from the summary.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from hystbench.compare.claims.claim import Judgement
from hystbench.compare.tables import Table

#: Results that may stand on held-out signals, in words.
SHORTLY = {
    "peak-to-peak-changes": "the peak-to-peak displacement changes with frequency",
    "chirp-oscillation": "the chirp's displacement oscillates beyond the resonance",
    "linear-filter-poor": "the linear filter fits hysteresis poorly",
    "sines-gpo-best-low": "the GPO filter is far ahead at low frequencies",
    "chirp-gpo-best": "the GPO filter is best on the chirp",
    "sums-gpo-best": "the GPO filter is best on the sums of sines",
    "sums-backlash-second": "the backlash filter is second on the sums of sines",
}
#: An RMS displacement is told where it is off by more (%).
NEAR_RMS = 3.0

HEADERS = ("", "runs", "within a factor of 2", "median |log10(ours/paper)|", "diverged")


def _percent(fraction: float | None) -> str:
    return "none" if fraction is None else f"{100 * fraction:.0f} %"


def _median(value: float | None) -> str:
    return "none" if value is None else f"{value:.3f}"


def _row(name: str, part: Mapping[str, Any]) -> tuple[str, ...]:
    return (
        name,
        f"{part['cells']} of {part['cells_published']}",
        _percent(part["within_factor_2"]),
        _median(part["median_abs_log10_ratio"]),
        str(part["diverged"]),
    )


def rows(summary: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """List the lines of the small table, held-out and calibrated cells apart."""
    split = {"held_out": "held out", "calibrated": "calibrated"}
    found = []
    for key, name in split.items():
        if key in summary:
            part = summary[key]
            median = part["median_abs_log10_ratio_all"]
            found.append(
                _row(f"{name}: all filters", part | {"median_abs_log10_ratio": median})
            )
            found += [
                _row(f"{name}: {model}", own)
                for model, own in part["per_model"].items()
            ]
    if not found:
        found = [
            _row("four filters", summary),
            *(_row(model, part) for model, part in summary["per_model"].items()),
        ]
    return [*found, _row("rdgpi, our guess of the model", summary["rdgpi"])]


def sentences(summary: Mapping[str, Any]) -> list[str]:
    """Give the verdict in words: first what no fit has read, apart from the rest."""
    if summary["cells"] == 0:
        said = [
            "No filter was run on a signal of the paper, so nothing is compared with "
            "its Tables 1-3."
        ]
    else:
        said = [*_held_out(summary), *_rest(summary)]
    said.extend(_findings(summary))
    said.append(_claims(summary))
    said.extend(_families(summary["claims_reproduced_where"]))
    said.append(
        "The twin is a simulation, since the measured data are not public: agreement "
        "says that the models do on such a plant as printed, not that the device was "
        "measured again."
    )
    return said


def _held_out(summary: Mapping[str, Any]) -> list[str]:
    """Say what comes of signals that no fit has read."""
    part = summary.get("held_out")
    if part is None or not part["cells"]:
        return []
    return [
        _nearness(part, "filter errors (MSE) of the held-out signals"),
        _orders(part["orderings"], "these signals"),
        *_held_out_claims(summary["claims_on_held_out"]),
        *_rms(summary["rms_error_percent"]),
    ]


def _rms(percent: Mapping[str, float]) -> list[str]:
    """Say on which signals the twin's RMS displacement is off."""
    if not percent:
        return []
    off = {name: value for name, value in percent.items() if abs(value) > NEAR_RMS}
    told = ", ".join(f"{name} {value:+.1f} %" for name, value in off.items())
    return [
        f"The RMS displacement is within {NEAR_RMS:g} % of the paper's on "
        f"{len(percent) - len(off)} of {len(percent)} signals"
        + (f"; beyond are {told}." if off else ".")
    ]


def _rest(summary: Mapping[str, Any]) -> list[str]:
    """Say what the twin is fitted to, apart."""
    part = summary.get("calibrated")
    if part is None:
        words = "filter errors (MSE) in Tables 1-3"
        return [_nearness(summary, words), _orders(summary["orderings"], "them")]
    if not part["cells"]:
        return []
    return [
        _nearness(part, "errors to which the twin is fitted"),
        _orders(part["orderings"], "these signals"),
    ]


def _held_out_claims(claims: Sequence[Mapping[str, str]]) -> list[str]:
    if not claims:
        return []
    stand = [each["id"] for each in claims if each["verdict"] == "reproduced"]
    named = "; ".join(SHORTLY.get(name, name) for name in stand)
    again = sum(each["basis"] == "fitted" for each in claims)
    return [
        f"Of {len(claims)} results of the paper that can be judged on signals that no "
        f"fit has read, {len(stand)} hold there and on all signals together"
        f"{f': {named}' if named else ''}. Of these {len(claims)}, {again} are also "
        "about fitted signals."
    ]


def _orders(order: Mapping[str, int], where: str) -> str:
    return (
        f"Under {where} {order['agree']} of {order['compared']} pairs of filters stand "
        "in the paper's order."
    )


def _findings(summary: Mapping[str, Any]) -> list[str]:
    said = []
    if summary["eq19"]:
        said.append(_eq19(summary["eq19"]))
    if summary["constant_tap"]:
        said.append(_constant_tap(summary["constant_tap"]))
    return said


def _eq19(found: Mapping[str, Any]) -> str:
    told = (
        f"Eq. 19 is {'no' if found['inside'] else 'a'} guarantee here: in "
        f"{found['inside']} of {found['edges']} cases of a filter and a signal the "
        "filter fails at a step size that it allows"
    )
    example = found["example"]
    if example:
        told += (
            f" ({example['model']} on {example['signal']} at {example['edge']:.3g}, "
            f"where {example['bound']:.3g} is allowed)"
        )
    return f"{told}."


def _constant_tap(found: Mapping[str, Any]) -> str:
    without = found["without"]
    *smaller, given = found["with"]
    told = (
        "The ranking leans on a constant: with a constant tap in every filter, "
        f"{given['constant_tap']:g} times the RMS of the other taps, the GPO filter is "
        f"first on {given['gpo_first']} of {given['signals']} signals instead of "
        f"{without['gpo_first']}"
    )
    if smaller:
        sizes = " or ".join(f"{row['constant_tap']:g}" for row in smaller)
        firsts = " and ".join(str(row["gpo_first"]) for row in smaller)
        told += f" (on {firsts} with a tap of {sizes} times that)"
    for words, key in (("held out", "pairs_held_out"), ("fitted", "pairs_calibrated")):
        told += (
            f"; {words}, {given[key][0]} of {given[key][1]} pairs of filters stand as "
            f"printed instead of {without[key][0]}"
        )
    least = min(found["zero_errors"], key=lambda row: int(row["gpo_first"]))
    now, usual = (1e3 * row["zero_error_A"] for row in (least, without))
    return (
        f"{told}. With a zero error of {now:+.3g} mA instead of {usual:+.3g} mA it is "
        f"first on {least['gpo_first']}."
    )


def first_result(summary: Mapping[str, Any]) -> str:
    """Write the README's table of what was found as Markdown, failures among it."""
    lines = [*_first_of_held_out(summary), *_first_of_findings(summary)]
    return _grid(lines, ("question", "found", "more"), "pipe") + "\n"


def _first_of_held_out(summary: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    part = summary.get("held_out")
    if not part or not part["cells"]:
        return []
    page = "[reproduction](docs/reproduction.md)"
    cells, order = part["cells"], part["orderings"]
    near = round(part["within_factor_2"] * cells)
    lines = [
        (
            "Filter errors (MSE) on signals that no fit has read: within a factor "
            "of 2 of the paper's",
            f"{near} of {cells}",
            page,
        ),
        (
            "Pairs of filters on these signals in the paper's order",
            f"{order['agree']} of {order['compared']}",
            page,
        ),
    ]
    claims = summary["claims_on_held_out"]
    stand = sum(each["verdict"] == "reproduced" for each in claims)
    lines.append(
        (
            "Results of the paper that hold on these and on all signals",
            f"{stand} of {len(claims)}",
            page,
        )
    )
    percent = summary["rms_error_percent"]
    if percent:
        close = sum(abs(value) <= NEAR_RMS for value in percent.values())
        lines.append(
            (
                f"RMS displacements within {NEAR_RMS:g} % of the paper's",
                f"{close} of {len(percent)}",
                page,
            )
        )
    return lines


def _first_of_findings(summary: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    lines = []
    found = summary["eq19"]
    if found:
        lines.append(
            (
                "The bound of Eq. 19 on the convergence factor keeps a filter stable",
                f"no: {found['inside']} of {found['edges']} filters and signals fail",
                "[Eq. 19](docs/reproduction.md#eq-19)",
            )
        )
    found = summary["constant_tap"]
    if found:
        without, given = found["without"], found["with"][-1]
        least = min(found["zero_errors"], key=lambda row: int(row["gpo_first"]))
        signals = given["signals"]
        page = "[pressure](docs/pressure.md)"
        lines += [
            (
                "Signals on which the GPO filter is first",
                f"{without['gpo_first']} of {signals}",
                page,
            ),
            (
                "The same, with a constant tap in every filter",
                f"{given['gpo_first']} of {signals}",
                page,
            ),
            (
                "The same, with a zero error of "
                f"{1e3 * least['zero_error_A']:+.3g} mA instead of "
                f"{1e3 * without['zero_error_A']:+.3g} mA",
                f"{least['gpo_first']} of {signals}",
                page,
            ),
        ]
    return lines


def _nearness(part: Mapping[str, Any], words: str) -> str:
    """Say how near a part of the cells comes to the paper."""
    medians = part["median_abs_log10_ratio"]
    if isinstance(medians, Mapping):
        medians = part["median_abs_log10_ratio_all"]
    typical = (
        "the typical run diverged"
        if medians is None
        else f"the typical MSE is off by a factor of {10**medians:.2f}"
    )
    return (
        f"Of the {part['cells']} {words}, "
        f"{_percent(part['within_factor_2'])} are within a factor of 2 of the paper "
        f"and {typical}."
    )


def _claims(summary: Mapping[str, Any]) -> str:
    """Count the claims by what the twin knew of them, never in one number."""
    bases = summary["claims_elsewhere"]
    parts = []
    for basis, words in (
        ("fitted", "rest on what is fitted alone"),
        ("constrained", "are demanded by the calibration"),
        ("built-in", "follow from how twin and signals are made"),
        ("", "are theory or notation"),
    ):
        counts = bases[basis]
        tried = counts["reproduced"] + counts["not_reproduced"]
        parts.append(f"{tried} {words}, of which {counts['reproduced']} hold")
    every = list(bases.values())
    refuted = sum(counts["refuted_by_the_paper"] for counts in every)
    untested = sum(counts["not_testable"] for counts in every)
    return (
        f"Of the other claims {'; '.join(parts)}; {refuted} are refuted by the paper's "
        f"own numbers and {untested} cannot be tested here."
    )


def _families(where: Mapping[str, int]) -> list[str]:
    """Say how many reproduced claims also hold where the hysteresis is another's."""
    other = where["every_family"] + where["some_families"]
    if other:
        return [
            f"Of {other} reproduced results, what is demanded or built in left out, "
            "that were judged in other experiments and "
            f"on twins with other hysteresis too, {where['every_family']} hold in each "
            "of them."
        ]
    if where["one_family_run"]:
        return [
            "No twin with other hysteresis was run: the reproduced claims are shown on "
            "the GPI twin only, which the GPO filter's own operators make."
        ]
    return []


LEGEND = (
    "Held out are signals whose errors no fit has read; calibrated are those to which "
    "the twin and the step sizes are fitted."
)


def verdict_rst(summary: Mapping[str, Any]) -> str:
    """Write the first page of the report as reStructuredText."""
    return _page(sentences(summary), _table(summary, "rst"))


def verdict_markdown(summary: Mapping[str, Any]) -> str:
    """Write the verdict as Markdown."""
    return _page(sentences(summary), _table(summary, "pipe"))


def _table(summary: Mapping[str, Any], style: str) -> str:
    """Write the small table; a bar has a meaning of its own in both markups."""
    headers = [header.replace("|", r"\|") for header in HEADERS]
    return _grid(rows(summary), headers, style)


def _grid(lines: Sequence[Sequence[str]], headers: Sequence[str], style: str) -> str:
    """Write a table of text in one of the styles of tabulate."""
    frame = pd.DataFrame(lines, columns=list(headers), dtype=str)
    return str(frame.to_markdown(index=False, tablefmt=style, disable_numparse=True))


def _page(said: Sequence[str], table: str) -> str:
    listed = "\n".join(f"- {sentence}" for sentence in said[:-1])
    return "\n\n".join((listed, said[-1], table, LEGEND)) + "\n"


def print_tables(
    tables: Iterable[Table],
    judgements: Iterable[Judgement],
    summary: Mapping[str, Any],
) -> str:
    """Write ours beside theirs and the claims for a terminal."""
    parts = []
    for table in tables:
        lines = table.frame.to_numpy().tolist()
        body = _grid(lines, list(table.frame.columns), "simple")
        parts.append("\n".join(filter(None, (table.caption, body, table.legend))))
    ledger = _grid(
        [(j.verdict, j.claim.id, j.published_bears_out) for j in judgements],
        ("verdict", "claim", "paper's own tables bear it out"),
        "simple",
    )
    numbers = _grid(rows(summary), HEADERS, "simple")
    return "\n\n".join((*parts, ledger, numbers, "\n".join(sentences(summary)))) + "\n"

"""The audit: errors in the paper's tables, text and equations, each with its evidence.

Where the printed numbers show the error, the evidence is computed from them. The words
are in ``discrepancies.yaml``.
"""

from collections.abc import Iterator, Mapping
from dataclasses import astuple, dataclass, fields
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.files import write_csv
from hystbench.published import (
    FILTERS,
    Pair,
    Text,
    load_errors,
    load_table4_gpo,
    load_text,
    signals,
    sines,
)
from hystbench.published.consistency import SignalCheck, check
from hystbench.published.equations import (
    gamma_left,
    gamma_right,
    generalized_play,
    generalized_play_eq12,
)
from hystbench.record import FloatArray
from hystbench.yaml_files import table_of


@dataclass(frozen=True)
class AuditRow:
    """One finding about the paper's own numbers or words."""

    kind: str
    where: str
    statement: str
    evidence: str


def _filled(words: Mapping[str, str], **numbers: Any) -> AuditRow:
    """Make a row of words, filled with numbers."""
    return AuditRow(**{key: text.format(**numbers) for key, text in words.items()})


def _row(name: str, **numbers: Any) -> AuditRow:
    """Make the row of what was found, filled with its numbers."""
    return _filled(table_of(__file__)["found"][name], **numbers)


def _sines(pairs: tuple[Pair, ...], model: str) -> dict[float, Pair]:
    """Give the pairs of a model under sines, by rising frequency."""
    own = {pair.signal: pair for pair in pairs if pair.model == model}
    return {hz: own[signal] for signal, hz in sines(own.values()).items()}


def table4_gpo_repeats(pairs: tuple[Pair, ...], rows: tuple[Pair, ...]) -> bool:
    """Tell whether Table 4 repeats the GPO errors of Tables 1-3 digit for digit."""
    gpo = {p.signal: (p.mse, p.re) for p in pairs if p.model == "gpo"}
    return all(
        gpo[signal] == (row.mse, row.re)
        for signal, row in zip(signals(pairs, 4), rows, strict=True)
    )


def table4_rows(pairs: tuple[Pair, ...], rows: tuple[Pair, ...]) -> Iterator[AuditRow]:
    """Check the column of the GPO filter and the labels of Table 4."""
    found = "repeats" if table4_gpo_repeats(pairs, rows) else "differs"
    yield _row(f"table-4-{found}", rows=len(rows))
    last = rows[-1]
    for pair in pairs:
        if pair.model == "gpo" and (pair.mse, pair.re) == (last.mse, last.re):
            yield _row("last-label", pair=pair)


def frequency_list(pairs: tuple[Pair, ...], text: Text) -> Iterator[AuditRow]:
    """Compare the frequencies of the text with those of the tables."""
    tabled, told = set(_sines(pairs, "gpo")), set(text.sine_frequencies_hz)
    if tabled != told:
        yield _row("sines", told=_hz(told - tabled), tabled=_hz(tabled - told))
    if text.order_sweep_hz not in tabled:
        yield _row("order-sweep", hz=text.order_sweep_hz, tabled=_hz(tabled))


def _hz(frequencies: set[float]) -> str:
    return ", ".join(f"{f:g}" for f in sorted(frequencies)) + " Hz"


def gpo_not_best(pairs: tuple[Pair, ...]) -> Iterator[AuditRow]:
    """Find signals of Tables 1-3 at which another filter beats the GPO filter."""
    mse = {(p.signal, p.model): p for p in pairs}
    for pair in pairs:
        if pair.model != "gpo":
            continue
        for other in FILTERS:
            rival = mse[pair.signal, other]
            if rival.mse.value < pair.mse.value:
                yield _row("gpo-not-best", pair=pair, rival=rival)


def gpo_dips(pairs: tuple[Pair, ...]) -> Iterator[AuditRow]:
    """Find falls of the GPO filter's error between neighbouring sines."""
    row = list(_sines(pairs, "gpo").items())
    for (below, first), (above, second) in pairwise(row):
        if second.mse.value < first.mse.value:
            trend = "rises" if second.re.value > first.re.value else "falls"
            numbers = {"first": first, "second": second, "trend": trend}
            yield _row("gpo-dips", below=below, above=above, **numbers)


def coarse_digits(pairs: tuple[Pair, ...]) -> Iterator[AuditRow]:
    """Find pairs printed so coarsely that they can contradict nothing."""
    for pair in pairs:
        if pair.rms.high > 2 * pair.rms.low:
            yield _row("coarse-digits", pair=pair)


def chirp_rate(text: Text) -> Iterator[AuditRow]:
    """Work out the length of the chirp, which the paper does not give."""
    rates = text.chirp_rates
    rate = sum(rates) / len(rates)
    length = (text.chirp_to_hz - text.chirp_from_hz) / rate
    yield _row("chirp-rate", rates=rates, text=text, length=length)


def crossings(
    envelope: dict[str, float], low: float, high: float
) -> tuple[tuple[float, float, float], ...]:
    """Find where gamma_l <= gamma_r: start, end and the largest excess.

    Scans [low, high] in steps of 1e-5, so the ends are true to one step.
    """
    v: FloatArray = np.linspace(low, high, round((high - low) / 1e-5) + 1)
    excess = gamma_right(v, envelope) - gamma_left(v, envelope)
    inside = np.flatnonzero(excess >= 0)
    if len(inside) == 0:
        return ()
    runs = np.split(inside, np.flatnonzero(np.diff(inside) > 1) + 1)
    return tuple(
        (float(v[run[0]]), float(v[run[-1]]), float(excess[run].max())) for run in runs
    )


def envelopes(text: Text) -> Iterator[AuditRow]:
    """Check gamma_l > gamma_r and the start of Eqs. 4 and 12."""
    limit = text.amplitude_a
    for start, end, excess in crossings(text.envelope, -limit, limit):
        yield _row("envelopes-cross", start=start, end=end, excess=excess)
    below = crossings(text.envelope, -2 * limit, -limit)
    if below:
        yield _row("envelopes-cross-below", end=below[-1][1], limit=limit)
    zero: FloatArray = np.zeros(1)
    eq4 = generalized_play(zero, zero, text.envelope)[0, 0]
    eq12 = generalized_play_eq12(zero, zero, text.envelope)[0, 0]
    yield _row("start-of-plays", eq4=eq4, eq12=eq12)


def units_of_sums(pairs: tuple[Pair, ...], text: Text) -> Iterator[AuditRow]:
    """Compare displacement per input of the two sums with that of the sines."""
    rms = {p.signal: p.rms for p in pairs if p.model == "backlash"}
    gains = [
        pair.rms.middle / (text.amplitude_a / 2**0.5)
        for pair in _sines(pairs, "backlash").values()
    ]
    for signal, lines in text.sums.items():
        amplitude = (sum(a**2 for a in lines.values()) / 2) ** 0.5
        gain = rms[signal].middle / amplitude
        if gain > max(gains):
            usual = {"least": min(gains), "most": max(gains)}
            yield _row("units-of-sums", signal=signal, gain=gain, **usual)


def wording(text: Text) -> Iterator[AuditRow]:
    """List what the words and the symbols of the paper leave wrong or open."""
    n = text.filter_length
    numbers = {"n": n, "taps": n + 1, "volterra": n + 1 + (n + 1) ** 2, "less": n - 1}
    for words in table_of(__file__)["read"]:
        yield _filled(words, **numbers)


def _consistency(signal: str, found: SignalCheck) -> Iterator[AuditRow]:
    """Tell what MSE / RE^2 = mean(d^2) says about a signal."""
    rms, left, ways = found.intervals, found.removals.values(), len(found.removals)
    for one, other in found.conflicts:
        both = {"one": one, "other": other, "rms": (rms[one], rms[other])}
        yield _row("pairs-conflict", signal=signal, **both)
    for removed, agreed in found.removals.items():
        rank = "the smallest set" if ways == 1 else f"one of {ways} smallest sets"
        about = {"removed": " and ".join(removed), "rank": rank, "left": agreed}
        yield _row("agree-without" if removed else "agree", signal=signal, **about)
    for model in rms:
        standing = found.standing(model)
        if model not in FILTERS and standing != "yes":
            about = {"model": model, "rms": rms[model]}
            told = " or ".join(f"{each} um" for each in left)
            yield _row(f"against-filters-{standing}", signal=signal, left=told, **about)


def audit() -> tuple[AuditRow, ...]:
    """List every finding, the inconsistent pairs of MSE and RE first."""
    pairs, text = load_errors(), load_text()
    checks = check(pairs).items()
    return (
        *(row for signal, found in checks for row in _consistency(signal, found)),
        *table4_rows(pairs, load_table4_gpo()),
        *frequency_list(pairs, text),
        *gpo_not_best(pairs),
        *gpo_dips(pairs),
        *coarse_digits(pairs),
        *chirp_rate(text),
        *envelopes(text),
        *units_of_sums(pairs, text),
        *wording(text),
    )


def write_audit(path: str | Path) -> None:
    """Write the audit as CSV: kind, where, statement, evidence."""
    columns = [field.name for field in fields(AuditRow)]
    write_csv(path, columns, (astuple(row) for row in audit()))

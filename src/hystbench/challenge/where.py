"""Where an effect shows: its power over each view's axis, from its true difference.

And whether a solver that says where has looked in the right place.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from hystbench.challenge.plant.hysteresis import LARGEST_CURRENT
from hystbench.challenge.plant.kind import EffectKind
from hystbench.record import FloatArray, Record

#: Edges of the bins: frequencies in Hz (48 an octave, so that a lone line fills few),
#: current in A, its rate in A/s (eight a decade), seconds from a record's start.
FREQUENCY_EDGES = np.concatenate([[0.0], 0.01 * 2.0 ** (np.arange(817) / 48.0)])
CURRENT_EDGES = np.linspace(-LARGEST_CURRENT, LARGEST_CURRENT, 25)
RATE_EDGES = np.concatenate([[0.0], 0.001 * 10.0 ** (np.arange(57) / 8.0)])
TIME_EDGES = np.linspace(0.0, 60.0, 61)

#: Share of the power that a place holds at least.
HALF = 0.5
#: An amplitude's axis may be the input, or its magnitude.
_MAGNITUDE = re.compile(r"magnitude|abs|\|")


def where(
    effect: EffectKind,
    records: list[Record],
    differences: list[FloatArray],
    outputs: list[FloatArray],
) -> list[dict[str, Any]]:
    """Tell for each view which range holds the effect's power.

    Power is the difference's square, summed over the samples of the fit records.

    Parameters
    ----------
    effect : EffectKind
        It says which views are right.
    records : list of Record
        The fit records.
    differences, outputs : list of ndarray
        Output with the effect minus without, noise-free, of each record; and without.

    Returns
    -------
    list of dict
        ``view``, ``right``, ``axis``, ``unit``, ``from``, ``to`` (shortest range that
        holds half of the power), ``share`` (what it holds), ``edges`` and ``shares``
        of the bins. Branches and records have ``names`` in the place of edges.
    """
    power = [difference**2 for difference in differences]
    speeds = [np.gradient(record.u, record.dt) for record in records]
    pooled = np.concatenate(power)
    total = float(pooled.sum())
    if total == 0.0:
        return []

    def over(
        view: str, axis: str, unit: str, edges: FloatArray, values: list[FloatArray]
    ) -> dict[str, Any]:
        inside = np.clip(np.concatenate(values), edges[0], edges[-1])
        counts, _ = np.histogram(inside, edges, weights=pooled)
        return _range(view, axis, unit, edges, counts / total)

    spectrum = np.zeros(len(FREQUENCY_EDGES) - 1)
    for record, difference in zip(records, differences, strict=True):
        spectrum += _spectrum(difference, record.dt)
    spectrum /= total
    rising = np.concatenate(speeds) > 0
    shares = {
        "rising": float(pooled[rising].sum() / total),
        "falling": float(pooled[~rising].sum() / total),
    }
    by_record = {
        record.name: float(part.sum() / total)
        for record, part in zip(records, power, strict=True)
    }
    ranges = [
        _range("frequency", "frequency", "Hz", FREQUENCY_EDGES, spectrum),
        over("amplitude", "u", "A", CURRENT_EDGES, [r.u for r in records]),
        over("rate", "abs(du/dt)", "A/s", RATE_EDGES, [abs(s) for s in speeds]),
        over("slow-time", "time", "s", TIME_EDGES, [r.time for r in records]),
        _range("unexplained", "frequency", "Hz", FREQUENCY_EDGES, spectrum),
        _names("branch", shares),
        _names("record", by_record),
        _delay(records, differences, outputs, total),
    ]
    for item in ranges:
        item["right"] = item["view"] in effect.views
    return ranges


def where_hit(
    first: Mapping[str, Any] | None, effects: Sequence[Mapping[str, Any]]
) -> bool:
    """Tell whether a view is right for one of the effects and holds half its power.

    Of a delay the range must hold the delay that explains most of the effect, or lie
    within half of it and twice.

    Parameters
    ----------
    first : mapping or None
        The first entry of ``where`` in gap.json.
    effects : sequence of mapping
        The truth's effects.
    """
    return first is not None and any(_right(first, effect) for effect in effects)


def _right(view: Mapping[str, Any], effect: Mapping[str, Any]) -> bool:
    places = {place["view"]: place for place in effect["where"]}
    place = places.get(view["view"])
    if place is None or not place["right"]:
        return False
    if view["view"] == "unexplained" and view["unit"] == "s":
        # a drift shows over time, a tone over frequency
        place = places["slow-time"]
    return share_held(view, place) >= HALF


def share_held(view: Mapping[str, Any], place: Mapping[str, Any]) -> float:
    """Tell which share of an effect's power lies in a view's range.

    Parameters
    ----------
    view : mapping
        With ``from`` and ``to``: numbers, or names of branches or records.
    place : mapping
        The truth's entry of the same view.
    """
    ends = view["from"], view["to"]
    if isinstance(place.get("shares"), Mapping):
        names = list(place["shares"])
        if any(end not in names for end in ends):
            return 0.0
        first, last = sorted(names.index(end) for end in ends)
        return float(sum(place["shares"][name] for name in names[first : last + 1]))
    if any(isinstance(end, str) for end in ends):
        return 0.0
    low, high = sorted(map(float, ends))
    if "value" in place:
        inside = low <= place["value"] <= high
        within = place["from"] <= low and high <= place["to"]
        return 1.0 if inside or within else 0.0
    if place["view"] == "amplitude" and _MAGNITUDE.search(view["axis"]):
        # both signs of the input, and zero once
        return held(place, max(low, 0.0), high) + held(place, -high, -max(low, 0.0))
    return held(place, low, high)


def held(view: Mapping[str, Any], low: float, high: float) -> float:
    """Tell which share of an effect's power a range holds.

    Parameters
    ----------
    view : mapping
        One of what :func:`where` gives, with ``edges`` and ``shares``.
    low, high : float
        The range, in the view's unit; a bin that lies partly in it counts by its part.
    """
    edges = np.asarray(view["edges"])
    start, stop = edges[:-1], edges[1:]
    inside = np.clip(np.minimum(stop, high) - np.maximum(start, low), 0.0, None)
    return float(np.asarray(view["shares"]) @ (inside / (stop - start)))


def _spectrum(difference: FloatArray, dt: float) -> FloatArray:
    """Power in the bins of frequency, by Parseval's sum."""
    n = len(difference)
    lines = np.abs(np.fft.rfft(difference)) ** 2 / n
    lines[1 : (n + 1) // 2] *= 2.0
    counts, _ = np.histogram(np.fft.rfftfreq(n, dt), FREQUENCY_EDGES, weights=lines)
    return np.asarray(counts)


def _range(
    view: str, axis: str, unit: str, edges: FloatArray, shares: FloatArray
) -> dict[str, Any]:
    low, high = shortest(shares)
    return {
        "view": view,
        "axis": axis,
        "unit": unit,
        "from": float(edges[low]),
        "to": float(edges[high]),
        "share": float(shares[low:high].sum()),
        "edges": [float(f"{edge:.5g}") for edge in edges],
        "shares": [float(f"{share:.5g}") for share in shares],
    }


def shortest(shares: FloatArray) -> tuple[int, int]:
    """Find the fewest neighbouring bins that hold half; of equals, the fullest."""
    sums = np.concatenate([[0.0], np.cumsum(shares)])
    for count in range(1, len(shares) + 1):
        held = sums[count:] - sums[:-count]
        best = int(np.argmax(held))
        if held[best] >= HALF * sums[-1]:
            return best, best + count
    return 0, len(shares)


def _names(view: str, shares: dict[str, float]) -> dict[str, Any]:
    """Fewest names that hold half of the power, the fullest first."""
    order = sorted(shares, key=lambda name: -shares[name])
    chosen: list[str] = []
    while sum(shares[name] for name in chosen) < HALF and len(chosen) < len(order):
        chosen.append(order[len(chosen)])
    return {
        "view": view,
        "axis": view,
        "unit": "",
        "names": chosen,
        "share": sum(shares[name] for name in chosen),
        "shares": shares,
    }


def _delay(
    records: list[Record],
    differences: list[FloatArray],
    outputs: list[FloatArray],
    total: float,
) -> dict[str, Any]:
    """Delay that explains most of the difference, ``d = -delay * dy/dt``."""
    across, square = 0.0, 0.0
    for record, difference, y in zip(records, differences, outputs, strict=True):
        slope = np.gradient(y, record.dt)
        across -= float(difference @ slope)
        square += float(slope @ slope)
    delay = across / square
    ends = sorted((0.5 * delay, 2.0 * delay))
    return {
        "view": "delay",
        "axis": "delay",
        "unit": "s",
        "from": ends[0],
        "to": ends[1],
        "value": delay,
        "share": across**2 / square / total,
    }

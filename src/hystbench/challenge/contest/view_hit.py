"""Whether a solver looked in the right place: its first view against the truth."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from hystbench.challenge.where import HALF, held

#: An amplitude's axis may be the input, or its magnitude.
_MAGNITUDE = re.compile(r"magnitude|abs|\|")


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
    if isinstance(place.get("shares", None), Mapping):
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
    if place["unit"] == "s":
        # the last bin holds all that came later
        last_edge = place["edges"][-1]
        high = high if high < last_edge else last_edge
    if place["view"] == "amplitude" and _MAGNITUDE.search(view["axis"]):
        # both signs of the input, and zero once
        return held(place, max(low, 0.0), high) + held(place, -high, -max(low, 0.0))
    return held(place, low, high)

"""Where a model does less on hold-out records than on those that it was fitted to.

``content`` is what gap.json holds, in every function.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from hystbench.gap.effects import effects
from hystbench.gap.effects.effect import Effect
from hystbench.gap.locate.along_axes import RECORDS_TOLD
from hystbench.gap.naming.ladder import RETUNED
from hystbench.gap.thresholds import AS_GOOD

ONLY_FITTED = 0.15
"""Share of the gap's power that is gone on fit records alone, to be told."""
WORTH_A_REASON = 0.05
"""Share that what is new in every record takes, to be named as a reason."""


def shortfall(content: Mapping[str, Any]) -> dict[str, Any] | None:
    """Compare what is gone on the hold-out records with what is gone on the fit ones.

    Returns
    -------
    dict or None
        ``fit`` and ``hold_out``, the shares of the power above the floor that are
        gone (None where there was none), and a ``sentence``; None where the hold-out
        records keep the promise and no effect widens the gap there.
    """
    promised, kept = content["fit"]["explained"], kept_share(content)
    sentences = [_less(content, promised, kept), *_widens(content)]
    told = " ".join(sentence for sentence in sentences if sentence)
    return {"fit": promised, "hold_out": kept, "sentence": told} if told else None


def kept_share(content: Mapping[str, Any]) -> float | None:
    """Give the share that is gone there; of a range the most, as it may be that."""
    kept = content["gap"]["explained"]
    return kept if kept is None or isinstance(kept, int | float) else max(kept)


def _less(
    content: Mapping[str, Any], promised: float | None, kept: float | None
) -> str:
    """Say by how much less is gone than was promised, and why."""
    names = [item["name"] for item in content["effects"]]
    if not names or promised is None or kept is None or promised - kept < ONLY_FITTED:
        return ""
    sentence = (
        f"On the fit records {100 * promised:.0f} % of the gap's power above the noise "
        f"floor is gone, on the hold-out records {100 * kept:.0f} %"
    )
    reasons = [
        *_runs_away(content),
        *_new_in_every_record(content, names),
        *_outside(content),
    ]
    if reasons:
        sentence += f": {'; '.join(reasons)}"
    return f"{sentence}."


def _widens(content: Mapping[str, Any]) -> list[str]:
    """Say which step down the ladder is a step up on the hold-out records."""
    return [
        f"On the hold-out records {_step_words(step['name'])} widens the gap, from "
        f"{last['rms']:.3g} to {step['rms']:.3g} {content['unit']}."
        for last, step in steps_up(content)
    ]


def _step_words(name: str) -> str:
    return "re-tuning the base" if name == RETUNED else name


def steps_up(content: Mapping[str, Any]) -> list[tuple[Any, Any]]:
    """Give the steps of the ladder that widen the gap, each with the one before."""
    return [
        (last, step)
        for last, step in pairwise(content["ladder"])
        if last["rms"]
        and step["rms"]
        and step["rms"] ** 2 > (1 + AS_GOOD) * last["rms"] ** 2
    ]


def _runs_away(content: Mapping[str, Any]) -> list[str]:
    found = []
    for what, refused in (("diverges", False), ("cannot be run", True)):
        names = [
            item["record"]
            for item in content.get("runs_away", [])
            if (item["refused"] is not None) is refused
        ]
        found += [f"the model {what} on {' and '.join(names)}"] if names else []
    return found


def _new_in_every_record(content: Mapping[str, Any], names: list[str]) -> list[str]:
    share = content["fit"]["new_in_every_record"]
    beside = [name for name in names if is_beside(effects()[name])]
    if share < WORTH_A_REASON or not beside:
        return []
    return [
        f"{100 * share:.0f} % of it was taken by {' and '.join(beside)}, which is new "
        "in every record and predicts no other"
    ]


def is_beside(effect: Effect) -> bool:
    """Tell whether an effect can be a signal beside the chain."""
    return type(effect).describe is not Effect.describe


def _outside(content: Mapping[str, Any]) -> list[str]:
    records = (content.get("black_box") or {}).get("records", [])
    alike: dict[str, list[str]] = {}
    for item in records:
        if item["outside"]:
            alike.setdefault(" and ".join(item["outside"]), []).append(item["name"])
    return [
        f"{' and '.join(names)} {'lies' if len(names) == 1 else 'lie'} outside the fit "
        f"records in {how}"
        if len(names) <= RECORDS_TOLD
        else f"{len(names)} records lie outside the fit records in {how}"
        for how, names in alike.items()
    ]

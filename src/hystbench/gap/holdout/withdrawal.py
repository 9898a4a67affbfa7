"""What hold-out records do to a decision: they lead its reason, or take names back.

They choose nothing. A model that is worse on them than the base goes as a whole: to
keep those of its effects that do better there would be to choose by hold-out records.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hystbench.gap.naming.built_in import BuiltIn
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.vocabulary import Vocabulary

LEAST = 5e-4
"""Share that is told as none: it would read 0.0 %."""


def first_figure(content: Mapping[str, Any]) -> str:
    """Say what is gone on the hold-out records, and of what it is a share.

    Parameters
    ----------
    content : mapping
        What gap.json holds.
    """
    gap, unit = content["gap"], content["unit"]
    sizes = f"{gap['before']:.3g} to {gap['after']:.3g} {unit} rms"
    share = gap["explained"]
    if share is None:
        return f"on the hold-out records the base leaves no more than noise: {sizes}"
    ends = share if isinstance(share, list | tuple) else [share]
    told = " to ".join(dict.fromkeys(f"{100 * end:.1f} %" for end in ends))
    if max(ends) < LEAST:
        told = "none"
    return (
        f"on the hold-out records {told} of the gap's power above the noise floor is "
        f"gone, {sizes}"
    )


def withdrawal(content: Mapping[str, Any]) -> dict[str, Any] | None:
    """Tell what the hold-out records take back, if the model is worse on them.

    Parameters
    ----------
    content : mapping
        What gap.json would hold if nothing were taken back.

    Returns
    -------
    dict or None
        ``withdrawn`` of gap.json: ``names``, empty where only the base was re-tuned;
        ``verdict`` and ``effects`` as the fit records decided; ``before`` and
        ``after``, RMS on the hold-out records together, and of each in ``records``;
        ``why``.
    """
    gap, unit = content["gap"], content["unit"]
    before, after = gap["before"], gap["after"]
    if after is not None and after**2 <= (1 + UNNAMED_SHARE) * before**2:
        return None
    names = [item["name"] for item in content["effects"]]
    what = " and ".join(names) or "the re-tuning of the base"
    if after is None:
        lost = " and ".join(item["record"] for item in content["runs_away"])
        shown = f"with it the model cannot be run to the end of {lost}"
    else:
        shown = (
            f"with it the gap grows there, from {before:.3g} to {after:.3g} {unit} rms"
        )
    return {
        "names": names,
        "verdict": content["verdict"],
        "effects": content["effects"],
        "before": before,
        "after": after,
        "records": [
            {key: item[key] for key in ("name", "before", "after")}
            for item in content["records"]
        ],
        "why": f"the hold-out records take {what} back: {shown}, so that the model "
        "stays the base as it was given",
    }


def without_names(
    content: Mapping[str, Any], taken: Mapping[str, Any]
) -> dict[str, Any]:
    """Give what gap.json holds once names are withdrawn."""
    numbers = {
        name: item | {"after": item["before"]}
        for name, item in content["base_parameters"].items()
    }
    no_gap = taken["verdict"] == "no-gap"  # of the base re-tuned: there was no name
    return {
        **content,
        "verdict": "no-gap" if no_gap else "unnamed",
        "reason": content["reason"] if no_gap else taken["why"],
        "effects": [],
        "withdrawn": dict(taken),
        "base_parameters": numbers,
    }


def with_what_was_asked(
    content: Mapping[str, Any], vocabulary: Vocabulary
) -> dict[str, Any]:
    """Tell in the reason which effects the user put in or left out.

    Parameters
    ----------
    content : mapping
        What gap.json holds.
    vocabulary : Vocabulary
    """
    words = vocabulary.words()
    if not words:
        return dict(content)
    reason = "; ".join([content["reason"], *words])
    return {**content, "reason": reason, "asked": vocabulary.mapping()}


def with_built_in(
    content: Mapping[str, Any], built_in: BuiltIn, alone: float
) -> dict[str, Any]:
    """Tell what the effects that the user put in do, apart from what was found.

    Parameters
    ----------
    content : mapping
        What gap.json holds; its ``gap`` begins with the effects that were put in.
    built_in : BuiltIn
    alone : float
        RMS residual of the simulator without them on the hold-out records.
    """
    names = " and ".join(built_in.names)
    first, *rest = content["ladder"]
    after, unit = content["gap"]["before"], content["unit"]
    told = {
        "effects": list(built_in.effects),
        "before": alone,
        "after": after,
        "sentence": (
            f"You put {names} into the simulator; on the hold-out records the residual "
            f"of the simulator alone is {alone:.3g} {unit} rms, with {names} "
            f"{after:.3g} {unit}. Nothing of that counts as found."
        ),
    }
    ladder = [
        {"name": first["name"], "rms": alone},
        {"name": f"{names} (you put it in)", "rms": after},
        *rest,
    ]
    return {**content, "built_in": told, "ladder": ladder}

"""Parameters that a solver recovers, where the hidden form is the vocabulary's."""

from collections.abc import Mapping, Sequence
from statistics import NormalDist, median
from typing import Any

from hystbench.challenge.contest import table

#: Half the width of a 95 % interval, in standard errors.
HALF_WIDTH = NormalDist().inv_cdf(0.975)


def recovered(
    hidden: Sequence[Mapping[str, Any]], named: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """Compare the parameters of effects that are hidden and named.

    Parameters
    ----------
    hidden : sequence of mapping
        The truth's effects.
    named : sequence of mapping
        The effects of gap.json.

    Returns
    -------
    dict
        As a judged case has them: how many ``parameters`` there are with a true value,
        ``intervals`` with a standard error, and ``covered``, those whose 95 % interval
        holds the truth; and ``parameter_error``, the median relative error.
    """
    errors, intervals, covered = [], 0, 0
    by_name = {effect["name"]: effect for effect in named}
    for effect in hidden:
        answer = by_name.get(effect["name"])
        if answer is None:
            continue
        # diffusion into a slab and into a rod of one time constant differ
        choices = {_word(name, answer) for name in ("geometry", "form")}
        if choices - {None, effect["form"]}:
            continue
        forms = table("comparable").get(effect["name"], {})
        for name in forms.get(effect["form"], ()):
            for true, value, error in _pairs(name, effect, answer):
                errors.append(abs(value - true) / abs(true))
                if error is not None:
                    intervals += 1
                    covered += abs(value - true) <= HALF_WIDTH * error
    return {
        "parameters": len(errors),
        "intervals": intervals,
        "covered": covered,
        "parameter_error": median(errors) if errors else None,
    }


def _word(name: str, answer: Mapping[str, Any]) -> str | None:
    """Give the word that an answer has for a choice; None where it has none."""
    said = answer["parameters"].get(name)
    return None if said is None else str(said["value"])


def _pairs(
    name: str, effect: Mapping[str, Any], answer: Mapping[str, Any]
) -> list[tuple[float, float, float | None]]:
    """Give true value, value and standard error of each number of a parameter."""
    if name not in answer["parameters"] or name not in effect["parameters"]:
        return []
    said = answer["parameters"][name]
    units = effect.get("units", {}).get(name), said.get("unit")
    if None not in units and units[0] != units[1]:
        return []  # a law of the field and one behind the loop
    true = _list(effect["parameters"][name])
    values = _list(said["value"])
    errors = _list(said["standard_error"])
    if len(values) != len(true) or any(isinstance(value, str) for value in values):
        return []
    if len(errors) != len(values):
        errors = [None] * len(values)
    rows = zip(true, values, errors, strict=True)
    return [
        (float(t), float(v), None if e is None else float(e))
        for t, v, e in rows
        if t and v is not None
    ]


def _list(value: Any) -> list[Any]:
    return list(value) if isinstance(value, list | tuple) else [value]

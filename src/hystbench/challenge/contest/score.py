"""One case judged: an answer against the truth."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from math import isfinite
from pathlib import Path
from statistics import NormalDist, median
from typing import Any

from hystbench.challenge.contest import table
from hystbench.challenge.plant.effects import MACHINES
from hystbench.challenge.where import where_hit
from hystbench.errors import InputError
from hystbench.files import write_csv
from hystbench.schema import check_against_schema

#: Beside a plant of another family than the base's it is no name.
FREE_SHAPE = "hysteresis-shape"
#: What tables can hold: names are parted by spaces there.
NAME_OF_EFFECT = re.compile("[a-z0-9-]+")
#: Numbers beyond it are no measurement, and their squares no numbers.
LARGEST_NUMBER = 1e100
#: Half the width of a 95 % interval, in standard errors.
HALF_WIDTH = NormalDist().inv_cdf(0.975)
#: Says which members of a set the judge's own fits find within the noise.
Confirm = Callable[[tuple[str, ...]], tuple[str, ...]]


@dataclass(frozen=True)
class Row:
    """A case in the table; None where a figure means nothing for the case.

    ``hysteresis-shape`` beside a plant of another family than the base's is neither
    required nor spurious: it is taken out before anything is judged. Figures called
    ``strict`` are without this.

    Parameters
    ----------
    ratio_db, ratio_retuned_db : float or None
        Of the effect that shows least; the second after the best re-tuning of gain
        and offset.
    truth, named : str
        Names with a space between, in the order hidden and named.
    verdict : str
        Empty where the case is lost; ``named`` also where all effects are findings,
        told beside unnamed as they are new in every record.
    lost : str
        Why there is no answer; empty where there is one.
    confidence, confidences : float or None, str
        Of the first effect named; of each, as ``name=confidence``.
    top1 : bool or None
        Of single effects: named, and named first.
    in_set, set_size : bool or None, int or None
        Of single effects: in the set of the first effect named, and the names in it.
        They count what the judge's own fits find within the noise, ``raw`` all.
    exact : bool
        What is hidden is named and nothing beside it; with nothing hidden: no-gap;
        outside the vocabulary: unnamed.
    all_named : bool or None
        All hidden effects of the vocabulary are named.
    false_alarm : bool or None
        With nothing hidden: any answer but no-gap.
    unnamed : bool or None
        Outside the vocabulary: the verdict is unnamed, and no finding accounts for it.
    where_hit : bool or None
        None in a machine, whose truth tells no view.
    place_right : bool or None
        Of single effects in a machine: what is named first is put where it acts: before
        the dynamics, inside them or behind.
    shrink : float or None
        Share of the power above the noise and the base's own error that is gone from
        the hold-out records.
    parameters, intervals, covered, parameter_error
        As :func:`recovered` gives them.
    """

    solver: str
    case: str
    seed: int
    kind: str
    family: str
    ratio_db: float | None
    ratio_retuned_db: float | None
    truth: str
    form: str
    verdict: str
    named: str
    lost: str
    confidence: float | None
    confidences: str
    top1: bool | None
    top1_strict: bool | None
    in_set: bool | None
    in_set_raw: bool | None
    set_size: int | None
    set_size_raw: int | None
    exact: bool
    exact_strict: bool
    all_named: bool | None
    false_alarm: bool | None
    false_alarm_strict: bool | None
    unnamed: bool | None
    where_hit: bool | None
    place_right: bool | None
    shrink: float | None
    parameters: int
    intervals: int
    covered: int
    parameter_error: float | None
    seconds: float
    cpu_seconds: float


COLUMNS = tuple(item.name for item in fields(Row))


def judge_answer(
    solver: str,
    case: str,
    truth: Mapping[str, Any],
    answer: Mapping[str, Any],
    schema: Mapping[str, Any],
    confirm: Confirm,
) -> Row:
    """Judge an answer.

    Parameters
    ----------
    solver, case : str
    truth : mapping
        As docs/challenge.md tells.
    answer : mapping
        An entry of a solver's answers.
    schema : mapping
        Of gap.json; an answer that does not keep it loses the case.
    confirm : callable
        Gives the members of a set that fit within the noise; asked only where a set
        has more than one.
    """
    lost = _why_lost(answer, schema)
    gap: Mapping[str, Any] = _NOTHING if lost else answer["gap"]
    kind, machine = truth["kind"], truth["family"] in MACHINES
    foreign = truth["family"] != "gpi" and not machine
    hidden = [effect["name"] for effect in truth["effects"]]
    strict = [effect["name"] for effect in gap["effects"]]
    tolerated = foreign and FREE_SHAPE not in hidden
    effects = [e for e in gap["effects"] if not (tolerated and e["name"] == FREE_SHAPE)]
    named = [effect["name"] for effect in effects]
    single, one = kind == "single", effects[0] if effects else None
    # An answer is one thing: names beside another verdict than this name nothing.
    names = gap["verdict"] == "named"
    members = (
        tuple(dict.fromkeys([one["name"], *one["cannot_be_told_from"]]))
        if one and names
        else ()
    )
    if tolerated:
        members = tuple(name for name in members if name != FREE_SHAPE)
    confirmed = confirm(members) if single and len(members) > 1 else members
    # An effect outside the vocabulary has no name to be called by.
    shape_alone = kind == "none" and names and bool(strict) and not named
    right = shape_alone or _right(kind, hidden, gap["verdict"], named)
    right_strict = _right(kind, hidden, gap["verdict"], strict)
    views = gap["where"]
    retuned = [effect["ratio_retuned_db"] for effect in truth["effects"]]
    return Row(
        solver=solver,
        case=case,
        seed=truth["seed"],
        kind=kind,
        family=truth["family"],
        ratio_db=truth["ratio_db"],
        ratio_retuned_db=min((x for x in retuned if x is not None), default=None),
        truth=" ".join(hidden),
        form=" ".join(effect["form"] for effect in truth["effects"]),
        verdict=gap["verdict"],
        named=" ".join(strict),
        lost=lost,
        confidence=one["confidence"] if one else None,
        confidences=" ".join(f"{e['name']}={e['confidence']:g}" for e in effects),
        top1=names and named[:1] == hidden if single else None,
        top1_strict=names and strict[:1] == hidden if single else None,
        in_set=hidden[0] in confirmed if single else None,
        in_set_raw=hidden[0] in members if single else None,
        set_size=len(confirmed) if single and members else None,
        set_size_raw=len(members) if single and members else None,
        exact=right,
        exact_strict=right_strict,
        all_named=names and set(hidden) <= set(named)
        if hidden and kind != "unlisted"
        else None,
        false_alarm=not right if kind == "none" else None,
        false_alarm_strict=not right_strict if kind == "none" else None,
        unnamed=gap["verdict"] == "unnamed" if kind == "unlisted" else None,
        where_hit=where_hit(views[0] if views else None, truth["effects"])
        if hidden and not machine
        else None,
        place_right=names
        and one is not None
        and one["place"] in PLACE_WORDS[truth["effects"][0]["place"]]
        if single and machine
        else None,
        shrink=_shrink(truth, gap["gap"]) if hidden else None,
        **recovered(truth["effects"], effects),
        seconds=answer["seconds"],
        cpu_seconds=answer["cpu_seconds"],
    )


def write_rows(path: Path, rows: Iterable[Row]) -> None:
    """Write judged cases as CSV; what means nothing for a case is an empty cell."""
    write_csv(path, COLUMNS, (astuple(row) for row in rows))


_NOTHING: dict[str, Any] = {"verdict": "", "effects": [], "where": [], "gap": None}


def _why_lost(answer: Mapping[str, Any], schema: Mapping[str, Any]) -> str:
    if answer["status"] != "answered":
        return str(answer["status"])
    if _too_large(answer["gap"]):
        return f"gap.json: a number beyond {LARGEST_NUMBER:g}"
    try:
        check_against_schema(answer["gap"], schema, "gap.json")
    except InputError as error:
        return str(error)[:300]
    effects = answer["gap"]["effects"]
    names = [effect["name"] for effect in effects]
    for name in (*names, *(tie for e in effects for tie in e["cannot_be_told_from"])):
        if not NAME_OF_EFFECT.fullmatch(name):
            return f"gap.json: effects: {name[:40]!r}; expected letters a-z, digits, -"
    for effect in effects:
        for key, said in effect["parameters"].items():
            for part in ("value", "standard_error"):
                if not _numbers(said[part]):
                    told = f"gap.json: effects: {effect['name']}: {key[:40]!r}: {part}"
                    return f"{told}; expected numbers or null in the list"
    if answer["gap"]["verdict"] == "named" and not names:
        return "gap.json: verdict named without an effect"
    if answer["gap"]["verdict"] in ("no-gap", "parameters") and names:
        return f"gap.json: verdict {answer['gap']['verdict']} with effects named"
    return ""


def _too_large(content: Any) -> bool:
    """Tell whether a number anywhere in it is too large to reckon with."""
    left = [content]
    while left:
        item = left.pop()
        if isinstance(item, dict | list):
            left += item.values() if isinstance(item, dict) else item
        elif isinstance(item, int | float) and abs(item) > LARGEST_NUMBER:
            return True
    return False


def _numbers(value: Any) -> bool:
    """Tell whether a list holds finite numbers or null; what is no list may pass."""
    return not isinstance(value, list) or all(
        item is None or (type(item) in (int, float) and isfinite(item))
        for item in value
    )


def _right(kind: str, hidden: list[str], verdict: str, named: list[str]) -> bool:
    """Tell whether an answer is right, and nothing beside it is named."""
    if kind == "none":
        return verdict == "no-gap"
    if kind == "unlisted":
        return verdict == "unnamed" and not named
    return verdict == "named" and sorted(named) == sorted(hidden)


#: Words of gap.json for each place; a force beside an impedance is one inside it.
PLACE_WORDS = {
    "before": ("before", "drive"),
    "inside": ("inside", "beside", "around"),
    "behind": ("behind", "sensor"),
}


def _shrink(truth: Mapping[str, Any], gap: Mapping[str, Any] | None) -> float | None:
    """Share of the explainable power that is gone; 0 where there is no answer.

    What can be explained is what the solver itself measures before, less the noise
    and the base's own error, of which the judge knows the true size. Nothing can be
    said where that leaves less than a tenth of the effects' power.
    """
    if gap is None:
        return 0.0
    hold_out = truth["hold_out"]
    below = truth["noise_rms"] ** 2 + hold_out["base_error_rms"] ** 2
    explainable = gap["before"] ** 2 - below
    if explainable <= 0.1 * hold_out["explainable_rms"] ** 2:
        return None
    if gap["after"] is None:  # the model runs away on a record: nothing is closed
        return 0.0
    return float((gap["before"] ** 2 - gap["after"] ** 2) / explainable)


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
        told = [answer["parameters"].get(name) for name in ("geometry", "form")]
        if {str(said["value"]) for said in told if said} - {effect["form"]}:
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

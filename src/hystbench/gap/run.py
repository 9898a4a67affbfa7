"""``hystbench gap``: decide on the fit records, then show the hold-out records once.

In one process, or as two jobs of which the first has no hold-out file among its inputs.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.blocks.simulator import Simulator
from hystbench.command_files import writes
from hystbench.cores import on_cores
from hystbench.files import read_json, whole_folder, write_columns, write_json
from hystbench.gap.asked import Asked
from hystbench.gap.bases.gpi import IdentifiedGpi
from hystbench.gap.bases.lead import begun_beside, without_leads
from hystbench.gap.bases.linear import IdentifiedModel, is_identified_linear
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.on_records import compared_records, run_base, start_state
from hystbench.gap.fitting.own_steps import too_long_steps
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.serialize import state_mapping, state_of
from hystbench.gap.holdout.scored import Outcome
from hystbench.gap.holdout.withdraw import Decided, show_on_hold_out
from hystbench.gap.inside.named_inside import quantities_if_linear
from hystbench.gap.judge_and_tell import Decision
from hystbench.gap.naming.built_in import BuiltIn, build_in
from hystbench.gap.naming.forecast_calls import reserve_calls
from hystbench.gap.naming.ladder import FitResult, Rung
from hystbench.gap.observed import model_without_damper, with_observer
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.black_box import black_box
from hystbench.gap.records.evidence import Evidence, check_units
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.observer import observed
from hystbench.gap.search import search
from hystbench.gap.vocabulary import Vocabulary, say_in_words, with_device
from hystbench.model import Model
from hystbench.record import Channel, Record

DECISIVE = ("gap.json", "model.yaml")
"""Written after the hold-out records were read: these may take names back."""
SHOWN = (*DECISIVE, "holdout/*.csv")
"""The same with the records themselves."""
FILES = (*DECISIVE, "curves.json", "report.html")
RESULT = (*FILES, "holdout/*.csv")
"""Files of a folder, as names or patterns, that a later result replaces."""


@dataclass(frozen=True)
class Closed:
    """A gap that was searched and shown on hold-out records; nothing is written yet."""

    decision: Decision
    outcome: Outcome
    """The decision after the hold-out records were read."""
    evidence: Evidence

    def write(self, folder: Path, report: bool = True) -> None:
        """Write gap.json, model.yaml, curves.json, holdout/ and the page.

        Parameters
        ----------
        folder : Path
            Gets them all together when the last is done. Those of an earlier result
            go; any other file stays.
        report : bool
            Whether to write the page.

        Raises
        ------
        InputError
            If a file that hystbench did not write, or an input, stands in the way;
            nothing is written then.
        """
        with whole_folder(folder, RESULT) as fresh:
            write_json(fresh / "curves.json", self.decision.curves)
            write_shown(fresh, self.evidence.hold_out, self.outcome)
            if report:
                from hystbench.gap.report.page import write_report  # late: it draws

                write_report(fresh)


def will_write(
    folder: Path, evidence: Evidence, files: tuple[str, ...] = FILES
) -> None:
    """Refuse a folder in which a result cannot stand, before the search is paid."""
    tables = (f"holdout/{record.name}.csv" for record in evidence.hold_out)
    writes(*(folder / name for name in (*files, *tables)))


def closed_gap(
    evidence: Evidence, base: Model, asked: Asked, place: str = "model"
) -> Closed:
    """Find what the base lacks, and show on hold-out records how the gap shrinks.

    Parameters
    ----------
    evidence : Evidence
    base : Model
    asked : Asked
    place : str
        Where the base came from, for messages.

    Raises
    ------
    InputError
        If units do not match, the base does not run, or an effect cannot be put in.
    """
    check_units(evidence, base, place)
    # Whether the base runs on the inputs held out is known before the search is paid.
    run_base(base, evidence.hold_out, evidence.input_hold)
    reserve_calls(evidence)
    decision, decided = decide(evidence, base, asked)
    evidence, outcome = show(evidence, decided, asked.say)
    return Closed(decision, outcome, evidence)


def decide(evidence: Evidence, base: Model, asked: Asked) -> tuple[Decision, Decided]:
    """Put in what is asked for, and find what the fit records say is missing.

    The search is given no other records. Where nothing can be named beside a linear
    base that was identified, an observer is tried.
    """
    vocabulary = asked.vocabulary.in_device(evidence.device_kind)
    asked = replace(asked, vocabulary=vocabulary, say=say_in_words(asked.say))
    if any(isinstance(block, Simulator) for block in base.chain):
        # What calls a user's function counts them, and keeps what they gave.
        with on_cores(1):
            return _decide(evidence.deciding, base, asked)
    found = _decide(evidence.deciding, base, asked)
    unsettled = found[0].content["verdict"] == "unnamed"
    if not unsettled or not is_identified_linear(base) or vocabulary.fixed:
        return found
    return with_observer(evidence.deciding, _decide, asked, found[1]) or found


def _decide(evidence: Evidence, base: Model, asked: Asked) -> tuple[Decision, Decided]:
    """Find what is missing on records as they are."""
    vocabulary = asked.vocabulary
    begun = begun_beside(base, evidence.fit)
    fit = without_leads(begun, base, evidence, asked.say)
    evidence = replace(evidence, fit=fit)
    first = base
    base, built_in = build_in(base, evidence, vocabulary.fixed, asked.say)
    quantities = quantities_if_linear(base, evidence)
    share = asked.unnamed_share
    steps = too_long_steps(first, fit, evidence.input_hold, share)
    # A trial may run away: it is judged by what it leaves.
    with np.errstate(over="ignore", invalid="ignore"):
        decision = search(evidence, base, asked, quantities)
    warnings = [*steps, *decision.content["warnings"]]
    content = {**decision.content, "warnings": warnings}
    content = with_device(content, evidence.device_kind, evidence.quantities)
    decision = replace(decision, content=content)
    return decision, Decided(first, decision, content, vocabulary, built_in)


def show(
    evidence: Evidence, decided: Decided, say: Say = silent
) -> tuple[Evidence, Outcome]:
    """Compare what was found with the hold-out records, for the first time.

    They choose nothing, and may take back what was named.

    Returns
    -------
    evidence : Evidence
        Without the leads of hold-out records that begin in the middle of a motion, and
        without what was put before others.
    outcome : Outcome
    """
    found = _shown(evidence, decided, say)
    if decided.plain is not None and found[1].content["withdrawn"]:
        return _shown(evidence, decided.plain, say)
    return found


def _shown(evidence: Evidence, decided: Decided, say: Say) -> tuple[Evidence, Outcome]:
    """Compare one decision with the hold-out records."""
    own = say_in_words(say)
    evidence = observed(evidence, decided.damper)
    evidence = hold_out_begun_like_fit(evidence, decided.first, decided.fitted, own)
    outcome = show_on_hold_out(decided, evidence)
    model = model_without_damper(outcome.model, decided.damper)
    outcome = replace(outcome, model=model)
    measured = tuple(record.as_measured for record in evidence.hold_out)
    return replace(evidence, hold_out=measured), outcome


def hold_out_begun_like_fit(
    evidence: Evidence, base: Model, found: FitResult, say: Say = silent
) -> Evidence:
    """Leave out the leads of hold-out records, as of fit records.

    They are asked for beside the base, and again beside what was found: the base's own
    error may hide a start. Beside another base a steady motion gets its past.
    """
    if not is_identified_linear(base):
        return replace(evidence, hold_out=begun_beside(base, evidence.hold_out))
    records = evidence.hold_out
    for model in (None, augmented(found.base, found.state)):
        records = without_leads(records, base, evidence, say, found=model)
    return replace(evidence, hold_out=records)


def write_shown(folder: Path, records: tuple[Record, ...], outcome: Outcome) -> None:
    """Write gap.json, model.yaml and the hold-out records before and after."""
    names = ("time_s", "measured", "before", "after")
    for record, outputs in zip(records, outcome.outputs, strict=True):
        signals = (record.time, record.y, *outputs)
        columns = {name: x.tolist() for name, x in zip(names, signals, strict=True)}
        # Nine digits are more than any instrument has, and half of a double's bytes.
        write_columns(folder / "holdout" / f"{record.name}.csv", columns, 9)
    outcome.model.save(folder / "model.yaml")
    write_json(folder / "gap.json", outcome.content)


def write_next_experiment(decision: Decision, channel: Channel, path: Path) -> str:
    """Write the excitation that tells likely effects apart; say if there is none.

    The channel is the input's; the path that of a CSV file, or of an archive by its
    suffix ``.npz``.
    """
    if decision.experiment is None:
        needless = "no effects that were tried need to be told apart"
        why = decision.content.get("no_experiment", needless)
        return f"{path}: not written: {why}"
    decision.experiment.excitation.write(channel, path)
    return f"{path}: {decision.experiment.sentence}"


BASE = "stages/base.yaml"
DECISION = "stages/decision.json"
NAMED = "stages/named.json"
DECIDED_FILES = ("curves.json", BASE, NAMED, DECISION)
"""What the first of the two writes."""
KEPT_BASES: dict[str, type[IdentifiedModel | IdentifiedGpi]] = {
    "identified": IdentifiedModel,
    "hysteresis": IdentifiedGpi,
}
"""Kinds of bases that are kept as they were first, by key."""


def decide_in(folder: Path, evidence: Evidence, base: Model, asked: Asked) -> Decision:
    """Decide on the fit records; write the decision and the curves to a folder."""
    writes(*(folder / name for name in DECIDED_FILES))
    decision, decided = decide(evidence, base, asked)
    kept, plain = _kept(decided), decided.plain
    if plain is not None:  # its base is a linear model
        more = {"content": plain.content, "base": plain.fitted.base.to_mapping()}
        kept["plain"] = _kept(plain) | more
    with whole_folder(folder, DECIDED_FILES) as fresh:
        write_json(fresh / "curves.json", decision.curves)
        decision.base.save(fresh / BASE)
        write_json(fresh / NAMED, kept)
        write_json(fresh / DECISION, decided.content)
    return decision


def _kept(decided: Decided) -> dict[str, Any]:
    """Give what a decision is made again from, but for its base and its content."""
    fitted, built_in = decided.fitted, decided.built_in
    return {
        "floor": asdict(fitted.floor),
        "leads": [record.lead for record in fitted.state.records],
        "state": state_mapping(fitted.state),
        "rungs": [
            {"name": item.name, "state": state_mapping(item.state)}
            for item in fitted.rungs
        ],
        **{
            key: decided.first.to_mapping() if isinstance(decided.first, kind) else None
            for key, kind in KEPT_BASES.items()
        },
        "without": list(decided.vocabulary.without),
        "with": list(decided.vocabulary.fixed),
        "built_in": None if built_in is None else built_in.mapping(),
        "damper": decided.damper,
    }


def show_in(folder: Path, evidence: Evidence, base: Model) -> None:
    """Read the hold-out records; write gap.json, model.yaml and holdout/.

    They choose nothing: a model that is worse there than the base is taken back. The
    folder holds what :func:`decide_in` wrote.
    """
    will_write(folder, evidence, DECISIVE)
    evidence, shown = show(evidence, _decided_in(folder, evidence, base))
    with whole_folder(folder, SHOWN) as fresh:
        write_shown(fresh, evidence.hold_out, shown)


def _decided_in(folder: Path, evidence: Evidence, base: Model) -> Decided:
    """Give back what :func:`decide_in` wrote."""
    kept, content = read_json(folder / NAMED), read_json(folder / DECISION)
    place = str(folder / NAMED)
    decided = _decided_again(kept, content, evidence, base, place)
    if plain := kept.get("plain"):
        alone = Model.from_mapping(plain["base"], f"{place}: plain: base")
        again = _decided_again(plain, plain["content"], evidence, alone, place)
        decided = replace(decided, plain=again)
    return decided


def _decided_again(
    kept: dict[str, Any],
    content: dict[str, Any],
    evidence: Evidence,
    base: Model,
    place: str,
) -> Decided:
    """Make a decision again from what was kept of it."""
    evidence = observed(evidence, kept["damper"])
    floor, own = Floor(**kept["floor"]), OwnValues.of_mapping(content["record_values"])
    first = base
    for key, kind in KEPT_BASES.items():
        if kept[key]:
            first = kind.from_mapping(kept[key], f"{place}: {key}")
    leads = zip(begun_beside(first, evidence.fit), kept["leads"], strict=True)
    fit = tuple(replace(record, lead=lead) for record, lead in leads)
    fit = own.taken_off(fit, evidence.input_hold)
    start, _ = start_state(fit, base, evidence.input_hold, evidence.noise_rms)
    state = state_of(kept["state"], start)
    rungs = tuple(
        Rung(item["name"], state_of(item["state"], start)) for item in kept["rungs"]
    )
    box = black_box(compared_records(start), floor.rms)
    vocabulary = Vocabulary.of(kept["without"], kept["with"])
    vocabulary = vocabulary.in_device(evidence.device_kind)
    built_in = BuiltIn.of_mapping(kept["built_in"]) if kept["built_in"] else None
    fitted = FitResult(base, state, floor, box, rungs, own)
    return Decided(first, fitted, content, vocabulary, built_in, kept["damper"])

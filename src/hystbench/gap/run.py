"""``hystbench gap``: decide on the fit records, then show the hold-out records once.

All in one process; ``stages.py`` does the same as two jobs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hystbench.blocks.simulator import Simulator
from hystbench.command_files import writes
from hystbench.cores import on_cores
from hystbench.files import whole_folder, write_columns, write_json
from hystbench.gap.asked import Asked
from hystbench.gap.bases.free_starts import begun_at_any_level
from hystbench.gap.bases.lead import begun_beside, without_leads
from hystbench.gap.bases.linear import is_identified_linear
from hystbench.gap.decide_with_observer import model_without_damper, with_observer
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.fitting.own_steps import too_long_steps
from hystbench.gap.holdout.scored import Outcome
from hystbench.gap.holdout.withdraw import ToShow, show_on_hold_out
from hystbench.gap.inside.named_inside import quantities_if_linear
from hystbench.gap.judge_and_tell import Decision
from hystbench.gap.naming.forecast_calls import reserve_calls
from hystbench.gap.naming.ladder import FitResult
from hystbench.gap.naming.put_in import with_put_in
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence, check_units
from hystbench.gap.records.observer import with_observer_signal
from hystbench.gap.search import search_and_judge
from hystbench.gap.vocabulary import say_in_words, with_device
from hystbench.model import Model
from hystbench.record import Channel, Record

FINAL_FILES = ("gap.json", "model.yaml")
"""Written after the comparison with the hold-out records, which may take names back."""
SHOWN = (*FINAL_FILES, "holdout/*.csv")
"""The same with the records themselves."""
FILES = (*FINAL_FILES, "curves.json", "report.html")
RESULT = (*FILES, "holdout/*.csv")
"""Files of a folder, as names or patterns, that a later result replaces."""


@dataclass(frozen=True)
class Closed:
    """A gap that was searched and shown on hold-out records; nothing is written yet."""

    decision: Decision
    outcome: Outcome
    """The decision after the comparison with the hold-out records."""
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
    decision, to_show = decide(evidence, base, asked)
    evidence, outcome = show(evidence, to_show, asked.say)
    return Closed(decision, outcome, evidence)


def decide(evidence: Evidence, base: Model, asked: Asked) -> tuple[Decision, ToShow]:
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
    if not unsettled or not is_identified_linear(base) or vocabulary.put_in:
        return found
    return with_observer(evidence.deciding, _decide, asked, found[1]) or found


def _decide(evidence: Evidence, base: Model, asked: Asked) -> tuple[Decision, ToShow]:
    """Find what is missing on records as they are."""
    vocabulary = asked.vocabulary
    begun = begun_beside(base, evidence.fit)
    fit = without_leads(begun, base, evidence, asked.say)
    evidence = replace(evidence, fit=fit)
    first = base
    base, put_in = with_put_in(base, evidence, vocabulary.put_in, asked.say)
    quantities = quantities_if_linear(base, evidence)
    share = asked.unnamed_share
    steps = too_long_steps(first, fit, evidence.input_hold, share)
    # A trial may run away: it is judged by what it leaves.
    with np.errstate(over="ignore", invalid="ignore"):
        decision = search_and_judge(evidence, base, asked, quantities)
    warnings = [*steps, *decision.content["warnings"]]
    content = {**decision.content, "warnings": warnings}
    content = with_device(content, evidence.device_kind, evidence.quantities)
    decision = replace(decision, content=content)
    return decision, ToShow(
        first=first,
        fitted=decision,
        content=content,
        vocabulary=vocabulary,
        put_in=put_in,
    )


def show(
    evidence: Evidence, to_show: ToShow, say: Say = silent
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
    found = _shown(evidence, to_show, say)
    if to_show.plain is not None and found[1].content["withdrawn"]:
        return _shown(evidence, to_show.plain, say)
    return found


def _shown(evidence: Evidence, to_show: ToShow, say: Say) -> tuple[Evidence, Outcome]:
    """Compare one decision with the hold-out records."""
    own = say_in_words(say)
    evidence = with_observer_signal(evidence, to_show.damper)
    evidence = hold_out_begun_like_fit(evidence, to_show.first, to_show.fitted, own)
    outcome = show_on_hold_out(to_show, evidence)
    model = model_without_damper(outcome.model, to_show.damper)
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
    records = begun_beside(base, evidence.hold_out)
    if not is_identified_linear(base):
        return replace(evidence, hold_out=records)
    if evidence.quantities.causality != "storage":
        longest = max(len(record) * record.dt for record in evidence.fit)
        records = begun_at_any_level(records, base, longest)
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

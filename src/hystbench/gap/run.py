"""``hystbench gap``: decide on the fit records, then show the hold-out records once.

In one process, or as two jobs of which the first has no hold-out file among its inputs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from hystbench.blocks.mechanism import Mechanism
from hystbench.files import read_json, whole_folder, write_columns, write_json
from hystbench.gap.bases.lead import without_leads
from hystbench.gap.bases.linear import is_identified
from hystbench.gap.fitting.augmented_model import augmented
from hystbench.gap.fitting.on_records import compared_records, run_base, start_state
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.serialize import Restorer, state_mapping
from hystbench.gap.holdout.outcome import outcome
from hystbench.gap.holdout.show import Outcome
from hystbench.gap.inside.named_inside import quantities_if_linear
from hystbench.gap.judge_and_tell import Decision
from hystbench.gap.judging.black_box import black_box
from hystbench.gap.judging.fit_result import FitResult
from hystbench.gap.naming.built_in import BuiltIn, build_in
from hystbench.gap.naming.forecast_calls import keep_back
from hystbench.gap.naming.ladder import Rung
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence, check_units
from hystbench.gap.records.floor import Floor
from hystbench.gap.search import search
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.vocabulary import EVERYTHING, Vocabulary, say_in_words, with_device
from hystbench.model import Model
from hystbench.record import Channel, FloatArray, Record
from hystbench.written import writes

DECISIVE = ("gap.json", "model.yaml")
"""Written when the hold-out records were read, as these may take names back."""
SHOWN = (*DECISIVE, "holdout/*.csv")
"""The same with the records themselves."""
FILES = (*DECISIVE, "curves.json", "report.html")
RESULT = (*FILES, "holdout/*.csv")
"""Files of a folder, as names or patterns, that a later result replaces."""


@dataclass(frozen=True)
class Closed:
    """A gap that was searched and shown on hold-out records; nothing is written yet.

    Parameters
    ----------
    decision : Decision
        Its ``model`` and ``content`` are those after the hold-out records were read.
    outcome : Outcome
    evidence : Evidence
    """

    decision: Decision
    outcome: Outcome
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
                from hystbench.gap.report import write_report  # late: it draws

                write_report(fresh)


def will_write(folder: Path, evidence: Evidence) -> None:
    """Refuse a folder in which a result cannot stand, before the search is paid."""
    tables = (f"holdout/{record.name}.csv" for record in evidence.hold_out)
    writes(*(folder / name for name in (*FILES, *tables)))


def closed_gap(
    evidence: Evidence,
    base: Model,
    *,
    place: str = "model",
    limits: Mapping[str, float] | None = None,
    unnamed_share: float = UNNAMED_SHARE,
    vocabulary: Vocabulary = EVERYTHING,
    say: Say = silent,
) -> Closed:
    """Find what the base lacks, and show on hold-out records how the gap shrinks.

    Parameters
    ----------
    evidence : Evidence
    base : Model
    place : str
        Where the base came from, for messages.
    limits : mapping of str to float, optional
        What the next experiment may ask of the actuator: ``low``, ``high``, ``rate``.
        What is not given is taken from the fit records.
    unnamed_share : float
        Share of the power of the gap that may stay unnamed beside a name.
    vocabulary : Vocabulary
        Effects that may be named, and those that are in the model from the start.
    say : callable
        Told a line of progress at a time.

    Raises
    ------
    InputError
        If units do not match, the base does not run, or an effect cannot be put in.
    """
    check_units(evidence, base, place)
    # Whether the base runs on the inputs held out is known before the search is paid.
    run_base(base, evidence.hold_out, evidence.input_hold)
    keep_back(evidence)
    decision, built_in = found_on_fit(
        evidence, base, limits, say, unnamed_share, vocabulary
    )
    evidence, result = shown_on_hold_out(
        evidence, base, decision, decision.content, vocabulary, built_in, say
    )
    decision = replace(decision, model=result.model, content=result.content)
    return Closed(decision, result, evidence)


def found_on_fit(
    evidence: Evidence,
    base: Model,
    limits: Mapping[str, float] | None,
    say: Say,
    unnamed_share: float,
    vocabulary: Vocabulary,
) -> tuple[Decision, BuiltIn | None]:
    """Put in what is asked for, and find what the fit records say is missing.

    Parameters are those of :func:`closed_gap`.
    """
    say = say_in_words(say)
    about = base, evidence.input_hold, evidence.quantities, say
    evidence = replace(evidence, fit=without_leads(evidence.fit, *about))
    vocabulary = vocabulary.in_device(evidence.device_kind)
    base, built_in = build_in(base, evidence, vocabulary.fixed, say)
    decision = search(
        evidence.name,
        evidence.fit,
        base,
        evidence.input_hold,
        evidence.noise_rms,
        limits,
        say,
        unnamed_share,
        vocabulary.offered,
        quantities_if_linear(base, evidence),
    )
    return decision, built_in


def shown_on_hold_out(
    evidence: Evidence,
    base: Model,
    fitted: FitResult,
    decided: Mapping[str, Any],
    vocabulary: Vocabulary,
    built_in: BuiltIn | None,
    say: Say = silent,
) -> tuple[Evidence, Outcome]:
    """Compare what was found with the hold-out records, for the first time.

    They choose nothing, and may take back what was named.

    Parameters
    ----------
    evidence : Evidence
    base : Model
        As it was given, or identified: it tells what another state at the first sample
        would do, as what stands for it may hold a place that no record forgets.
    fitted : FitResult
    decided : mapping
        What gap.json holds, but for what the hold-out records show.
    vocabulary : Vocabulary
    built_in : BuiltIn or None
    say : callable

    Returns
    -------
    evidence : Evidence
        Without the leads of hold-out records that begin in the middle of a motion.
    outcome : Outcome
    """
    evidence = as_found(evidence, base, fitted, say_in_words(say))
    vocabulary = vocabulary.in_device(evidence.device_kind)
    return evidence, outcome(fitted, decided, evidence, vocabulary, built_in)


def as_found(
    evidence: Evidence, base: Model, found: FitResult, say: Say = silent
) -> Evidence:
    """Leave out the leads of hold-out records, as of fit records.

    They are asked for beside the base, and again beside forces that stand for it.
    """
    about = base, evidence.input_hold, evidence.quantities, say
    records = without_leads(evidence.hold_out, *about)
    if any(isinstance(block, Mechanism) for block in found.base.chain):
        model = augmented(found.base, found.state)
        records = without_leads(records, *about, model)
    return replace(evidence, hold_out=records)


def write_shown(folder: Path, records: tuple[Record, ...], outcome: Outcome) -> None:
    """Write gap.json, model.yaml and the hold-out records before and after.

    Parameters
    ----------
    folder : Path
    records : tuple of Record
        The hold-out records.
    outcome : Outcome
    """
    for record, (before, after) in zip(records, outcome.outputs, strict=True):
        _write_hold_out(
            folder / "holdout" / f"{record.name}.csv", record, before, after
        )
    outcome.model.save(folder / "model.yaml")
    write_json(folder / "gap.json", outcome.content)


def _write_hold_out(
    path: Path, record: Record, before: FloatArray, after: FloatArray
) -> None:
    signals = (record.time, record.y, before, after)
    names = ("time_s", "measured", "before", "after")
    columns = {name: x.tolist() for name, x in zip(names, signals, strict=True)}
    write_columns(path, columns, 9)


def write_next_experiment(decision: Decision, channel: Channel, path: Path) -> str:
    """Write the excitation that tells likely effects apart, or tell why there is none.

    Parameters
    ----------
    decision : Decision
    channel : Channel
        The input's.
    path : Path
        A CSV file, or an archive by its suffix ``.npz``.

    Returns
    -------
    str
        A line that tells what was done.
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
DECIDED = ("curves.json", BASE, NAMED, DECISION)
"""What the first of the two writes."""


def decide_in(
    folder: Path,
    evidence: Evidence,
    base: Model,
    limits: Mapping[str, float] | None = None,
    say: Say = silent,
    unnamed_share: float = UNNAMED_SHARE,
    vocabulary: Vocabulary = EVERYTHING,
) -> Decision:
    """Decide on the fit records; write the decision and the curves to a folder.

    Parameters
    ----------
    folder : Path
    evidence : Evidence
        Only its fit records are read.
    base : Model
    limits : mapping of str to float, optional
        Of the next experiment; what is not given is taken from the fit records.
    say : callable
        Told a line of progress at a time.
    unnamed_share : float
        Share of the power of the gap that may stay unnamed beside a name.
    vocabulary : Vocabulary
        Effects that may be named, and those that are in the model from the start.
    """
    writes(*(folder / name for name in DECIDED))
    decision, built_in = found_on_fit(
        evidence, base, limits, say, unnamed_share, vocabulary
    )
    content = with_device(decision.content, evidence.device_kind, evidence.quantities)
    decision = replace(decision, content=content)
    kept = {
        "floor": asdict(decision.floor),
        "leads": [record.lead for record in decision.state.records],
        "state": state_mapping(decision.state),
        "rungs": [
            {"name": item.name, "state": state_mapping(item.state)}
            for item in decision.rungs
        ],
        "identified": base.to_mapping() if is_identified(base) else None,
        "without": list(vocabulary.without),
        "with": list(vocabulary.fixed),
        "built_in": None if built_in is None else built_in.mapping(),
    }
    with whole_folder(folder, DECIDED) as fresh:
        write_json(fresh / "curves.json", decision.curves)
        decision.base.save(fresh / BASE)
        write_json(fresh / NAMED, kept)
        write_json(fresh / DECISION, decision.content)
    return decision


def show_in(folder: Path, evidence: Evidence, base: Model) -> None:
    """Read the hold-out records; write gap.json, model.yaml and holdout/.

    They choose nothing: a model that is worse there than the base is taken back.

    Parameters
    ----------
    folder : Path
        With what :func:`decide_in` wrote.
    evidence : Evidence
    base : Model
    """
    tables = (f"holdout/{record.name}.csv" for record in evidence.hold_out)
    writes(*(folder / name for name in (*DECISIVE, *tables)))
    kept = read_json(folder / NAMED)
    leads = zip(evidence.fit, kept["leads"], strict=True)
    evidence = replace(evidence, fit=tuple(replace(x, lead=n) for x, n in leads))
    named = f"{folder / NAMED}: identified"
    first = (
        Model.from_mapping(kept["identified"], named) if kept["identified"] else base
    )
    floor = Floor(**kept["floor"])
    decided = read_json(folder / DECISION)
    own = OwnValues.of_mapping(decided["record_values"])
    fit = own.taken_off(evidence.fit, evidence.input_hold)
    restorer = Restorer(fit, base.chain)
    state = restorer.state(kept["state"])
    rungs = tuple(
        Rung(item["name"], restorer.state(item["state"])) for item in kept["rungs"]
    )
    start, _ = start_state(fit, base, evidence.input_hold, evidence.noise_rms)
    box = black_box(compared_records(start), floor.rms)
    fitted = FitResult(base, state, floor, box, rungs, own)
    vocabulary = Vocabulary.of(kept["without"], kept["with"])
    built_in = BuiltIn.of_mapping(kept["built_in"]) if kept["built_in"] else None
    evidence, shown = shown_on_hold_out(
        evidence, first, fitted, decided, vocabulary, built_in
    )
    with whole_folder(folder, SHOWN) as fresh:
        write_shown(fresh, evidence.hold_out, shown)

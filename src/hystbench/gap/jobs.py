"""``hystbench gap`` as two jobs: decide on fit records, then show on those held out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path

from hystbench.files import read_json, whole_folder, write_json
from hystbench.gap.behaviour import say_in_words, with_device
from hystbench.gap.decision import Decision
from hystbench.gap.fitting.compare import compare
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.serialize import Restorer, state_mapping
from hystbench.gap.fitting.start import start_state
from hystbench.gap.holdout.outcome import as_asked, outcome
from hystbench.gap.holdout.show import FitResult
from hystbench.gap.judging.black_box import black_box
from hystbench.gap.naming.built_in import BuiltIn
from hystbench.gap.naming.ladder import Rung
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.run import DECISIVE, SHOWN, found_on_fit, write_shown
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.vocabulary import EVERYTHING, Vocabulary
from hystbench.model import Model
from hystbench.written import writes

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
    say = say_in_words(say)
    vocabulary = vocabulary.in_device(evidence.device_kind)
    decision, built_in = found_on_fit(
        evidence, base, limits, say, unnamed_share, vocabulary
    )
    content = with_device(decision.content, evidence.device_kind, evidence.quantities)
    decision = replace(decision, content=content)
    kept = {
        "floor": asdict(decision.floor),
        "state": state_mapping(decision.state),
        "rungs": [
            {"name": item.name, "state": state_mapping(item.state)}
            for item in decision.rungs
        ],
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
    floor = Floor(**kept["floor"])
    decided = read_json(folder / DECISION)
    own = OwnValues.of_mapping(decided["record_values"])
    fit = own.taken_off(evidence.fit, evidence.hold)
    restorer = Restorer(fit, base.chain)
    state = restorer.state(kept["state"])
    rungs = tuple(
        Rung(item["name"], restorer.state(item["state"])) for item in kept["rungs"]
    )
    start, _ = start_state(fit, base, evidence.hold, evidence.noise_rms)
    box = black_box(compare(start), floor.rms)
    fitted = FitResult(base, state, floor, box, rungs, own)
    shown = outcome(fitted, decided, evidence)
    vocabulary = Vocabulary.of(kept["without"], kept["with"])
    vocabulary = vocabulary.in_device(evidence.device_kind)
    built_in = BuiltIn.of_mapping(kept["built_in"]) if kept["built_in"] else None
    shown = as_asked(shown, fitted, evidence, vocabulary, built_in)
    with whole_folder(folder, SHOWN) as fresh:
        write_shown(fresh, evidence.hold_out, shown)

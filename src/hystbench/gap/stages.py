"""``hystbench gap`` as two jobs: one decides, the other shows the hold-out records.

The first has no hold-out file among its inputs. What it decided goes to the second
through files.
"""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from hystbench.command_files import writes
from hystbench.files import read_json, whole_folder, write_json
from hystbench.gap.asked import Asked
from hystbench.gap.bases.gpi import IdentifiedGpi
from hystbench.gap.bases.lead import begun_beside
from hystbench.gap.bases.linear import IdentifiedModel, how_found
from hystbench.gap.fitting.on_records import compared_records, start_state
from hystbench.gap.fitting.own_values import OwnValues
from hystbench.gap.fitting.serialize import state_mapping, state_of
from hystbench.gap.holdout.withdraw import ToShow
from hystbench.gap.judge_and_tell import Decision
from hystbench.gap.naming.ladder import FitResult, Rung
from hystbench.gap.naming.put_in import PutIn
from hystbench.gap.records.black_box import black_box
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.observer import with_observer_signal
from hystbench.gap.run import FINAL_FILES, SHOWN, decide, show, will_write, write_shown
from hystbench.gap.vocabulary import Vocabulary
from hystbench.model import Model

BASE_FILE = "stages/base.yaml"
DECISION_FILE = "stages/decision.json"
NAMED_FILE = "stages/named.json"
STAGE_FILES = ("curves.json", BASE_FILE, NAMED_FILE, DECISION_FILE)
"""What the first of the two jobs writes."""
KEPT_BASES: dict[str, type[IdentifiedModel | IdentifiedGpi]] = {
    "identified": IdentifiedModel,
    "hysteresis": IdentifiedGpi,
}
"""Kinds of bases that are kept as they were first, by key."""


def decide_in(folder: Path, evidence: Evidence, base: Model, asked: Asked) -> Decision:
    """Decide on the fit records; write the decision and the curves to a folder."""
    writes(*(folder / name for name in STAGE_FILES))
    decision, to_show = decide(evidence, base, asked)
    kept, plain = _kept(to_show), to_show.plain
    if plain is not None:  # its base is a linear model
        more = {"content": plain.content, "base": plain.fitted.base.to_mapping()}
        kept["plain"] = _kept(plain) | more
    with whole_folder(folder, STAGE_FILES) as fresh:
        write_json(fresh / "curves.json", decision.curves)
        decision.base.save(fresh / BASE_FILE)
        write_json(fresh / NAMED_FILE, kept)
        write_json(fresh / DECISION_FILE, to_show.content)
    return decision


def _kept(to_show: ToShow) -> dict[str, Any]:
    """Give what a decision is made again from, but for its base and its content."""
    fitted, put_in = to_show.fitted, to_show.put_in
    return {
        "floor": asdict(fitted.floor),
        "leads": [record.lead for record in fitted.state.records],
        "state": state_mapping(fitted.state),
        "rungs": [
            {"name": item.name, "state": state_mapping(item.state)}
            for item in fitted.rungs
        ],
        **{
            key: to_show.first.to_mapping() if isinstance(to_show.first, kind) else None
            for key, kind in KEPT_BASES.items()
        },
        "how_found": how_found(to_show.first),
        "without": list(to_show.vocabulary.without),
        "with": list(to_show.vocabulary.put_in),
        "put_in": None if put_in is None else put_in.mapping(),
        "damper": to_show.damper,
    }


def show_in(folder: Path, evidence: Evidence, base: Model) -> None:
    """Compare with the hold-out records; write gap.json, model.yaml and holdout/.

    They choose nothing: a model that is worse there than the base is taken back. The
    folder holds what :func:`decide_in` wrote.
    """
    will_write(folder, evidence, FINAL_FILES)
    evidence, shown = show(evidence, _to_show_in(folder, evidence, base))
    with whole_folder(folder, SHOWN) as fresh:
        write_shown(fresh, evidence.hold_out, shown)


def _to_show_in(folder: Path, evidence: Evidence, base: Model) -> ToShow:
    """Give what :func:`decide_in` wrote, as it was decided."""
    kept, content = read_json(folder / NAMED_FILE), read_json(folder / DECISION_FILE)
    place = str(folder / NAMED_FILE)
    to_show = _made_again(kept, content, evidence, base, place)
    if plain := kept.get("plain"):
        alone = Model.from_mapping(plain["base"], f"{place}: plain: base")
        again = _made_again(plain, plain["content"], evidence, alone, place)
        to_show = replace(to_show, plain=again)
    return to_show


def _made_again(
    kept: dict[str, Any],
    content: dict[str, Any],
    evidence: Evidence,
    base: Model,
    place: str,
) -> ToShow:
    """Make a decision again from what was kept of it."""
    evidence = with_observer_signal(evidence, kept["damper"])
    floor, own = Floor(**kept["floor"]), OwnValues.of_mapping(content["record_values"])
    first = base
    for key, kind in KEPT_BASES.items():
        if kept[key]:
            first = kind.from_mapping(kept[key], f"{place}: {key}")
    first = replace(first, **kept["how_found"])
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
    put_in = PutIn.of_mapping(kept["put_in"]) if kept["put_in"] else None
    fitted = FitResult(base, state, floor, box, rungs, own)
    return ToShow(
        first=first,
        fitted=fitted,
        content=content,
        vocabulary=vocabulary,
        put_in=put_in,
        damper=kept["damper"],
    )

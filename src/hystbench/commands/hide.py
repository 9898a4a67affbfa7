"""``hystbench hide``: make records in which a plant hides effects."""

from pathlib import Path
from typing import Annotated

from hystbench import options
from hystbench.challenge.make import make, write_folder
from hystbench.challenge.spec import CaseSpec, draw_spec, kind_of
from hystbench.errors import InputError
from hystbench.files import whole_folder, write_json
from hystbench.options import OutFolder, command


@command
def hide(
    *,
    effects: tuple[Annotated[str, "Name of an effect; may be repeated."], ...] = (),
    kind: Annotated[
        str | None,
        "single, pair, triple, none or unlisted: draw the effects, or say none.",
    ] = None,
    family: Annotated[
        str, "gpi, preisach, jiles-atherton, duhem, mass-spring, ..."
    ] = "gpi",
    ratio_db: Annotated[float, "Gap over noise, in dB."] = 20.0,
    seed: int,
    spread: Annotated[float, "Factor on the ranges."] = 1.0,
    campaign: Annotated[str, "standard or other records."] = "standard",
    out: OutFolder,
    truth: Annotated[Path, options.NEW_FILE],
) -> None:
    """Write DIR/dataset and DIR/model.yaml for a solver, and the truth elsewhere."""
    if effects or kind == "none":
        asked = kind_of(effects)
        if kind not in (None, asked):
            raise InputError(
                f"--kind: {kind!r} with {len(effects)} effects; expected {asked!r}"
            )
        spec = CaseSpec(seed, asked, effects, family, ratio_db, spread, campaign)
    elif kind is None:
        raise InputError("--effect: none given; expected one, or --kind")
    else:
        spec = draw_spec(seed, kind, family, ratio_db, spread=spread, campaign=campaign)
    if truth.resolve().is_relative_to(out.resolve()):
        raise InputError(
            f"{truth}: truth inside {out}; expected a file outside the folder that the "
            "solver gets"
        )
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise InputError(f"{out}: expected a new or an empty folder")
    case = make(spec)
    # The folder comes last: next time it would be refused, as it would not be empty.
    write_json(truth, case.truth)
    with whole_folder(out, ()) as fresh:
        write_folder(case, fresh)

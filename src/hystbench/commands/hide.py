"""``hystbench hide``: make records in which a plant hides effects."""

from pathlib import Path
from typing import Annotated

from hystbench import options
from hystbench.challenge.make import make
from hystbench.challenge.spec import CaseSpec, draw_spec, kind_of
from hystbench.challenge.writing import check_places, write_case
from hystbench.errors import InputError
from hystbench.signature import OutFolder, command


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
    check_places(out, truth)
    write_case(make(spec), out, truth)
